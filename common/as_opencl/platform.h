// The OpenCL C 1.2 dialect of the shared sources: what as_cpp/platform.h teaches C++, OpenCL mostly
// knows.
#pragma once

#pragma OPENCL FP_CONTRACT OFF

#define GLOBAL __global
#define CONSTANT __constant
#define SHARED static inline
#define STORED(type) type
#define PLANE(type) PLANE_OF_##type
#define PLANE_OF_float float
#define PLANE_OF_float3 float
#define PLANE_OF_int int
#define PLANE_OF_uint uint
#define LAYOUT_CHECK(type, bytes) \
    typedef char type##_layout_check[sizeof(type) == (bytes) ? 1 : -1];

#define PI 3.14159265358979323846f
#define INV_PI 0.31830988618379067154f
#define FLOAT_MAX 3.402823466e+38f
#define FLOAT_EPSILON 1.1920928955078125e-7f

// An absent effect is a compile-time zero: the build passes -D EFFECTS=<mask of the scene>.
#define uses(scene, effect) (((EFFECTS) & (effect)) != 0)

// Rows of LARGE_BUFFERS that are larger than the device's largest allocation lie in pages of
// 1 << PAGE_SHIFT bytes; the build says how long they are, -D PAGE_SHIFT=0 that there are none.
#define LARGE_FIELD(type, name, log_bytes) \
    GLOBAL const STORED(type) * name##_1;  \
    GLOBAL const STORED(type) * name##_2;  \
    GLOBAL const STORED(type) * name##_3;
#define LARGE_ACCESS(type, name, log_bytes)                                               \
    SHARED GLOBAL const STORED(type) * name##_at(const Scene* scene, int index)           \
    {                                                                                     \
        if (PAGE_SHIFT == 0) return scene->name + index;                                  \
        const uint shift = (uint)(PAGE_SHIFT - log_bytes) & 31u;                          \
        const uint page = (uint)index >> shift;                                           \
        const uint within = (uint)index & ((1u << shift) - 1u);                           \
        GLOBAL const STORED(type)* low = page == 0u ? scene->name : scene->name##_1;      \
        GLOBAL const STORED(type)* high = page == 2u ? scene->name##_2 : scene->name##_3; \
        return (page < 2u ? low : high) + within;                                         \
    }
#define ROW_AT(scene, name, index) (*name##_at(scene, index))

#define make_float2(x, y) ((float2)(x, y))
#define make_float3(x, y, z) ((float3)(x, y, z))
#define make_float4(x, y, z, w) ((float4)(x, y, z, w))
SHARED float3 xyz(float4 v) { return v.xyz; }

SHARED float math_sqrt(float x) { return sqrt(x); }
SHARED float math_abs(float x) { return fabs(x); }
SHARED float math_floor(float x) { return floor(x); }

SHARED void atomic_add_int(GLOBAL int* at, int value)
{
    atomic_add((volatile GLOBAL int*)at, value);
}

#include "common/as_float/elementary.h"
#include "common/math.h"
