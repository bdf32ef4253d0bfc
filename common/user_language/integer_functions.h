// OpenCL's integer functions of one int or uint, and the results that user textures get where C and
// OpenCL leave them open: division by zero, wide shifts, overflow, conversions out of range.
#pragma once

#include "platform.h"

#include "common/math.h"

// Signed arithmetic wraps around.
SHARED int tx_add_int(int a, int b) { return (int)((uint)a + (uint)b); }
SHARED int tx_subtract_int(int a, int b) { return (int)((uint)a - (uint)b); }
SHARED int tx_multiply_int(int a, int b) { return (int)((uint)a * (uint)b); }
SHARED int tx_negate_int(int a) { return (int)(0u - (uint)a); }

// x / 0 is 0 and x % 0 is x; INT_MIN / -1 is INT_MIN and INT_MIN % -1 is 0.
SHARED int tx_divide_int(int a, int b)
{
    const int is_minus_one = b == -1;
    const int divisor = b == 0 || is_minus_one ? 1 : b;
    const int quotient = a / divisor;
    const int negated = tx_negate_int(a);
    return b == 0 ? 0 : (is_minus_one ? negated : quotient);
}
SHARED int tx_modulo_int(int a, int b)
{
    const int divisor = b == 0 || b == -1 ? 1 : b;
    const int rest = a % divisor;
    return b == 0 ? a : rest;
}
SHARED uint tx_divide_uint(uint a, uint b)
{
    const uint quotient = a / (b == 0u ? 1u : b);
    return b == 0u ? 0u : quotient;
}
SHARED uint tx_modulo_uint(uint a, uint b)
{
    const uint rest = a % (b == 0u ? 1u : b);
    return b == 0u ? a : rest;
}

// The count modulo 32, as OpenCL has it.
SHARED int tx_shift_left_int(int a, int n) { return (int)((uint)a << ((uint)n & 31u)); }
SHARED int tx_shift_right_int(int a, int n) { return a >> ((uint)n & 31u); }
SHARED uint tx_shift_left_uint(uint a, int n) { return a << ((uint)n & 31u); }
SHARED uint tx_shift_right_uint(uint a, int n) { return a >> ((uint)n & 31u); }

// Towards zero, clamped to the range, 0 for NaN.
SHARED int tx_convert_int_float(float x) { return float_to_int(x); }
SHARED uint tx_convert_uint_float(float x)
{
    const float inside = x > 0.0f && x < 4294967296.0f ? x : 0.0f;
    const int is_upper = inside >= 2147483648.0f;
    const uint low = (uint)(int)(is_upper ? inside - 2147483648.0f : inside);
    const uint value = is_upper ? low + 2147483648u : low;
    return x >= 4294967296.0f ? 4294967295u : value;
}

SHARED uint tx_abs_int(int x) { return x < 0 ? 0u - (uint)x : (uint)x; }
SHARED uint tx_abs_uint(uint x) { return x; }
SHARED uint tx_abs_diff_int(int x, int y) { return x < y ? (uint)y - (uint)x : (uint)x - (uint)y; }
SHARED uint tx_abs_diff_uint(uint x, uint y) { return x < y ? y - x : x - y; }
SHARED int tx_add_sat_int(int x, int y)
{
    const int sum = tx_add_int(x, y);
    const int overflows = ((x ^ sum) & (y ^ sum)) < 0;
    return overflows ? (x < 0 ? -2147483647 - 1 : 2147483647) : sum;
}
SHARED uint tx_add_sat_uint(uint x, uint y) { return x + y < x ? 0xffffffffu : x + y; }
SHARED int tx_sub_sat_int(int x, int y)
{
    const int difference = tx_subtract_int(x, y);
    const int overflows = ((x ^ y) & (x ^ difference)) < 0;
    return overflows ? (x < 0 ? -2147483647 - 1 : 2147483647) : difference;
}
SHARED uint tx_sub_sat_uint(uint x, uint y) { return x < y ? 0u : x - y; }
SHARED int tx_hadd_int(int x, int y) { return tx_add_int(x & y, (x ^ y) >> 1); }
SHARED uint tx_hadd_uint(uint x, uint y) { return (x & y) + ((x ^ y) >> 1); }
SHARED int tx_rhadd_int(int x, int y) { return tx_subtract_int(x | y, (x ^ y) >> 1); }
SHARED uint tx_rhadd_uint(uint x, uint y) { return (x | y) - ((x ^ y) >> 1); }
SHARED int tx_max_int(int x, int y) { return x < y ? y : x; }
SHARED uint tx_max_uint(uint x, uint y) { return x < y ? y : x; }
SHARED int tx_min_int(int x, int y) { return y < x ? y : x; }
SHARED uint tx_min_uint(uint x, uint y) { return y < x ? y : x; }
SHARED int tx_clamp_int(int x, int low, int high) { return tx_min_int(tx_max_int(x, low), high); }
SHARED uint tx_clamp_uint(uint x, uint low, uint high)
{
    return tx_min_uint(tx_max_uint(x, low), high);
}
SHARED uint tx_popcount_uint(uint x)
{
    const uint pairs = x - ((x >> 1) & 0x55555555u);
    const uint fours = (pairs & 0x33333333u) + ((pairs >> 2) & 0x33333333u);
    return (((fours + (fours >> 4)) & 0x0f0f0f0fu) * 0x01010101u) >> 24;
}
SHARED int tx_popcount_int(int x) { return (int)tx_popcount_uint((uint)x); }
SHARED uint tx_clz_uint(uint x)
{
    const uint a = x | (x >> 1);
    const uint b = a | (a >> 2);
    const uint c = b | (b >> 4);
    const uint d = c | (c >> 8);
    return 32u - tx_popcount_uint(d | (d >> 16));
}
SHARED int tx_clz_int(int x) { return (int)tx_clz_uint((uint)x); }
SHARED uint tx_mul_hi_uint(uint x, uint y) { return multiply_high(x, y); }
SHARED int tx_mul_hi_int(int x, int y)
{
    const uint product = tx_mul_hi_uint((uint)x, (uint)y);
    return (int)(product - (x < 0 ? (uint)y : 0u) - (y < 0 ? (uint)x : 0u));
}
SHARED int tx_mad_hi_int(int a, int b, int c) { return tx_add_int(tx_mul_hi_int(a, b), c); }
SHARED uint tx_mad_hi_uint(uint a, uint b, uint c) { return tx_mul_hi_uint(a, b) + c; }
SHARED uint tx_mad_sat_uint(uint a, uint b, uint c)
{
    const uint product = tx_mul_hi_uint(a, b) != 0u ? 0xffffffffu : a * b;
    return tx_add_sat_uint(product, c);
}
// a * b + c in 64 bits, then clamped.
SHARED int tx_mad_sat_int(int a, int b, int c)
{
    const uint product = (uint)a * (uint)b;
    const uint low = product + (uint)c;
    const int carry = low < product ? 1 : 0;
    const int high = tx_add_int(tx_add_int(tx_mul_hi_int(a, b), c < 0 ? -1 : 0), carry);
    const int fits = high == ((int)low >> 31);
    return fits ? (int)low : (high < 0 ? -2147483647 - 1 : 2147483647);
}
SHARED uint tx_rotate_uint(uint x, uint n)
{
    return (x << (n & 31u)) | ((x >> 1) >> (31u - (n & 31u)));
}
SHARED int tx_rotate_int(int x, int n) { return (int)tx_rotate_uint((uint)x, (uint)n); }
SHARED int tx_mul24_int(int x, int y)
{
    return tx_multiply_int((int)((uint)x << 8) >> 8, (int)((uint)y << 8) >> 8);
}
SHARED uint tx_mul24_uint(uint x, uint y) { return (x & 0xffffffu) * (y & 0xffffffu); }
SHARED int tx_mad24_int(int x, int y, int z) { return tx_add_int(tx_mul24_int(x, y), z); }
SHARED uint tx_mad24_uint(uint x, uint y, uint z) { return tx_mul24_uint(x, y) + z; }
SHARED int tx_bitselect_int(int a, int b, int c) { return (a & ~c) | (b & c); }
SHARED uint tx_bitselect_uint(uint a, uint b, uint c) { return (a & ~c) | (b & c); }

