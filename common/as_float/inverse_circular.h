// Arc sine, arc cosine and the angle of a vector.
#pragma once

#include "common/as_float/bits.h"

// asin of x in [0, 0.5], given x and z = x^2 rounded or better.
SHARED float arc_sine_small(float x, float z)
{
    return x +
           x * z *
               (0.166667521f + z * (0.0749529749f +
                                    z * (0.0454703718f + z * (0.0241795313f + z * 0.0421662889f))));
}

// Within 2.5 ulp; NaN outside [-1, 1].
SHARED float math_asin(float x)
{
    const float a = math_abs(x);
    const int is_large = a > 0.5f;
    const float z = is_large ? 0.5f * (1.0f - a) : a * a;
    const float t = arc_sine_small(is_large ? math_sqrt(z) : a, z);
    const float value = is_large ? 1.57079637f - (2.0f * t + 4.37113883e-08f) : t;
    return a <= 1.0f ? float_flip(value, as_uint(x) & 0x80000000u) : FLOAT_NAN;
}

// Within 1.5 ulp; NaN outside [-1, 1].
SHARED float math_acos(float x)
{
    const float a = math_abs(x);
    const int is_large = a > 0.5f;
    const float z = is_large ? 0.5f * (1.0f - a) : a * a;
    const float t = arc_sine_small(is_large ? math_sqrt(z) : a, z);
    const int is_negative = x < 0.0f;
    const float near_end = 2.0f * (is_negative ? 1.57079637f - (t + 4.37113883e-08f) : t);
    const float middle = 1.57079637f - ((is_negative ? -t : t) + 4.37113883e-08f);
    return a <= 1.0f ? (is_large ? near_end : middle) : FLOAT_NAN;
}

// The angle of the vector (x, y) from the x axis, in [-pi, pi], within 2.5 ulp.
SHARED float math_atan2(float y, float x)
{
    const float ax = math_abs(x);
    const float ay = math_abs(y);
    const int is_steep = ay > ax;
    const float long_side = is_steep ? ay : ax;
    const float short_side = is_steep ? ax : ay;
    // A quarter, so that the sum of the sides stays finite; equal sides cover (inf, inf).
    const float scale = long_side > 1e38f ? 0.25f : 1.0f;
    const float u = short_side * scale;
    const float v = long_side * scale;
    const int is_equal = short_side == long_side;
    const int is_wide = u > 0.414213562f * v;
    const float top = is_wide ? u - v : u;
    const float bottom = is_wide ? u + v : v;
    const float t = is_equal ? 0.0f : top / (bottom == 0.0f ? 1.0f : bottom);
    const float z = t * t;
    const float arc =
        t + t * z * (-0.333329499f + z * (0.199777037f + z * (-0.138776079f + z * 0.0805347711f)));
    const float octant =
        (is_equal ? long_side > 0.0f : is_wide) ? 0.785398185f + (arc - 2.18556941e-08f) : arc;
    const float quadrant = is_steep ? 1.57079637f - (octant + 4.37113883e-08f) : octant;
    const int is_left = (as_uint(x) & 0x80000000u) != 0u;
    const float value = is_left ? 3.14159274f - (quadrant + 8.74227766e-08f) : quadrant;
    const float result = float_flip(value, as_uint(y) & 0x80000000u);
    return x == x ? (y == y ? result : FLOAT_NAN) : FLOAT_NAN;
}
