// The reference dialect: the same sources with `float` widened to double and the C library's
// mathematics, so that the difference between two pictures measures what single precision costs.
// Stored scene data keep their layout.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#define SHARED [[maybe_unused]] static inline ALWAYS_INLINE
#define GLOBAL
#define CONSTANT static const
#define PLANE(type) PLANE_OF_##type
#define PLANE_OF_float double
#define PLANE_OF_double double
#define PLANE_OF_float3 double
#define PLANE_OF_int int
#define PLANE_OF_uint uint
#define LAYOUT_CHECK(type, bytes) \
    static_assert(sizeof(type) == (bytes), #type " must be " #bytes " bytes on every device");

#define PI 3.14159265358979323846
#define INV_PI 0.31830988618379067154
#define FLOAT_MAX 3.402823466e+38
#define FLOAT_EPSILON 2.220446049250313e-16

#define uses(scene, effect) (((scene)->effects & (effect)) != 0)

// Rows of LARGE_BUFFERS are whole here.
#define LARGE_FIELD(type, name, log_bytes)
#define LARGE_ACCESS(type, name, log_bytes)
#define ROW_AT(scene, name, index) ((scene)->name[index])

// What memory holds stays single precision (namespace stored); reading it widens, exactly.
#define STORED(type) STORED_##type
namespace stored {
#include "common/as_cpp/vector_types.h"
#include "common/layout.h"
}  // namespace stored
#define STORED_int int
#define STORED_uint uint
using STORED_float = float;
using STORED_double = float;  // what a row of `float` has become when it comes here
using STORED_float2 = stored::float2;
using STORED_float4 = stored::float4;
#define STORED_NAME(type, bytes) \
    using stored::type;          \
    using STORED_##type = type;
STORED_STRUCTS(STORED_NAME)

#define float double
#include "common/as_cpp/vector_types.h"
#include "common/as_cpp/vectors.h"

SHARED float3 xyz(stored::float4 v) { return float3{v.x, v.y, v.z}; }

SHARED int as_int(STORED_float x) { return std::bit_cast<int>(x); }
SHARED uint as_uint(STORED_float x) { return std::bit_cast<uint>(x); }
SHARED float as_float(uint x) { return std::bit_cast<STORED_float>(x); }
SHARED float as_float(int x) { return std::bit_cast<STORED_float>(x); }

SHARED void atomic_add_int(int* at, int value) { __atomic_fetch_add(at, value, __ATOMIC_RELAXED); }

SHARED float math_sqrt(float x) { return std::sqrt(x); }
SHARED float math_abs(float x) { return std::fabs(x); }
SHARED float math_floor(float x) { return std::floor(x); }
SHARED float math_sin(float x) { return std::sin(x); }
SHARED float math_cos(float x) { return std::cos(x); }
SHARED float math_tan(float x) { return std::tan(x); }
SHARED float math_asin(float x) { return std::asin(x); }
SHARED float math_acos(float x) { return std::acos(x); }
SHARED float math_atan2(float y, float x) { return std::atan2(y, x); }
SHARED float math_exp(float x) { return std::exp(x); }
SHARED float math_exp2(float x) { return std::exp2(x); }
SHARED float math_log(float x) { return std::log(x); }
SHARED float math_log2(float x) { return std::log2(x); }
SHARED float math_pow(float x, float y) { return std::pow(x, y); }
SHARED float math_cbrt(float x) { return std::cbrt(x); }
SHARED float math_sinpi(float x) { return std::sin(PI * std::fmod(x, 2.0)); }
SHARED float math_cospi(float x) { return std::cos(PI * std::fmod(x, 2.0)); }

#include "common/math.h"
