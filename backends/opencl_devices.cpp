#include "backends/opencl_devices.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace diptych {
namespace {

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

// "OpenCL C 1.2 ..." and later.
bool knows_opencl_c_12(const opencl::Device& device)
{
    int major = 0;
    int minor = 0;
    const std::string version = device.text(CL_DEVICE_OPENCL_C_VERSION);
    if (std::sscanf(version.c_str(), "OpenCL C %d.%d", &major, &minor) != 2) return false;
    return major > 1 || minor >= 2;
}

std::string why_unusable(const opencl::Device& device)
{
    const auto is_set = [&](cl_device_info what) {
        return device.number<cl_bool>(what) == CL_TRUE;
    };
    if (!is_set(CL_DEVICE_AVAILABLE)) return "not available";
    if (!is_set(CL_DEVICE_COMPILER_AVAILABLE)) return "its driver has no compiler";
    if (!is_set(CL_DEVICE_ENDIAN_LITTLE)) return "not little-endian";
    if (!knows_opencl_c_12(device)) return "no OpenCL C 1.2";
    if (device.text(CL_DEVICE_PROFILE) != "FULL_PROFILE") return "embedded profile";
    const auto config = device.number<cl_device_fp_config>(CL_DEVICE_SINGLE_FP_CONFIG);
    if ((config & CL_FP_INF_NAN) == 0) return "no infinities in single precision";
    return "";
}

bool is_exact(const opencl::Device& device)
{
    const auto config = device.number<cl_device_fp_config>(CL_DEVICE_SINGLE_FP_CONFIG);
    return (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
}

// 64 where possible: a multiple of what GPUs run in step.
int group_size(const opencl::Device& device)
{
    const size_t largest = device.number<size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE);
    int size = 1;
    while (size < 64 && size_t(2 * size) <= largest) size *= 2;
    return size;
}

// What the device says, or less where DIPTYCH_LARGEST_ALLOCATION (bytes) says so: how a device with
// narrow limits behaves can be tried on any other.
size_t largest_allocation(const opencl::Device& device)
{
    const auto own = size_t(device.number<cl_ulong>(CL_DEVICE_MAX_MEM_ALLOC_SIZE));
    const char* limit = std::getenv("DIPTYCH_LARGEST_ALLOCATION");
    const unsigned long long wanted = limit ? std::strtoull(limit, nullptr, 10) : 0;
    return wanted > 0 ? std::min<size_t>(own, wanted) : own;
}

// What becomes of a render then can be tried on any device: DIPTYCH_FAIL_AT names the dispatch.
int planned_failure()
{
    const char* text = std::getenv("DIPTYCH_FAIL_AT");
    return text ? std::atoi(text) : 0;
}

DeviceInfo describe(const opencl::Device& device, int index)
{
    DeviceInfo info;
    info.index = index;
    info.device = device;
    info.platform = device.platform_text(CL_PLATFORM_NAME);
    info.name = device.name();
    info.version = device.text(CL_DEVICE_VERSION);
    info.driver = device.text(CL_DRIVER_VERSION);
    info.memory_bytes = size_t(device.number<cl_ulong>(CL_DEVICE_GLOBAL_MEM_SIZE));
    info.largest_allocation = largest_allocation(device);
    info.units = int(device.number<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS));
    info.group_size = group_size(device);
    info.most_parts = device.most_parts();
    info.fails_at = planned_failure();
    info.is_cpu = (device.number<cl_device_type>(CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU) != 0;
    info.why_not = why_unusable(device);
    info.is_usable = info.why_not.empty();
    info.is_exact = info.is_usable && is_exact(device);
    return info;
}

std::string names_of(const std::vector<DeviceInfo>& devices)
{
    std::string names;
    for (const DeviceInfo& device : devices)
        names +=
            (names.empty() ? "" : ", ") + std::to_string(device.index) + " (" + device.name + ")";
    return names;
}

bool is_index(const std::string& choice)
{
    return !choice.empty() && choice.size() < 9 &&
           std::all_of(choice.begin(), choice.end(),
                       [](unsigned char c) { return std::isdigit(c); });
}

bool is_chosen(const DeviceInfo& device, const std::string& choice)
{
    if (is_index(choice)) return device.index == std::stoi(choice);
    return lower(device.name).find(lower(choice)) != std::string::npos ||
           lower(device.platform).find(lower(choice)) != std::string::npos;
}

}  // namespace

std::vector<DeviceInfo> list_opencl_devices()
{
    std::vector<DeviceInfo> list;
    for (const opencl::Device& device : opencl::all_devices()) {
        const int index = int(list.size());
        try {
            list.push_back(describe(device, index));
        } catch (const std::runtime_error& error) {  // a broken driver must not hide the others
            DeviceInfo broken;
            broken.index = index;
            broken.is_usable = false;
            broken.why_not = error.what();
            list.push_back(broken);
        }
    }
    return list;
}

DeviceInfo pick_opencl_device(const std::string& choice)
{
    const std::vector<DeviceInfo> all = list_opencl_devices();
    if (all.empty())
        throw std::runtime_error("opencl: no platform or device found; install the GPU's OpenCL "
                                 "driver, or PoCL to use the CPU (Debian: pocl-opencl-icd), or "
                                 "use --backend cpu");
    std::vector<DeviceInfo> chosen;
    for (const DeviceInfo& device : all)
        if (is_chosen(device, choice)) chosen.push_back(device);
    if (chosen.empty())
        throw std::runtime_error(
            "opencl: no device \"" + choice + "\"; there are: " + names_of(all) +
            (choice == "cpu" ? "; for the CPU without OpenCL give --backend cpu" : ""));
    std::stable_sort(chosen.begin(), chosen.end(), [](const DeviceInfo& a, const DeviceInfo& b) {
        return std::pair(!a.is_usable, a.is_cpu) < std::pair(!b.is_usable, b.is_cpu);
    });
    const DeviceInfo& best = chosen.front();
    if (!best.is_usable)
        throw std::runtime_error("opencl: device " + best.name +
                                 " cannot be used: " + best.why_not +
                                 "; choose another with --device, or use "
                                 "--backend cpu");
    return best;
}

std::vector<DeviceInfo> divide_opencl_device(const DeviceInfo& device, int parts)
{
    if (parts > device.most_parts)
        throw std::runtime_error(
            "opencl: device " + device.name + " cannot be divided into " + std::to_string(parts) +
            " parts; " +
            (device.most_parts == 0 ? "it can only be used whole"
                                    : "it has " + std::to_string(device.most_parts) + " at most"));
    std::vector<DeviceInfo> divided;
    for (const opencl::Device& part : device.device.divided(parts)) {
        divided.push_back(describe(part, device.index));
        divided.back().part =
            ", part " + std::to_string(divided.size()) + " of " + std::to_string(parts);
    }
    return divided;
}

}  // namespace diptych
