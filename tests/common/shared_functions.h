// The shared mathematics as rows, read by C++ and by OpenCL: each makes 32 bits of two floats.
#pragma once

// X(name, result), of float a and b, and the vectors v and w made of them.
#define SHARED_FUNCTIONS(X)                        \
    X(sin, number(math_sin(a)))                    \
    X(cos, number(math_cos(a)))                    \
    X(tan, number(math_tan(a)))                    \
    X(sinpi, number(math_sinpi(a)))                \
    X(cospi, number(math_cospi(a)))                \
    X(asin, number(math_asin(a)))                  \
    X(acos, number(math_acos(a)))                  \
    X(atan2, number(math_atan2(a, b)))             \
    X(exp, number(math_exp(a)))                    \
    X(exp2, number(math_exp2(a)))                  \
    X(log, number(math_log(a)))                    \
    X(log2, number(math_log2(a)))                  \
    X(pow, number(math_pow(a, b)))                 \
    X(cbrt, number(math_cbrt(a)))                  \
    X(sqrt, number(math_sqrt(a)))                  \
    X(divide, number(a / b))                       \
    X(min, number(math_min(a, b)))                 \
    X(max, number(math_max(a, b)))                 \
    X(clamp, number(math_clamp(a, -1.0f, b)))      \
    X(lerp, number(math_lerp(a, b, 0.3f)))         \
    X(float_to_int, (uint)float_to_int(a))         \
    X(dot, number(vec_dot(v, w)))                  \
    X(cross, vector(vec_cross(v, w)))              \
    X(normalize, vector(vec_normalize(v)))         \
    X(length, number(vec_length(v)))               \
    X(vec_lerp, vector(vec_lerp(v, w, 0.7f)))      \
    X(reflect, vector(vec_reflect(v, w)))          \
    X(luminance, number(vec_luminance(v)))         \
    X(max_component, number(vec_max_component(v))) \
    X(is_finite, vec_is_finite(v) ? 1u : 0u)       \
    X(frame_tangent, vector(frame_tangent(w)))     \
    X(frame_bitangent, vector(frame_bitangent(w))) \
    X(normal_pack, normal_pack(v))                 \
    X(normal_unpack, vector(normal_unpack(as_uint(a))))

// Only the sign and payload of a NaN may differ.
SHARED uint number(float x) { return x == x ? as_uint(x) : 0x7fc00000u; }
SHARED uint vector(float3 v) { return number(v.x) ^ (number(v.y) * 3u) ^ (number(v.z) * 5u); }

#define SHARED_FUNCTION(name, result)                                        \
    SHARED uint result_of_##name(float a, float b)                           \
    {                                                                        \
        const float3 v __attribute__((unused)) = make_float3(a, b, a - b);   \
        const float3 w __attribute__((unused)) = make_float3(0.6f, b, 1.0f); \
        return result;                                                       \
    }
SHARED_FUNCTIONS(SHARED_FUNCTION)
