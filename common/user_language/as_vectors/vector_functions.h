// The functions of as_vectors/rows.h for vectors, component by component, and those that join
// components. Read inside the scope that has the vector types and TX_NEW(type, components...).
#pragma once

#include "common/user_language/as_vectors/rows.h"

#define TX_EACH_1_2(V, f, a) TX_NEW(V, f(a.x), f(a.y))
#define TX_EACH_1_3(V, f, a) TX_NEW(V, f(a.x), f(a.y), f(a.z))
#define TX_EACH_1_4(V, f, a) TX_NEW(V, f(a.x), f(a.y), f(a.z), f(a.w))
#define TX_EACH_1_8(V, f, a) \
    TX_NEW(V, f(a.s0), f(a.s1), f(a.s2), f(a.s3), f(a.s4), f(a.s5), f(a.s6), f(a.s7))
#define TX_EACH_1_16(V, f, a)                                                                  \
    TX_NEW(V, f(a.s0), f(a.s1), f(a.s2), f(a.s3), f(a.s4), f(a.s5), f(a.s6), f(a.s7), f(a.s8), \
           f(a.s9), f(a.sa), f(a.sb), f(a.sc), f(a.sd), f(a.se), f(a.sf))
#define TX_EACH_2_2(V, f, a, b) TX_NEW(V, f(a.x, b.x), f(a.y, b.y))
#define TX_EACH_2_3(V, f, a, b) TX_NEW(V, f(a.x, b.x), f(a.y, b.y), f(a.z, b.z))
#define TX_EACH_2_4(V, f, a, b) TX_NEW(V, f(a.x, b.x), f(a.y, b.y), f(a.z, b.z), f(a.w, b.w))
#define TX_EACH_2_8(V, f, a, b)                                                          \
    TX_NEW(V, f(a.s0, b.s0), f(a.s1, b.s1), f(a.s2, b.s2), f(a.s3, b.s3), f(a.s4, b.s4), \
           f(a.s5, b.s5), f(a.s6, b.s6), f(a.s7, b.s7))
#define TX_EACH_2_16(V, f, a, b)                                                         \
    TX_NEW(V, f(a.s0, b.s0), f(a.s1, b.s1), f(a.s2, b.s2), f(a.s3, b.s3), f(a.s4, b.s4), \
           f(a.s5, b.s5), f(a.s6, b.s6), f(a.s7, b.s7), f(a.s8, b.s8), f(a.s9, b.s9),    \
           f(a.sa, b.sa), f(a.sb, b.sb), f(a.sc, b.sc), f(a.sd, b.sd), f(a.se, b.se),    \
           f(a.sf, b.sf))
#define TX_EACH_3_2(V, f, a, b, c) TX_NEW(V, f(a.x, b.x, c.x), f(a.y, b.y, c.y))
#define TX_EACH_3_3(V, f, a, b, c) TX_NEW(V, f(a.x, b.x, c.x), f(a.y, b.y, c.y), f(a.z, b.z, c.z))
#define TX_EACH_3_4(V, f, a, b, c) \
    TX_NEW(V, f(a.x, b.x, c.x), f(a.y, b.y, c.y), f(a.z, b.z, c.z), f(a.w, b.w, c.w))
#define TX_EACH_3_8(V, f, a, b, c)                                                                \
    TX_NEW(V, f(a.s0, b.s0, c.s0), f(a.s1, b.s1, c.s1), f(a.s2, b.s2, c.s2), f(a.s3, b.s3, c.s3), \
           f(a.s4, b.s4, c.s4), f(a.s5, b.s5, c.s5), f(a.s6, b.s6, c.s6), f(a.s7, b.s7, c.s7))
#define TX_EACH_3_16(V, f, a, b, c)                                                               \
    TX_NEW(V, f(a.s0, b.s0, c.s0), f(a.s1, b.s1, c.s1), f(a.s2, b.s2, c.s2), f(a.s3, b.s3, c.s3), \
           f(a.s4, b.s4, c.s4), f(a.s5, b.s5, c.s5), f(a.s6, b.s6, c.s6), f(a.s7, b.s7, c.s7),    \
           f(a.s8, b.s8, c.s8), f(a.s9, b.s9, c.s9), f(a.sa, b.sa, c.sa), f(a.sb, b.sb, c.sb),    \
           f(a.sc, b.sc, c.sc), f(a.sd, b.sd, c.sd), f(a.se, b.se, c.se), f(a.sf, b.sf, c.sf))

