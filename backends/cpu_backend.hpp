// The backends that run on this machine's processor: `cpu` (Embree, vectorised), and `twin` and
// `double`, which walk the same trees as OpenCL.
#pragma once

#include "backends/backend.hpp"
#include "kernels_cpu/kernels.hpp"

namespace diptych {

// kernels without an intersection of their own use Embree.
std::unique_ptr<Backend> make_cpu_backend(const KernelSet& kernels, const BackendOptions& options);

}  // namespace diptych
