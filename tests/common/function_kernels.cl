// The shared mathematics in the OpenCL dialect: a kernel per row.
#include "platform.h"

#include "tests/common/shared_functions.h"

#define FUNCTION_KERNEL(name, result)                                             \
    __kernel void name##_kernel(__global const float* a, __global const float* b, \
                                __global uint* out)                               \
    {                                                                             \
        const size_t i = get_global_id(0);                                        \
        out[i] = result_of_##name(a[i], b[i]);                                    \
    }
SHARED_FUNCTIONS(FUNCTION_KERNEL)