// A function of one kind for one width n.
#define TX_F1(name, n)                                        \
    SHARED float##n tx_##name##_float##n(float##n a)          \
    {                                                         \
        return TX_EACH_1_##n(float##n, tx_##name##_float, a); \
    }
#define TX_F2(name, n)                                           \
    SHARED float##n tx_##name##_float##n(float##n a, float##n b) \
    {                                                            \
        return TX_EACH_2_##n(float##n, tx_##name##_float, a, b); \
    }
#define TX_F3(name, n)                                                       \
    SHARED float##n tx_##name##_float##n(float##n a, float##n b, float##n c) \
    {                                                                        \
        return TX_EACH_3_##n(float##n, tx_##name##_float, a, b, c);          \
    }
#define TX_FI(name, n)                                           \
    SHARED float##n tx_##name##_float##n(float##n a, int##n b)   \
    {                                                            \
        return TX_EACH_2_##n(float##n, tx_##name##_float, a, b); \
    }
#define TX_T1(name, n)                                       \
    SHARED int##n tx_##name##_float##n(float##n a)           \
    {                                                        \
        return TX_EACH_1_##n(int##n, -tx_##name##_float, a); \
    }
#define TX_T2(name, n)                                          \
    SHARED int##n tx_##name##_float##n(float##n a, float##n b)  \
    {                                                           \
        return TX_EACH_2_##n(int##n, -tx_##name##_float, a, b); \
    }
#define TX_I2(name, n)                                       \
    SHARED int##n tx_##name##_int##n(int##n a, int##n b)     \
    {                                                        \
        return TX_EACH_2_##n(int##n, tx_##name##_int, a, b); \
    }
#define TX_U2(name, n)                                         \
    SHARED uint##n tx_##name##_uint##n(uint##n a, uint##n b)   \
    {                                                          \
        return TX_EACH_2_##n(uint##n, tx_##name##_uint, a, b); \
    }
#define TX_I3(name, n)                                             \
    SHARED int##n tx_##name##_int##n(int##n a, int##n b, int##n c) \
    {                                                              \
        return TX_EACH_3_##n(int##n, tx_##name##_int, a, b, c);    \
    }
#define TX_U3(name, n)                                                  \
    SHARED uint##n tx_##name##_uint##n(uint##n a, uint##n b, uint##n c) \
    {                                                                   \
        return TX_EACH_3_##n(uint##n, tx_##name##_uint, a, b, c);       \
    }
// Functions from a vector of A to one of R.
#define TX_CONVERT(name, R, A, n) \
    SHARED R##n tx_##name##_##A##n(A##n a) { return TX_EACH_1_##n(R##n, tx_##name##_##A, a); }
// Conversions, whose names carry the width twice.
#define TX_CAST(name, R, A, n)                                \
    SHARED R##n tx_##name##_##R##n##_##A##n(A##n a)           \
    {                                                         \
        return TX_EACH_1_##n(R##n, tx_##name##_##R##_##A, a); \
    }
#define TX_PICK(T, C, n)                                          \
    SHARED T##n tx_select_##T##n##_##C##n(T##n a, T##n b, C##n c) \
    {                                                             \
        return TX_EACH_3_##n(T##n, tx_pick_##T##_##C, a, b, c);   \
    }

