// Drives one OpenCL device: a kernel per stage over the live paths of a dispatch.
#pragma once

#include "backends/backend.hpp"
#include "backends/opencl_devices.hpp"

namespace diptych {

// Throws std::runtime_error when there is no such device or it cannot be used.
std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options);

// On that device, or part of one, whatever options.device says.
std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options,
                                             const DeviceInfo& device);

}  // namespace diptych
