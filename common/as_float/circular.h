// Sine, cosine and tangent; sine and cosine of multiples of pi.
#pragma once

#include "common/as_float/bits.h"

// An angle as the nearest multiple of a right angle, modulo 4, and the rest in [-pi/4, pi/4].
typedef struct {
    uint quadrant;
    float rest;
} Angle;

// Payne and Hanek's reduction without branches, for x >= 0 of any size: x is a 25-bit integer m
// times a power of two, so only 96 bits of 2/pi, chosen by that power, decide x * 2/pi modulo 4 and
// its fraction to 62 bits; the closest a float comes to a multiple of pi/2 is 2^-30.
SHARED Angle angle_reduce(float x)
{
    const uint bits = as_uint(x);
    const int exponent = (int)(bits >> 23) - 127;
    const uint significand = (bits & 0x007fffffu) | 0x00800000u;
    const uint m = exponent < 0 ? significand : significand << 1;
    const uint offset = exponent < 0 ? 0u : (uint)exponent & 127u;

    // 2/pi after 26 zero bits; words offset / 32 and the next three.
    const int is_upper = offset >= 64u;
    const uint a0 = is_upper ? 0x91054a7fu : 0x00000028u;
    const uint a1 = is_upper ? 0x09d5f47du : 0xbe60db93u;
    const uint a2 = is_upper ? 0x4d377036u : 0x91054a7fu;
    const uint a3 = is_upper ? 0xd8a5664fu : 0x09d5f47du;
    const uint a4 = is_upper ? 0x10e4107fu : 0x4d377036u;
    const int is_odd = (offset & 32u) != 0u;
    const uint b0 = is_odd ? a1 : a0;
    const uint b1 = is_odd ? a2 : a1;
    const uint b2 = is_odd ? a3 : a2;
    const uint b3 = is_odd ? a4 : a3;
    const uint left = offset & 31u;
    const uint right = 31u - left;
    const uint w0 = (b0 << left) | ((b1 >> 1) >> right);
    const uint w1 = (b1 << left) | ((b2 >> 1) >> right);
    const uint w2 = (b2 << left) | ((b3 >> 1) >> right);

    // m * (w0 w1 w2) modulo 2^96, without its last word: 2 bits of quadrant, 62 of fraction. In
    // halves, because vector units multiply 32 bits by 32 to 32; the sum of the lowest products
    // leaves out a carry of less than 2 in 2^62.
    const uint m_low = m & 0xffffu;
    const uint m_high = m >> 16;
    const uint w2_high = w2 >> 16;
    const uint p2 =
        m_high * w2_high + ((m_low * w2_high) >> 16) + ((m_high * (w2 & 0xffffu)) >> 16);
    const uint w1_low = w1 & 0xffffu;
    const uint w1_high = w1 >> 16;
    const uint inner = m_low * w1_high + ((m_low * w1_low) >> 16);
    const uint outer = m_high * w1_low + (inner & 0xffffu);
    const uint p1 = m_high * w1_high + (inner >> 16) + (outer >> 16);
    const uint middle = m * w1;
    const uint low = middle + p2;
    const uint high = m * w0 + p1 + (low < middle ? 1u : 0u);
    const uint quadrant = (high + 0x20000000u) >> 30;

    // fraction * pi/2, the leading 12 bits apart, so that only the last sum rounds.
    const int fraction = (int)(high - (quadrant << 30));
    const int leading = (fraction + 0x20000) >> 18;
    const float trailing =
        (float)(fraction - (leading * 0x40000)) + (float)(int)(low >> 1) * 4.65661287e-10f;
    const float rest = (float)leading * 0.000383377075f +
                       ((float)leading * 1.18121775e-07f + trailing * 1.46291812e-09f);
    const int is_reduced = x < 0.785398185f;
    Angle angle;
    angle.quadrant = is_reduced ? 0u : quadrant;
    angle.rest = is_reduced ? x : rest;
    return angle;
}

