// Which OpenCL devices there are, and which of them can run the kernels.
#pragma once

#include "backends/opencl.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace diptych {

struct DeviceInfo {
    int index = 0;  // over all platforms
    std::string platform;
    std::string name;
    std::string part;     // of a divided device: ", part 1 of 2"
    std::string version;  // "OpenCL 3.0 ..."
    std::string driver;
    size_t memory_bytes = 0;
    size_t largest_allocation = 0;
    int units = 1;       // that compute side by side
    int group_size = 1;  // of all kernels: a power of two that the device can run
    int most_parts = 0;  // that it can be divided into; 0: it cannot
    int fails_at = 0;    // tests: the dispatch, from 1 on, at which it is to fail
    bool is_cpu = false;
    bool is_exact = true;  // division and square root round as IEEE 754 says
    bool is_usable = true;
    std::string why_not;  // when it is not usable
    opencl::Device device;
};

// Empty where no OpenCL platform is installed.
std::vector<DeviceInfo> list_opencl_devices();

// By index, or by part of the name or platform, in any case; "": the first usable one, GPUs before
// CPUs. Throws std::runtime_error when there is none, or when it cannot be used, saying why.
DeviceInfo pick_opencl_device(const std::string& choice);

// Equal parts of a device. Throws std::runtime_error that says what it can be divided into.
std::vector<DeviceInfo> divide_opencl_device(const DeviceInfo& device, int parts);

}  // namespace diptych
