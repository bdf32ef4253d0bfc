// The restricted language's names over the user language's functions, so that the library's files
// are read by C++ unchanged, as the texture tool's text would run them.
#pragma once

#include "platform.h"

#include "common/user_language/as_cpp/user_language.h"

namespace user_language {

#define LANGUAGE_1(name)                                           \
    SHARED float name(float x) { return tx_##name##_float(x); }    \
    SHARED float2 name(float2 x) { return tx_##name##_float2(x); } \
    SHARED float3 name(float3 x) { return tx_##name##_float3(x); }
LANGUAGE_1(floor)
LANGUAGE_1(fabs)
LANGUAGE_1(sqrt)
LANGUAGE_1(exp)
LANGUAGE_1(cospi)
LANGUAGE_1(sinpi)
LANGUAGE_1(normalize)
#undef LANGUAGE_1

SHARED float fmin(float a, float b) { return tx_fmin_float(a, b); }
SHARED float fmax(float a, float b) { return tx_fmax_float(a, b); }
SHARED float pow(float a, float b) { return tx_pow_float(a, b); }
SHARED float atan2(float a, float b) { return tx_atan2_float(a, b); }
SHARED float clamp(float x, float low, float high) { return tx_clamp_float(x, low, high); }
SHARED float mix(float a, float b, float t) { return tx_mix_float(a, b, t); }
SHARED float3 mix(float3 a, float3 b, float t) { return tx_mix_float3(a, b, float3(t)); }
SHARED float smoothstep(float a, float b, float x) { return tx_smoothstep_float(a, b, x); }
SHARED float dot(float2 a, float2 b) { return tx_dot_float2(a, b); }
SHARED float dot(float3 a, float3 b) { return tx_dot_float3(a, b); }
SHARED float length(float2 a) { return tx_length_float2(a); }
SHARED float length(float3 a) { return tx_length_float3(a); }
SHARED float2 make_float2(float x, float y) { return float2(x, y); }
SHARED float3 make_float3(float x, float y, float z) { return float3(x, y, z); }
SHARED float4 make_float4(float x, float y, float z, float w) { return float4(x, y, z, w); }
SHARED float4 to_float4(float3 v, float w) { return float4(v.x, v.y, v.z, w); }
SHARED float3 to_float3(float4 v) { return float3(v.x, v.y, v.z); }

}  // namespace user_language
