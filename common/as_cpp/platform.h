// The C++20 dialect of the shared sources: the slice of OpenCL C that they use.
#pragma once

#include <cstdint>
#include <cstring>

// Not inlining one shared function keeps a whole stage from being vectorised; the build sets
// ALWAYS_INLINE to the compiler's attribute, or to nothing for kernels meant to be stepped in a
// debugger.
#define SHARED [[maybe_unused]] static inline ALWAYS_INLINE
#define GLOBAL
#define CONSTANT static const
#define STORED(type) type
#define PLANE(type) PLANE_OF_##type
#define PLANE_OF_float float
#define PLANE_OF_float3 float
#define PLANE_OF_int int
#define PLANE_OF_uint uint
#define LAYOUT_CHECK(type, bytes) \
    static_assert(sizeof(type) == (bytes), #type " must be " #bytes " bytes on every device");

#define PI 3.14159265358979323846f
#define INV_PI 0.31830988618379067154f
#define FLOAT_MAX 3.402823466e+38f
#define FLOAT_EPSILON 1.1920928955078125e-7f

#define uses(scene, effect) (((scene)->effects & (effect)) != 0)

// Rows of LARGE_BUFFERS are whole here.
#define LARGE_FIELD(type, name, log_bytes)
#define LARGE_ACCESS(type, name, log_bytes)
#define ROW_AT(scene, name, index) ((scene)->name[index])

#include "common/as_cpp/vector_types.h"
#include "common/as_cpp/vectors.h"

SHARED int as_int(float x) { return __builtin_bit_cast(int, x); }
SHARED uint as_uint(float x) { return __builtin_bit_cast(uint, x); }
SHARED float as_float(uint x) { return __builtin_bit_cast(float, x); }
SHARED float as_float(int x) { return __builtin_bit_cast(float, x); }

SHARED void atomic_add_int(int* at, int value) { __atomic_fetch_add(at, value, __ATOMIC_RELAXED); }

SHARED float math_sqrt(float x) { return __builtin_sqrtf(x); }
SHARED float math_abs(float x) { return __builtin_fabsf(x); }
SHARED float math_floor(float x) { return __builtin_floorf(x); }

#include "common/as_float/elementary.h"
#include "common/math.h"
