#include "host/commands/devices_command.hpp"

#include "backends/backend.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <stdexcept>
#ifdef DIPTYCH_WITH_OPENCL
#include "backends/opencl_devices.hpp"
#endif

namespace diptych {
namespace {

void print_processor()
{
    fmt::print("This machine's processor\n");
    for (const char* name : {"cpu", "twin", "double"})
        fmt::print("  --backend {:<8}{}\n", name, make_backend(name, {})->description());
}

#ifdef DIPTYCH_WITH_OPENCL
std::string gibibytes(size_t bytes) { return fmt::format("{:.2f} GiB", double(bytes) / (1 << 30)); }

void print_opencl()
{
    const std::vector<DeviceInfo> devices = list_opencl_devices();
    if (devices.empty()) {
        fmt::print("\nOpenCL: no platform or device found. Install the GPU's OpenCL driver, or "
                   "PoCL to use the CPU (Debian: pocl-opencl-icd).\n");
        return;
    }
    const std::string* platform = nullptr;
    for (const DeviceInfo& device : devices) {
        if (!platform || *platform != device.platform)
            fmt::print("\nOpenCL platform {}\n", device.platform);
        platform = &device.platform;
        fmt::print("  --backend opencl --device {:<3}{}\n", device.index, device.name);
        fmt::print("      {}, driver {}, {}\n", device.version, device.driver,
                   device.is_cpu ? "a CPU" : "not a CPU");
        fmt::print("      memory {}, largest allocation {}\n", gibibytes(device.memory_bytes),
                   gibibytes(device.largest_allocation));
        if (device.most_parts > 0)
            fmt::print("      can be divided, as --device {}/2, into up to {} parts\n",
                       device.index, device.most_parts);
        if (!device.is_usable)
            fmt::print("      cannot be used: {}\n", device.why_not);
        else
            fmt::print("      can be used{}\n",
                       device.is_exact ? ""
                                       : "; its division and square root are not exact, so "
                                         "pictures match twin closely, not to the bit");
    }
}
#else
void print_opencl()
{
    fmt::print("\nOpenCL: this program was built without it; build with -DWITH_OPENCL=ON.\n");
}
#endif

}  // namespace

CLI::App* add_devices_command(CLI::App& app)
{
    CLI::App* devices =
        app.add_subcommand("devices", "List what can render: the processor, OpenCL devices");
    devices->footer("Every OpenCL platform and device with version, memory and largest "
                    "allocation, whether it can be\nused, and why not. Exit code: 0.");
    return devices;
}

int run_devices_command()
{
    print_processor();
    try {
        print_opencl();
    } catch (const std::runtime_error& error) {
        fmt::print("\nOpenCL cannot be asked: {}\n", error.what());
    }
    return 0;
}

}  // namespace diptych
