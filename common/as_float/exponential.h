// Exponentials and logarithms.
#pragma once

#include "common/as_float/bits.h"

// Within 1 ulp.
SHARED float math_exp(float x)
{
    // Beyond these bounds the result has overflowed or vanished; a NaN becomes the lower one.
    const float low = x > -105.0f ? x : -105.0f;
    const float t = low < 90.0f ? low : 90.0f;
    const float n = math_floor(t * 1.44269502f + 0.5f);
    const float r = t - n * 0.693359375f - n * -0.000212194442f;
    const float p =
        r * r *
        (0.49999994f +
         r * (0.166665196f + r * (0.0416683927f + r * (0.00836875103f + r * 0.00138145336f))));
    const float value = float_scale(1.0f + (r + p), (int)n);
    return x == x ? value : FLOAT_NAN;
}

// 2^r for r in [-0.5, 0.5], a little beyond allowed.
SHARED float exp2_fraction(float r)
{
    return 1.0f + r * (0.693147182f +
                       r * (0.240226477f + r * (0.0555033199f +
                                                r * (0.00961843878f +
                                                     r * (0.00133990031f + r * 0.000153532441f)))));
}

// Within 1.25 ulp, exact for integers.
SHARED float math_exp2(float x)
{
    const float low = x > -151.0f ? x : -151.0f;
    const float t = low < 129.0f ? low : 129.0f;
    const float n = math_floor(t + 0.5f);
    const float value = float_scale(exp2_fraction(t - n), (int)n);
    return x == x ? value : FLOAT_NAN;
}

// f^2 and more of log(1 + f) = f - log_tail(f), for 1 + f in [sqrt(1/2), sqrt(2)).
SHARED float log_tail(float f)
{
    const float p =
        0.333333135f +
        f * (-0.250000089f +
             f * (0.200021192f +
                  f * (-0.166679963f +
                       f * (0.142195523f +
                            f * (-0.1240559f +
                                 f * (0.118881628f + f * (-0.116756506f + f * 0.0674663782f)))))));
    return f * f * (0.5f - f * p);
}

// The logarithm's special values, where `value` is right for positive finite x.
SHARED float log_special(float x, float value)
{
    const float positive = x < FLOAT_INFINITY ? value : FLOAT_INFINITY;
    const float other = x == 0.0f ? -FLOAT_INFINITY : FLOAT_NAN;
    return x > 0.0f ? positive : other;
}

// Within 1 ulp; -infinity at 0, NaN below.
SHARED float math_log(float x)
{
    const FloatParts parts = float_parts(x);
    const float f = parts.significand - 1.0f;
    const float e = parts.exponent;
    return log_special(x, e * 0.693359375f + (f - (log_tail(f) - e * -0.000212194442f)));
}

// Within 1.75 ulp, exact for powers of two; -infinity at 0, NaN below.
SHARED float math_log2(float x)
{
    const FloatParts parts = float_parts(x);
    const float f = parts.significand - 1.0f;
    const float tail = log_tail(f);
    const float value = (f * 0.442695041f - tail * 1.44269504f) + f;
    return log_special(x, parts.exponent + value);
}
