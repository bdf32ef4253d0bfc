// Floats as their bits: what the elementary functions are made of.
#pragma once

#define FLOAT_INFINITY as_float(0x7f800000u)
#define FLOAT_NAN as_float(0x7fc00000u)

// 2^n for an integer n in [-126, 127].
SHARED float float_power_of_two(int n) { return as_float((uint)(n + 127) << 23); }

// x * 2^n for n in [-252, 254], rounded once.
SHARED float float_scale(float x, int n)
{
    const int half_n = n >> 1;
    return x * float_power_of_two(half_n) * float_power_of_two(n - half_n);
}

// The upper 12 bits of the significand; x - float_high(x) is exact and holds the rest. Products of
// two such parts are exact.
SHARED float float_high(float x) { return as_float(as_uint(x) & 0xfffff000u); }

// magnitude with the sign bit of `sign` (0 or 0x80000000) flipped in.
SHARED float float_flip(float magnitude, uint sign) { return as_float(as_uint(magnitude) ^ sign); }

// x = significand * 2^exponent, the significand in [sqrt(1/2), sqrt(2)).
typedef struct {
    float significand;
    float exponent;
} FloatParts;

// For positive finite x, denormals included; for others some finite numbers, to be selected away.
SHARED FloatParts float_parts(float x)
{
    const int is_small = x < 1.17549435e-38f;
    const uint bits = as_uint(is_small ? x * 16777216.0f : x) - 0x3f3504f3u;
    FloatParts parts;
    parts.significand = as_float((bits & 0x007fffffu) + 0x3f3504f3u);
    parts.exponent = (float)((int)bits >> 23) - (is_small ? 24.0f : 0.0f);
    return parts;
}