// select(a, b, c): b where c is set; for components of vectors, where its highest bit is.
SHARED float tx_select_float_int(float a, float b, int c) { return c != 0 ? b : a; }
SHARED float tx_select_float_uint(float a, float b, uint c) { return c != 0u ? b : a; }
SHARED int tx_select_int_int(int a, int b, int c) { return c != 0 ? b : a; }
SHARED int tx_select_int_uint(int a, int b, uint c) { return c != 0u ? b : a; }
SHARED uint tx_select_uint_int(uint a, uint b, int c) { return c != 0 ? b : a; }
SHARED uint tx_select_uint_uint(uint a, uint b, uint c) { return c != 0u ? b : a; }
SHARED float tx_pick_float_int(float a, float b, int c) { return c < 0 ? b : a; }
SHARED float tx_pick_float_uint(float a, float b, uint c) { return (int)c < 0 ? b : a; }
SHARED int tx_pick_int_int(int a, int b, int c) { return c < 0 ? b : a; }
SHARED int tx_pick_int_uint(int a, int b, uint c) { return (int)c < 0 ? b : a; }
SHARED uint tx_pick_uint_int(uint a, uint b, int c) { return c < 0 ? b : a; }
SHARED uint tx_pick_uint_uint(uint a, uint b, uint c) { return (int)c < 0 ? b : a; }

SHARED int tx_as_int_float(float x) { return as_int(x); }
SHARED uint tx_as_uint_float(float x) { return as_uint(x); }
SHARED float tx_as_float_int(int x) { return as_float(x); }
SHARED float tx_as_float_uint(uint x) { return as_float(x); }
SHARED float tx_as_float_float(float x) { return x; }
SHARED int tx_as_int_uint(uint x) { return (int)x; }
SHARED int tx_as_int_int(int x) { return x; }
SHARED uint tx_as_uint_int(int x) { return (uint)x; }
SHARED uint tx_as_uint_uint(uint x) { return x; }

SHARED int tx_convert_int_int(int x) { return x; }
SHARED int tx_convert_int_uint(uint x) { return (int)x; }
SHARED uint tx_convert_uint_uint(uint x) { return x; }
SHARED uint tx_convert_uint_int(int x) { return (uint)x; }
SHARED float tx_convert_float_float(float x) { return x; }
SHARED float tx_convert_float_int(int x) { return (float)x; }
SHARED float tx_convert_float_uint(uint x) { return (float)x; }
SHARED int tx_convert_int_sat_int(int x) { return x; }
SHARED uint tx_convert_uint_sat_uint(uint x) { return x; }
SHARED int tx_convert_int_sat_uint(uint x) { return x > 2147483647u ? 2147483647 : (int)x; }
SHARED uint tx_convert_uint_sat_int(int x) { return x < 0 ? 0u : (uint)x; }
SHARED int tx_any_int(int x) { return x < 0; }
SHARED int tx_all_int(int x) { return x < 0; }
