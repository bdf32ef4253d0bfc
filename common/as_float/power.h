// Powers and the cube root.
#pragma once

#include "common/as_float/bits.h"
#include "common/as_float/exponential.h"

// A number as the exact sum of a 12-bit leading part and a small rest.
typedef struct {
    float high;
    float low;
} FloatPair;

// log2 of positive finite x to about 36 bits: y * log2(x) must be right to 2^-22 where it is 128.
// As in FreeBSD's powf: s = (m - 1) / (m + 1), log(m) = 2/3 * s * (3 + s^2 + s^4 * (3/5 + ...)).
SHARED FloatPair log2_pair(float x)
{
    const FloatParts parts = float_parts(x);
    const float m = parts.significand;
    const float numerator = m - 1.0f;
    const float denominator = m + 1.0f;
    const float inverse = 1.0f / denominator;
    const float s = numerator * inverse;
    const float s_high = float_high(s);
    const float denominator_high = float_high(denominator);
    const float denominator_low = m - (denominator_high - 1.0f);
    const float s_low =
        inverse * ((numerator - s_high * denominator_high) - s_high * denominator_low);

    const float square = s * s;
    const float r =
        square * square *
            (0.6f + square * (0.428571433f + square * (0.333333343f + square * 0.275f))) +
        s_low * (s_high + s);
    const float square_high = s_high * s_high;
    const float sum_high = float_high(3.0f + square_high + r);
    const float sum_low = r - ((sum_high - 3.0f) - square_high);

    const float product = s_high * sum_high;
    const float rest = s_low * sum_high + sum_low * s;
    const float p_high = float_high(product + rest);
    const float p_low = rest - (p_high - product);
    // 2 / (3 ln 2) in two parts.
    const float z_high = 0.961914062f * p_high;
    const float z_low = -0.000117368574f * p_high + p_low * 0.9617967f;
    FloatPair result;
    result.high = float_high((z_high + z_low) + parts.exponent);
    result.low = z_low - ((result.high - parts.exponent) - z_high);
    return result;
}

// |x|^y for positive finite |x|.
SHARED float power_of_magnitude(float magnitude, float y)
{
    // Beyond 2^35 every power but that of 1 has overflowed or vanished.
    const float above = y > -3.4e10f ? y : -3.4e10f;
    const float exponent = above < 3.4e10f ? above : 3.4e10f;
    const FloatPair logarithm = log2_pair(magnitude);
    const float y_high = float_high(exponent);
    const float raw_high = y_high * logarithm.high;
    const float raw_low = (exponent - y_high) * logarithm.high + exponent * logarithm.low;
    const float raw = raw_high + raw_low;
    const int is_usual = math_abs(raw) < 160.0f;
    const float high = is_usual ? raw_high : (raw > 0.0f ? 160.0f : -160.0f);
    const float low = is_usual ? raw_low : 0.0f;
    const float n = math_floor((high + low) + 0.5f);
    return float_scale(exp2_fraction((high - n) + low), (int)n);
}

// Within 1.5 ulp; the special values are C99's.
SHARED float math_pow(float x, float y)
{
    const float magnitude = math_abs(x);
    const int is_integer = math_floor(y) == y;
    const float half_y = 0.5f * y;
    const int is_odd = is_integer & (math_floor(half_y) != half_y);
    const int is_falling = y < 0.0f;
    const float usual = power_of_magnitude(magnitude, y);
    const float at_zero = is_falling ? FLOAT_INFINITY : 0.0f;
    const float at_infinity = is_falling ? 0.0f : FLOAT_INFINITY;
    const float finite = magnitude < FLOAT_INFINITY ? usual : at_infinity;
    const float positive = magnitude == 0.0f ? at_zero : finite;
    const float value = float_flip(positive, is_odd ? as_uint(x) & 0x80000000u : 0u);
    const int is_real = (x >= 0.0f) | is_integer | (magnitude == FLOAT_INFINITY);
    const int is_number = (x == x) & (y == y) & is_real;
    const int is_one = (x == 1.0f) | (y == 0.0f);
    return is_one ? 1.0f : (is_number ? value : FLOAT_NAN);
}

// Within 1 ulp; the root of a negative number is negative.
SHARED float math_cbrt(float x)
{
    const float magnitude = math_abs(x);
    const int is_small = magnitude < 1.17549435e-38f;
    const uint bits = as_uint(is_small ? magnitude * 16777216.0f : magnitude);
    const float exponent = (float)(int)(bits >> 23) - (is_small ? 151.0f : 127.0f);
    const float third = math_floor((exponent + 0.5f) * 0.333333343f);
    const float remainder = exponent - 3.0f * third;  // 0, 1 or 2
    const float m = as_float((bits & 0x007fffffu) | 0x3f800000u);
    const float guess = 0.552823365f + m * (0.587114334f + m * (-0.162969708f + m * 0.0231049675f));
    const float scaled = m * (remainder == 0.0f ? 1.0f : (remainder == 1.0f ? 2.0f : 4.0f));
    const float t =
        guess * (remainder == 0.0f ? 1.0f : (remainder == 1.0f ? 1.25992105f : 1.58740105f));
    // One step of Halley's iteration triples the guess's 13 bits.
    const float cube = t * t * t;
    const float root = t + t * ((scaled - cube) / (cube + cube + scaled));
    const float value = float_flip(root * float_power_of_two((int)third), as_uint(x) & 0x80000000u);
    const float other = x == x ? x : FLOAT_NAN;  // 0, -0 and the infinities are their own roots
    return magnitude > 0.0f ? (magnitude < FLOAT_INFINITY ? value : other) : other;
}
