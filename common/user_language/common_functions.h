// OpenCL's common, relational and splitting functions of floats, and those of error and gamma
// functions, which need the elementary ones.
#pragma once

#include "common/user_language/scalar_functions.h"

// The Chebyshev fit of erfcc in Numerical Recipes, relative error below 1.2e-7 but for rounding.
SHARED float tx_erfc_float(float x)
{
    const float z = math_abs(x);
    const float t = 1.0f / (1.0f + 0.5f * z);
    const float p =
        -1.26551223f +
        t * (1.00002368f +
             t * (0.37409196f +
                  t * (0.09678418f +
                       t * (-0.18628806f +
                            t * (0.27886807f + t * (-1.13520398f +
                                                    t * (1.48851587f + t * (-0.82215223f +
                                                                            t * 0.17087277f))))))));
    const float size = t * math_exp(-z * z + p);
    return x < 0.0f ? 2.0f - size : size;
}
SHARED float tx_erf_float(float x)
{
    const float z = x * x;
    const float near =
        x * (1.12837917f + z * (-0.376126389f + z * (0.112837917f + z * -0.0268661706f)));
    return math_abs(x) < 0.25f ? near : 1.0f - tx_erfc_float(x);
}
// Lanczos' approximation (g = 5, six terms), for x > 0.
SHARED float tx_log_gamma_positive(float x)
{
    const float t = x + 5.5f;
    const float sum = 1.0f + 76.1800917f / (x + 1.0f) - 86.5053203f / (x + 2.0f) +
                      24.0140982f / (x + 3.0f) - 1.23173957f / (x + 4.0f) +
                      0.00120865097f / (x + 5.0f) - 5.39523938e-06f / (x + 6.0f);
    return (x + 0.5f) * math_log(t) - t + math_log(2.50662827f * sum / x);
}
SHARED float tx_lgamma_float(float x)
{
    const float a = math_abs(x);
    const float positive = tx_log_gamma_positive(a > 0.0f ? a : 1.0f);
    const float reflected =
        math_log(PI / math_abs(x * math_sinpi(x))) - positive;  // gamma(-x) gamma(x)
    const float whole = math_floor(x) == x ? TX_INFINITY : reflected;
    return x > 0.0f ? positive : (x == x ? whole : x);
}
SHARED float tx_tgamma_float(float x)
{
    const float size = math_exp(tx_lgamma_float(x));
    const float half_floor = 0.5f * math_floor(x);
    const float odd = math_floor(half_floor) == half_floor ? size : -size;
    const float negative = math_floor(x) == x ? TX_NAN : odd;
    return x > 0.0f ? size : (x == 0.0f ? 1.0f / x : negative);
}
SHARED float tx_clamp_float(float x, float low, float high)
{
    const float above = x < low ? low : x;
    return high < above ? high : above;
}
SHARED float tx_mix_float(float a, float b, float t) { return a + (b - a) * t; }
SHARED float tx_step_float(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
// As the formula gives it, with descending edges too; at equal edges a step.
SHARED float tx_smoothstep_float(float low, float high, float x)
{
    const float width = high - low;
    const float ratio = (x - low) / (width != 0.0f ? width : 1.0f);
    const float t = tx_clamp_float(width != 0.0f ? ratio : (x < low ? 0.0f : 1.0f), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}
SHARED float tx_sign_float(float x)
{
    return x > 0.0f ? 1.0f : (x < 0.0f ? -1.0f : (x == 0.0f ? x : 0.0f));
}
SHARED float tx_degrees_float(float x) { return x * 57.2957795f; }
SHARED float tx_radians_float(float x) { return x * 0.0174532925f; }

SHARED int tx_isequal_float(float x, float y) { return x == y; }
SHARED int tx_isnotequal_float(float x, float y) { return x != y; }
SHARED int tx_isgreater_float(float x, float y) { return x > y; }
SHARED int tx_isgreaterequal_float(float x, float y) { return x >= y; }
SHARED int tx_isless_float(float x, float y) { return x < y; }
SHARED int tx_islessequal_float(float x, float y) { return x <= y; }
SHARED int tx_islessgreater_float(float x, float y) { return x < y || x > y; }
SHARED int tx_isordered_float(float x, float y) { return x == x && y == y; }
SHARED int tx_isunordered_float(float x, float y) { return x != x || y != y; }
SHARED int tx_isfinite_float(float x) { return math_abs(x) < TX_INFINITY; }
SHARED int tx_isinf_float(float x) { return math_abs(x) == TX_INFINITY; }
SHARED int tx_isnan_float(float x) { return x != x; }
SHARED int tx_isnormal_float(float x)
{
    const int is_finite = math_abs(x) < TX_INFINITY;
    return math_abs(x) >= 1.17549435e-38f ? is_finite : 0;
}
SHARED int tx_signbit_float(float x) { return as_int(x) < 0; }

SHARED float tx_bitselect_float(float a, float b, float c)
{
    return as_float((as_uint(a) & ~as_uint(c)) | (as_uint(b) & as_uint(c)));
}
SHARED float tx_length_float(float x) { return math_abs(x); }
SHARED float tx_dot_float(float a, float b) { return a * b; }
SHARED float tx_distance_float(float a, float b) { return math_abs(a - b); }
SHARED float tx_normalize_float(float x) { return tx_sign_float(x); }

// In [0, 1): x - floor(x), below one also where that rounds up to it.
SHARED float tx_fraction_float(float x)
{
    const float rest = x - math_floor(x);
    return rest < 0.999999940f ? rest : 0.999999940f;
}
SHARED float tx_signed_fraction_float(float x)
{
    const float rest = x - tx_trunc_float(x);
    return math_abs(x) < TX_INFINITY ? rest : (x == x ? tx_copysign_float(0.0f, x) : x);
}
// x = significand * 2^exponent, the significand in [0.5, 1).
SHARED int tx_exponent_float(float x)
{
    const int exponent = tx_ilogb_float(x) + 1;
    return math_abs(x) > 0.0f && math_abs(x) < TX_INFINITY ? exponent : 0;
}
SHARED float tx_significand_float(float x) { return tx_ldexp_float(x, -tx_exponent_float(x)); }
SHARED float tx_fract_float(float x, float* whole)
{
    *whole = math_floor(x);
    return tx_fraction_float(x);
}
SHARED float tx_modf_float(float x, float* whole)
{
    *whole = tx_trunc_float(x);
    return tx_signed_fraction_float(x);
}
SHARED float tx_sincos_float(float x, float* cosine)
{
    *cosine = math_cos(x);
    return math_sin(x);
}
SHARED float tx_frexp_float(float x, int* exponent)
{
    *exponent = tx_exponent_float(x);
    return tx_significand_float(x);
}
