// Chooses among the vectorised kernel sets of this build.
#include "kernels_cpu/kernels.hpp"
#include "kernels_cpu/texture_ray_loops.hpp"

namespace diptych {

#ifdef KERNELS_NATIVE

namespace kernels_native {
extern const KernelSet set;
TextureRayLoops texture_ray_loops(unsigned effects);
}  // namespace kernels_native

const KernelSet& vector_kernels() { return kernels_native::set; }
TextureRayLoops vector_texture_ray_loops(unsigned effects)
{
    return kernels_native::texture_ray_loops(effects);
}

#else

namespace kernels_baseline {
extern const KernelSet set;
TextureRayLoops texture_ray_loops(unsigned effects);
}  // namespace kernels_baseline
namespace kernels_avx2 {
extern const KernelSet set;
TextureRayLoops texture_ray_loops(unsigned effects);
}  // namespace kernels_avx2
namespace kernels_avx512 {
extern const KernelSet set;
TextureRayLoops texture_ray_loops(unsigned effects);
}  // namespace kernels_avx512

namespace {

enum class Vectors { baseline, avx2, avx512 };

Vectors widest_vectors()
{
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
        return Vectors::avx512;
    }
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
    return has_avx2 ? Vectors::avx2 : Vectors::baseline;
}

}  // namespace

const KernelSet& vector_kernels()
{
    const Vectors vectors = widest_vectors();
    return vectors == Vectors::avx512 ? kernels_avx512::set
           : vectors == Vectors::avx2 ? kernels_avx2::set
                                      : kernels_baseline::set;
}

TextureRayLoops vector_texture_ray_loops(unsigned effects)
{
    const Vectors vectors = widest_vectors();
    return vectors == Vectors::avx512 ? kernels_avx512::texture_ray_loops(effects)
           : vectors == Vectors::avx2 ? kernels_avx2::texture_ray_loops(effects)
                                      : kernels_baseline::texture_ray_loops(effects);
}

#endif

}  // namespace diptych
