// Chooses among the vectorised kernel sets of this build.
#include "kernels_cpu/kernels.hpp"

namespace diptych {

#ifdef KERNELS_NATIVE

namespace kernels_native {
extern const KernelSet set;
}

const KernelSet& vector_kernels() { return kernels_native::set; }

#else

namespace kernels_baseline {
extern const KernelSet set;
}
namespace kernels_avx2 {
extern const KernelSet set;
}
namespace kernels_avx512 {
extern const KernelSet set;
}

const KernelSet& vector_kernels()
{
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
        return kernels_avx512::set;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2")) return kernels_avx2::set;
    return kernels_baseline::set;
}

#endif

}  // namespace diptych