// sin and cos of [-pi/4, pi/4].
SHARED float sine_rest(float r)
{
    const float z = r * r;
    return r + r * z * (-0.166666552f + z * (0.00833215844f + z * -0.00019514958f));
}
SHARED float cosine_rest(float r)
{
    const float z = r * r;
    return 1.0f - (0.5f * z - z * z * (0.0416666456f + z * (-0.0013887313f + z * 2.44327839e-05f)));
}

// Within 2 ulp for every finite x, and in [-1, 1].
SHARED float math_sin(float x)
{
    const Angle angle = angle_reduce(math_abs(x));
    const float s = sine_rest(angle.rest);
    const float c = cosine_rest(angle.rest);
    const float value = (angle.quadrant & 1u) != 0u ? c : s;
    const uint sign = (as_uint(x) & 0x80000000u) ^ ((angle.quadrant & 2u) << 30);
    return math_abs(x) < FLOAT_INFINITY ? float_flip(value, sign) : FLOAT_NAN;
}

// Within 2 ulp for every finite x, and in [-1, 1].
SHARED float math_cos(float x)
{
    const Angle angle = angle_reduce(math_abs(x));
    const float s = sine_rest(angle.rest);
    const float c = cosine_rest(angle.rest);
    const float value = (angle.quadrant & 1u) != 0u ? s : c;
    const uint sign = ((angle.quadrant + 1u) & 2u) << 30;
    return math_abs(x) < FLOAT_INFINITY ? float_flip(value, sign) : FLOAT_NAN;
}

// Within 3.75 ulp for every finite x.
SHARED float math_tan(float x)
{
    const Angle angle = angle_reduce(math_abs(x));
    const float s = sine_rest(angle.rest);
    const float c = cosine_rest(angle.rest);
    const int is_odd = (angle.quadrant & 1u) != 0u;
    const float value = (is_odd ? -c : s) / (is_odd ? s : c);
    return math_abs(x) < FLOAT_INFINITY ? float_flip(value, as_uint(x) & 0x80000000u) : FLOAT_NAN;
}

// sinpi and cospi share: 2x rounded, and pi times what remains. From 2^24 on every float is an even
// integer; so, here, are infinities and NaN.
SHARED Angle angle_of_pi_multiple(float x)
{
    const float a = x < 16777216.0f ? x : 0.0f;
    // A little less than a half, lest an odd 2a of 24 bits be rounded up.
    const float n = math_floor(2.0f * a + 0.49999997f);
    Angle angle;
    angle.quadrant = (uint)(int)n & 3u;
    angle.rest = (a - 0.5f * n) * 3.14159274f;
    return angle;
}

// sin(pi * x), within 2 ulp; exact at multiples of a half, zero with the sign of x at integers.
// A quarter of the work of math_sin: sin(2 pi u) is math_sinpi(2 u).
SHARED float math_sinpi(float x)
{
    const Angle angle = angle_of_pi_multiple(math_abs(x));
    const float s = sine_rest(angle.rest);
    const float c = cosine_rest(angle.rest);
    const float value = (angle.quadrant & 1u) != 0u ? c : s;
    const uint turn = value == 0.0f ? 0u : (angle.quadrant & 2u) << 30;
    const uint sign = (as_uint(x) & 0x80000000u) ^ turn;
    return math_abs(x) < FLOAT_INFINITY ? float_flip(value, sign) : FLOAT_NAN;
}

// cos(pi * x), within 2 ulp; exact at multiples of a half, +0 where it is zero.
SHARED float math_cospi(float x)
{
    const Angle angle = angle_of_pi_multiple(math_abs(x));
    const float s = sine_rest(angle.rest);
    const float c = cosine_rest(angle.rest);
    const float value = (angle.quadrant & 1u) != 0u ? s : c;
    const uint sign = value == 0.0f ? 0u : ((angle.quadrant + 1u) & 2u) << 30;
    return math_abs(x) < FLOAT_INFINITY ? float_flip(value, sign) : FLOAT_NAN;
}