// clang-format off
#define TX_ROWS_OF_WIDTH(n)                                                                        \
    TX_FLOAT_1(TX_F1_##n)                                                                          \
    TX_FLOAT_2(TX_F2_##n)                                                                          \
    TX_FLOAT_3(TX_F3_##n)                                                                          \
    TX_FLOAT_INT(TX_FI_##n)                                                                        \
    TX_TEST_1(TX_T1_##n)                                                                           \
    TX_TEST_2(TX_T2_##n)                                                                           \
    TX_INT_2(TX_I2_##n)                                                                            \
    TX_UINT_2(TX_U2_##n)                                                                           \
    TX_INT_3(TX_I3_##n)                                                                            \
    TX_INT_3(TX_U3_##n)                                                                            \
    TX_CONVERT(ilogb, int, float, n) TX_CONVERT(nan, float, uint, n) TX_CONVERT(abs, uint, int, n) \
        TX_CONVERT(abs, uint, uint, n) TX_CONVERT(popcount, int, int, n) TX_CONVERT(               \
            popcount, uint, uint, n) TX_CONVERT(clz, int, int, n) TX_CONVERT(clz, uint, uint, n)   \
            TX_CAST(as, int, float, n) TX_CAST(as, uint, float, n) TX_CAST(as, float, int, n)      \
                TX_CAST(as, float, uint, n) TX_CAST(as, float, float, n) TX_CAST(as, int, uint, n) \
                    TX_CAST(as, int, int, n) TX_CAST(as, uint, int, n) TX_CAST(as, uint, uint, n)  \
                        TX_CAST(convert, int, float, n) TX_CAST(convert, uint, float, n)           \
                            TX_CAST(convert, float, int, n) TX_CAST(convert, float, uint, n)       \
                                TX_CAST(convert, float, float, n) TX_CAST(convert, int, uint, n)   \
                                    TX_CAST(convert, int, int, n) TX_CAST(convert, uint, int, n)   \
                                        TX_CAST(convert, uint, uint, n) TX_PICK(float, int, n)     \
                                            TX_PICK(float, uint, n) TX_PICK(int, int, n)           \
                                                TX_PICK(int, uint, n) TX_PICK(uint, int, n)        \
                                                    TX_PICK(uint, uint, n)                         \
                                                        SHARED uint##n tx_abs_diff_int##n(         \
                                                            int##n a, int##n b)                    \
    {                                                                                              \
        return TX_EACH_2_##n(uint##n, tx_abs_diff_int, a, b);                                      \
    }                                                                                              \
    SHARED uint##n tx_shift_left_uint##n(uint##n a, int##n b)                                      \
    {                                                                                              \
        return TX_EACH_2_##n(uint##n, tx_shift_left_uint, a, b);                                   \
    }                                                                                              \
    SHARED uint##n tx_shift_right_uint##n(uint##n a, int##n b)                                     \
    {                                                                                              \
        return TX_EACH_2_##n(uint##n, tx_shift_right_uint, a, b);                                  \
    }                                                                                              \
    SHARED int##n tx_negate_int##n(int##n a) { return TX_EACH_1_##n(int##n, tx_negate_int, a); }   \
    SHARED float##n tx_fract_float##n(float##n a, float##n* whole)                                 \
    {                                                                                              \
        *whole = TX_EACH_1_##n(float##n, tx_floor_float, a);                                       \
        return TX_EACH_1_##n(float##n, tx_fraction_float, a);                                      \
    }                                                                                              \
    SHARED float##n tx_modf_float##n(float##n a, float##n* whole)                                  \
    {                                                                                              \
        *whole = TX_EACH_1_##n(float##n, tx_trunc_float, a);                                       \
        return TX_EACH_1_##n(float##n, tx_signed_fraction_float, a);                               \
    }                                                                                              \
    SHARED float##n tx_sincos_float##n(float##n a, float##n* cosine)                               \
    {                                                                                              \
        *cosine = TX_EACH_1_##n(float##n, tx_cos_float, a);                                        \
        return TX_EACH_1_##n(float##n, tx_sin_float, a);                                           \
    }                                                                                              \
    SHARED float##n tx_frexp_float##n(float##n a, int##n* exponent)                                \
    {                                                                                              \
        *exponent = TX_EACH_1_##n(int##n, tx_exponent_float, a);                                   \
        return TX_EACH_1_##n(float##n, tx_significand_float, a);                                   \
    }
// clang-format on

// A row knows its name only: a macro for each width.
#define TX_F1_2(name) TX_F1(name, 2)
#define TX_F2_2(name) TX_F2(name, 2)
#define TX_F3_2(name) TX_F3(name, 2)
#define TX_FI_2(name) TX_FI(name, 2)
#define TX_T1_2(name) TX_T1(name, 2)
#define TX_T2_2(name) TX_T2(name, 2)
#define TX_I2_2(name) TX_I2(name, 2)
#define TX_U2_2(name) TX_U2(name, 2)
#define TX_I3_2(name) TX_I3(name, 2)
#define TX_U3_2(name) TX_U3(name, 2)
#define TX_F1_3(name) TX_F1(name, 3)
#define TX_F2_3(name) TX_F2(name, 3)
#define TX_F3_3(name) TX_F3(name, 3)
#define TX_FI_3(name) TX_FI(name, 3)
#define TX_T1_3(name) TX_T1(name, 3)
#define TX_T2_3(name) TX_T2(name, 3)
#define TX_I2_3(name) TX_I2(name, 3)
#define TX_U2_3(name) TX_U2(name, 3)
#define TX_I3_3(name) TX_I3(name, 3)
#define TX_U3_3(name) TX_U3(name, 3)
#define TX_F1_4(name) TX_F1(name, 4)
#define TX_F2_4(name) TX_F2(name, 4)
#define TX_F3_4(name) TX_F3(name, 4)
#define TX_FI_4(name) TX_FI(name, 4)
#define TX_T1_4(name) TX_T1(name, 4)
#define TX_T2_4(name) TX_T2(name, 4)
#define TX_I2_4(name) TX_I2(name, 4)
#define TX_U2_4(name) TX_U2(name, 4)
#define TX_I3_4(name) TX_I3(name, 4)
#define TX_U3_4(name) TX_U3(name, 4)
#define TX_F1_8(name) TX_F1(name, 8)
#define TX_F2_8(name) TX_F2(name, 8)
#define TX_F3_8(name) TX_F3(name, 8)
#define TX_FI_8(name) TX_FI(name, 8)
#define TX_T1_8(name) TX_T1(name, 8)
#define TX_T2_8(name) TX_T2(name, 8)
#define TX_I2_8(name) TX_I2(name, 8)
#define TX_U2_8(name) TX_U2(name, 8)
#define TX_I3_8(name) TX_I3(name, 8)
#define TX_U3_8(name) TX_U3(name, 8)
#define TX_F1_16(name) TX_F1(name, 16)
#define TX_F2_16(name) TX_F2(name, 16)
#define TX_F3_16(name) TX_F3(name, 16)
#define TX_FI_16(name) TX_FI(name, 16)
#define TX_T1_16(name) TX_T1(name, 16)
#define TX_T2_16(name) TX_T2(name, 16)
#define TX_I2_16(name) TX_I2(name, 16)
#define TX_U2_16(name) TX_U2(name, 16)
#define TX_I3_16(name) TX_I3(name, 16)
#define TX_U3_16(name) TX_U3(name, 16)

TX_ROWS_OF_WIDTH(2)
TX_ROWS_OF_WIDTH(3)
TX_ROWS_OF_WIDTH(4)
TX_ROWS_OF_WIDTH(8)
TX_ROWS_OF_WIDTH(16)

// Sums from the first component on.
SHARED float tx_dot_float2(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
SHARED float tx_dot_float3(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SHARED float tx_dot_float4(float4 a, float4 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
SHARED float3 tx_cross_float3(float3 a, float3 b)
{
    return TX_NEW(float3, a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
SHARED float4 tx_cross_float4(float4 a, float4 b)
{
    return TX_NEW(float4, a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x,
                  0.0f);
}
// Lengths of vectors whose squares are normal floats (1e-18 to 1e18); zero has no direction, and
// normalize gives zero.
#define TX_LENGTHS(n)                                                                        \
    SHARED float tx_length_float##n(float##n v) { return math_sqrt(tx_dot_float##n(v, v)); } \
    SHARED float tx_distance_float##n(float##n a, float##n b)                                \
    {                                                                                        \
        return tx_length_float##n(a - b);                                                    \
    }                                                                                        \
    SHARED float##n tx_normalize_float##n(float##n v)                                        \
    {                                                                                        \
        const float length = tx_length_float##n(v);                                          \
        return v * (1.0f / (length > 0.0f ? length : 1.0f));                                 \
    }
TX_LENGTHS(2)
TX_LENGTHS(3)
TX_LENGTHS(4)

// Whether the highest bit is set in any, in all components.
SHARED int tx_any_int2(int2 v) { return (v.x | v.y) < 0; }
SHARED int tx_any_int3(int3 v) { return (v.x | v.y | v.z) < 0; }
SHARED int tx_any_int4(int4 v) { return (v.x | v.y | v.z | v.w) < 0; }
SHARED int tx_all_int2(int2 v) { return (v.x & v.y) < 0; }
SHARED int tx_all_int3(int3 v) { return (v.x & v.y & v.z) < 0; }
SHARED int tx_all_int4(int4 v) { return (v.x & v.y & v.z & v.w) < 0; }
