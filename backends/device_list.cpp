#include "backends/device_list.hpp"

#include "backends/cpu_backend.hpp"
#include "backends/device_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>
#if WITH_OPENCL
#include "backends/opencl_backend.hpp"
#include "backends/opencl_devices.hpp"
#endif

namespace diptych {
namespace {

[[noreturn]] void refuse(const std::string& list, const std::string& what)
{
    throw std::runtime_error("--device " + list + ": " + what);
}

// Where "/2" begins at the end of an entry; npos: it is not divided.
size_t division(const std::string& entry)
{
    const size_t slash = entry.rfind('/');
    if (slash == std::string::npos || slash + 1 == entry.size() ||
        !std::all_of(entry.begin() + std::ptrdiff_t(slash) + 1, entry.end(),
                     [](unsigned char c) { return std::isdigit(c); }))
        return std::string::npos;
    return slash;
}

DeviceEntry parse_entry(const std::string& list, const std::string& text)
{
    const size_t slash = division(text);
    DeviceEntry entry{text.substr(0, slash)};
    if (slash != std::string::npos) {
        const std::string parts = text.substr(slash + 1);
        entry.parts = parts.size() < 5 ? std::stoi(parts) : 0;
        if (entry.parts < 2)
            refuse(list, "a device cannot be divided into " + parts +
                             " parts; give 2 or more, as far as diptych devices says");
        if (entry.choice == "cpu")
            refuse(list, "cpu is not divided; --threads says how many threads it has");
    }
    if (entry.choice.empty())
        refuse(list, "an entry is empty; give numbers or parts of names of OpenCL devices and cpu, "
                     "as 0,1,cpu");
    return entry;
}

void print_notice(const std::string& line) { fmt::print(stderr, "notice: {}\n", line); }

#if WITH_OPENCL
void add_opencl(std::vector<std::unique_ptr<Backend>>& devices, const DeviceEntry& entry,
                std::set<int>& taken, const BackendOptions& options)
{
    const DeviceInfo whole = pick_opencl_device(entry.choice);
    if (!taken.insert(whole.index).second)
        refuse(options.device, fmt::format("\"{}\" is device {} ({}) once more; name each once",
                                           entry.choice, whole.index, whole.name));
    if (entry.parts == 1) {
        devices.push_back(make_opencl_backend(options, whole));
        return;
    }
    for (const DeviceInfo& part : divide_opencl_device(whole, entry.parts))
        devices.push_back(make_opencl_backend(options, part));
}
#else
void add_opencl(std::vector<std::unique_ptr<Backend>>&, const DeviceEntry&, std::set<int>&,
                const BackendOptions& options)
{
    refuse(options.device,
           "built without OpenCL; leave it out, or configure with -DWITH_OPENCL=ON");
}
#endif

}  // namespace

bool is_device_list(const std::string& text)
{
    return text.find(',') != std::string::npos || division(text) != std::string::npos;
}

std::vector<DeviceEntry> parse_device_list(const std::string& text)
{
    std::vector<DeviceEntry> entries;
    size_t first = 0;
    for (size_t comma = 0; comma != std::string::npos; first = comma + 1) {
        comma = text.find(',', first);
        entries.push_back(parse_entry(text, text.substr(first, comma - first)));
    }
    for (size_t a = 0; a < entries.size(); ++a)
        for (size_t b = 0; b < a; ++b)
            if (entries[a].choice == entries[b].choice)
                refuse(text, entries[a].choice + " comes twice; name each device once");
    return entries;
}

std::string backend_of_devices(const std::vector<DeviceEntry>& entries)
{
    const bool has_cpu = std::any_of(entries.begin(), entries.end(),
                                     [](const auto& entry) { return entry.choice == "cpu"; });
    return has_cpu ? "cpu+opencl" : "opencl";
}

std::unique_ptr<Backend> make_devices(const BackendOptions& options)
{
    const std::vector<DeviceEntry> entries = parse_device_list(options.device);
    std::vector<std::unique_ptr<Backend>> devices;
    std::set<int> taken;
    for (const DeviceEntry& entry : entries)
        if (entry.choice != "cpu") add_opencl(devices, entry, taken, options);
    // reads the scene where it lies: after those that build trees into it
    if (backend_of_devices(entries) != "opencl")
        devices.push_back(make_cpu_backend(vector_kernels(), options));
    return make_device_group(std::move(devices), print_notice);
}

}  // namespace diptych
