// OpenCL's math and common functions of one float, as user textures call them (tx_NAME_float).
// Formulas over common/math.h that hold in any precision, so that every backend agrees to the bit;
// selects only, so that loops over paths vectorise. Where OpenCL C 1.2 asks for more accuracy than
// a formula gives, the formula is the definition; docs/textures.md lists those.
#pragma once

#include "platform.h"

#include "common/math.h"

#define TX_NAN as_float(0x7fc00000u)
#define TX_INFINITY as_float(0x7f800000u)

SHARED float tx_sin_float(float x) { return math_sin(x); }
SHARED float tx_cos_float(float x) { return math_cos(x); }
SHARED float tx_tan_float(float x) { return math_tan(x); }
SHARED float tx_asin_float(float x) { return math_asin(x); }
SHARED float tx_acos_float(float x) { return math_acos(x); }
SHARED float tx_atan_float(float x) { return math_atan2(x, 1.0f); }
SHARED float tx_atan2_float(float y, float x) { return math_atan2(y, x); }
SHARED float tx_sinpi_float(float x) { return math_sinpi(x); }
SHARED float tx_cospi_float(float x) { return math_cospi(x); }
SHARED float tx_tanpi_float(float x) { return math_sinpi(x) / math_cospi(x); }
SHARED float tx_asinpi_float(float x) { return math_asin(x) * INV_PI; }
SHARED float tx_acospi_float(float x) { return math_acos(x) * INV_PI; }
SHARED float tx_atanpi_float(float x) { return math_atan2(x, 1.0f) * INV_PI; }
SHARED float tx_atan2pi_float(float y, float x) { return math_atan2(y, x) * INV_PI; }

SHARED float tx_exp_float(float x) { return math_exp(x); }
SHARED float tx_exp2_float(float x) { return math_exp2(x); }
SHARED float tx_exp10_float(float x) { return math_pow(10.0f, x); }
SHARED float tx_log_float(float x) { return math_log(x); }
SHARED float tx_log2_float(float x) { return math_log2(x); }
SHARED float tx_log10_float(float x) { return math_log(x) * 0.434294482f; }
SHARED float tx_pow_float(float x, float y) { return math_pow(x, y); }
// NaN for negative x, as powr is defined.
SHARED float tx_powr_float(float x, float y)
{
    const float value = math_pow(x, y);
    return x >= 0.0f ? value : TX_NAN;
}
SHARED float tx_pown_float(float x, int n) { return math_pow(x, (float)n); }
SHARED float tx_rootn_float(float x, int n)
{
    const float root = math_pow(math_abs(x), 1.0f / (float)n);
    const float odd = x < 0.0f ? -root : root;
    return (n & 1) != 0 ? odd : (x < 0.0f ? TX_NAN : root);
}
SHARED float tx_ldexp_float(float x, int n)
{
    const int high = n > 400 ? 400 : n;
    const int k = high < -400 ? -400 : high;
    const int a = k >> 2;
    const int b = k - 3 * a;
    const float step = as_float((uint)(a + 127) << 23);
    return x * step * step * step * as_float((uint)(b + 127) << 23);
}
SHARED float tx_cbrt_float(float x) { return math_cbrt(x); }
SHARED float tx_sqrt_float(float x) { return math_sqrt(x); }
SHARED float tx_rsqrt_float(float x) { return 1.0f / math_sqrt(x); }
SHARED float tx_recip_float(float x) { return 1.0f / x; }
SHARED float tx_divide_float(float x, float y) { return x / y; }

// By their series near zero, where the exponentials cancel.
SHARED float tx_expm1_float(float x)
{
    const float series =
        x * (1.0f + x * (0.5f + x * (0.166666667f + x * (0.0416666667f + x * 0.00833333377f))));
    const float value = math_exp(x) - 1.0f;
    return math_abs(x) < 0.15f ? series : value;
}
SHARED float tx_log1p_float(float x)
{
    const float sum = 1.0f + x;
    const float rest = x - (sum - 1.0f);
    const float value = math_log(sum) + (math_abs(x) < 1.0e6f ? rest / sum : 0.0f);
    return x > -1.0f && x < TX_INFINITY ? value : math_log(sum);
}
SHARED float tx_sinh_float(float x)
{
    const float half_exp = math_exp(0.5f * x);
    const float half_inverse = math_exp(-0.5f * x);
    const float far = 0.5f * half_exp * half_exp - 0.5f * half_inverse * half_inverse;
    const float z = x * x;
    const float near = x * (1.0f + z * (0.166666667f + z * (0.00833333377f + z * 0.000198412701f)));
    return math_abs(x) < 0.7f ? near : far;
}
SHARED float tx_cosh_float(float x)
{
    const float half_exp = math_exp(0.5f * x);
    const float half_inverse = math_exp(-0.5f * x);
    return 0.5f * half_exp * half_exp + 0.5f * half_inverse * half_inverse;
}
SHARED float tx_tanh_float(float x)
{
    const float a = math_abs(x) < 20.0f ? math_abs(x) : 20.0f;
    const float e = tx_expm1_float(2.0f * a);
    const float value = e / (e + 2.0f);
    return x == x ? (x < 0.0f ? -value : (x > 0.0f ? value : x)) : x;
}
SHARED float tx_asinh_float(float x)
{
    const float a = math_abs(x);
    const float small = tx_log1p_float(a + a * a / (1.0f + math_sqrt(a * a + 1.0f)));
    const float large = math_log(a) + 0.693147182f;
    const float value = a < 1.0e9f ? small : large;
    return x < 0.0f ? -value : value;
}
SHARED float tx_acosh_float(float x)
{
    const float t = x - 1.0f;
    const float small = tx_log1p_float(t + math_sqrt(2.0f * t + t * t));
    const float large = math_log(x) + 0.693147182f;
    return x < 1.0e9f ? small : large;
}
SHARED float tx_atanh_float(float x) { return 0.5f * tx_log1p_float(2.0f * x / (1.0f - x)); }

