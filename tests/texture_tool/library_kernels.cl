// The library's textures on an OpenCL device: a kernel for each.
#include "platform.h"

#include "common/user_language/as_opencl/user_language.h"

// clang-format off
#include "tests/texture_tool/library_hooks.h"
#include "common/user_language/as_vectors/arguments.h"
#include "library_textures.cl"
// clang-format on

#define KERNEL(name)                                                                          \
    __kernel void name##_kernel(__global const float* hits, __global const uint* words,       \
                                __global float4* results, __global int* clamped)              \
    {                                                                                         \
        const int k = get_global_id(0);                                                       \
        TextureContext tx = hit_context(hits + HIT_FLOATS * k, words);                        \
        results[k] = name##_entry(&tx, 0);                                                    \
        clamped[k] = tx.clamped;                                                              \
    }
LIBRARY_TEXTURES(KERNEL)
