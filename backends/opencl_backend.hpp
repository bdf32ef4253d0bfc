// Drives one OpenCL device: a kernel per stage over the live paths of a dispatch.
#pragma once

#include "backends/backend.hpp"

namespace diptych {

// Throws std::runtime_error when there is no such device or it cannot be used.
std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options);

}  // namespace diptych
