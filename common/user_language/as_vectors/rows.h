// The functions that act on each component alone. X(name), by the types of result and operands.
#pragma once

// clang-format off
#define TX_FLOAT_1(X) \
    X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinpi) X(cospi) X(tanpi) X(asinpi) X(acospi) \
    X(atanpi) X(exp) X(exp2) X(exp10) X(expm1) X(log) X(log2) X(log10) X(log1p) X(cbrt) X(sqrt) \
    X(rsqrt) X(recip) X(sinh) X(cosh) X(tanh) X(asinh) X(acosh) X(atanh) X(fabs) X(floor) \
    X(ceil) X(trunc) X(round) X(rint) X(erf) X(erfc) X(lgamma) X(tgamma) X(logb) X(sign) \
    X(degrees) X(radians)
#define TX_FLOAT_2(X) \
    X(atan2) X(atan2pi) X(pow) X(powr) X(divide) X(copysign) X(fmax) X(fmin) X(max) X(min) \
    X(maxmag) X(minmag) X(fdim) X(fmod) X(remainder) X(hypot) X(nextafter) X(step)
#define TX_FLOAT_3(X) \
    X(mad) X(fma) X(clamp) X(mix) X(smoothstep) X(bitselect)
#define TX_FLOAT_INT(X) \
    X(pown) X(rootn) X(ldexp)
#define TX_TEST_1(X) \
    X(isfinite) X(isinf) X(isnan) X(isnormal) X(signbit)
#define TX_TEST_2(X) \
    X(isequal) X(isnotequal) X(isgreater) X(isgreaterequal) X(isless) X(islessequal) \
    X(islessgreater) X(isordered) X(isunordered)
#define TX_INT_2(X) \
    X(add) X(subtract) X(multiply) X(divide) X(modulo) X(add_sat) X(sub_sat) X(hadd) X(rhadd) \
    X(max) X(min) X(mul_hi) X(rotate) X(mul24) X(shift_left) X(shift_right)
#define TX_UINT_2(X) \
    X(divide) X(modulo) X(add_sat) X(sub_sat) X(hadd) X(rhadd) X(max) X(min) X(mul_hi) X(rotate) \
    X(mul24) X(abs_diff)
#define TX_INT_3(X) \
    X(clamp) X(mad_hi) X(mad_sat) X(mad24) X(bitselect)
// clang-format on