SHARED float tx_fabs_float(float x) { return math_abs(x); }
SHARED float tx_floor_float(float x) { return math_floor(x); }
SHARED float tx_ceil_float(float x) { return -math_floor(-x); }
SHARED float tx_trunc_float(float x)
{
    const float size = math_floor(math_abs(x));
    return x < 0.0f ? -size : size;
}
// Halves away from zero.
SHARED float tx_round_float(float x)
{
    const float a = math_abs(x);
    const float whole = math_floor(a);
    const float size = whole + (a - whole >= 0.5f ? 1.0f : 0.0f);
    return x < 0.0f ? -size : size;
}
// Halves to even.
SHARED float tx_rint_float(float x)
{
    const float whole = math_floor(x);
    const float rest = x - whole;
    const float half_whole = 0.5f * whole;
    const float odd = math_floor(half_whole) == half_whole ? 0.0f : 1.0f;
    const float step = rest > 0.5f ? 1.0f : (rest == 0.5f ? odd : 0.0f);
    const float value = whole + step;
    return math_abs(x) < 8388608.0f ? value : x;
}
SHARED float tx_copysign_float(float x, float y)
{
    const float size = math_abs(x);
    return as_int(y) < 0 ? -size : size;
}
SHARED float tx_fmax_float(float x, float y) { return math_max(x, y); }
SHARED float tx_fmin_float(float x, float y) { return math_min(x, y); }
SHARED float tx_max_float(float x, float y) { return x < y ? y : x; }
SHARED float tx_min_float(float x, float y) { return y < x ? y : x; }
SHARED float tx_maxmag_float(float x, float y)
{
    const float greater = math_max(x, y);
    const float ax = math_abs(x);
    const float ay = math_abs(y);
    return ax > ay ? x : (ay > ax ? y : greater);
}
SHARED float tx_minmag_float(float x, float y)
{
    const float lesser = math_min(x, y);
    const float ax = math_abs(x);
    const float ay = math_abs(y);
    return ax < ay ? x : (ay < ax ? y : lesser);
}
SHARED float tx_fdim_float(float x, float y)
{
    const float d = x - y;
    return x > y ? d : (x == x && y == y ? 0.0f : TX_NAN);
}
// The sign of x, a size below |y|; off by the rounding of quotient * y where the quotient is large.
SHARED float tx_fmod_float(float x, float y)
{
    const float a = math_abs(x);
    const float b = math_abs(y);
    const float rest = a - math_floor(a / b) * b;
    const float raised = rest < 0.0f ? rest + b : rest;
    const float inside = raised >= b ? raised - b : raised;
    const float size = a < b ? a : inside;
    const float value = x < 0.0f ? -size : size;
    return b > 0.0f && a < TX_INFINITY ? value : TX_NAN;
}
SHARED float tx_remainder_float(float x, float y)
{
    const float value = x - tx_rint_float(x / y) * y;
    return math_abs(x) < TX_INFINITY ? value : TX_NAN;
}
SHARED float tx_hypot_float(float x, float y)
{
    const float a = math_greater(math_abs(x), math_abs(y));
    const float b = math_lesser(math_abs(x), math_abs(y));
    const float ratio = b / (a > 0.0f ? a : 1.0f);
    const float value = a * math_sqrt(1.0f + ratio * ratio);
    return a < TX_INFINITY ? value : (x == x || y == y ? TX_INFINITY : TX_NAN);
}
SHARED float tx_nextafter_float(float x, float y)
{
    const int bits = as_int(x);
    const int towards = (y > x) == (x > 0.0f) ? bits + 1 : bits - 1;
    const float smallest = y > 0.0f ? as_float(0x00000001u) : as_float(0x80000001u);
    const float next = x == 0.0f ? smallest : as_float(towards);
    return x == y ? y : (x == x && y == y ? next : TX_NAN);
}
SHARED float tx_mad_float(float a, float b, float c) { return a * b + c; }
SHARED float tx_nan_uint(uint payload) { return as_float(0x7fc00000u | (payload & 0x003fffffu)); }

SHARED int tx_ilogb_float(float x)
{
    const float a = math_abs(x);
    const int is_small = a < 1.17549435e-38f;
    const int exponent =
        (int)(as_uint(is_small ? a * 16777216.0f : a) >> 23) - (is_small ? 151 : 127);
    return a > 0.0f ? (a < TX_INFINITY ? exponent : 2147483647) : -2147483647;
}
SHARED float tx_logb_float(float x)
{
    const float value = (float)tx_ilogb_float(x);
    const float at_end = x == 0.0f ? -TX_INFINITY : x * x;
    return x == 0.0f || math_abs(x) == TX_INFINITY || x != x ? at_end : value;
}
