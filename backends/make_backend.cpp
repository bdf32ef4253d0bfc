#include "backends/backend.hpp"
#include "backends/cpu_backend.hpp"
#include "backends/device_list.hpp"
#include "backends/opencl_backend.hpp"

#include <stdexcept>

namespace diptych {

std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options)
{
    if (is_device_list(options.device)) return make_devices(options);
    if (name == "cpu") return make_cpu_backend(vector_kernels(), options);
    if (name == "twin")
        return make_cpu_backend(options.debug_kernels ? kernels_debug::set : kernels_scalar::set,
                                options);
    if (name == "double") return make_cpu_backend(kernels_reference::set, options);
    if (name == "opencl") {
#if WITH_OPENCL
        return make_opencl_backend(options);
#else
        throw std::runtime_error("--backend opencl: built without OpenCL; use cpu, or configure "
                                 "with -DWITH_OPENCL=ON");
#endif
    }
    throw std::runtime_error("--backend " + name +
                             ": no such backend; use cpu, opencl, twin or double");
}

}  // namespace diptych
