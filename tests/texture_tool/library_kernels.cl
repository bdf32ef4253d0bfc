// The library's textures on an OpenCL device: a kernel for each.
#include "platform.h"

#include "common/user_language/as_opencl/user_language.h"

// clang-format off
#include "tests/texture_tool/library_hooks.h"
#include "common/user_language/as_vectors/arguments.h"
#include "library_textures.cl"
// clang-format on

#define KERNEL(name)                                                                    \
    __kernel void name##_kernel(__global const float* hits, __global const uint* words, \
                                __global float* results, __global int* clamped)         \
    {                                                                                   \
        const int k = get_global_id(0);                                                 \
        const int count = get_global_size(0);                                           \
        TextureContext tx = hit_context(hits, count, k, words);                         \
        const float4 value = name##_entry(&tx, 0);                                      \
        results[k] = value.x;                                                           \
        results[count + k] = value.y;                                                   \
        results[2 * count + k] = value.z;                                               \
        results[3 * count + k] = value.w;                                               \
        clamped[k] = tx.clamped;                                                        \
    }
LIBRARY_TEXTURES(KERNEL)
