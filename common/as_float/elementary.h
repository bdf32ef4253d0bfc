// The elementary functions of the float dialects. Contraction-free polynomials and selects, because
// the runtimes' own sin, exp, pow ... differ in their last bits, which a procedural texture turns
// into another picture: these give the same bits in C++, scalar or vectorised, and in OpenCL.
//
// They need IEEE division and square root, gradual underflow and no reassociation; where a device
// or a fast-math option takes one of them away, last digits and denormals are lost, no more.
// Special values as in C99, annex F; a NaN result is always the quiet NaN 0x7fc00000. Errors are in
// units of the last place of the exact result, and tests/common/elementary_test.cpp holds them to
// it. The double dialect has the C library's functions under the same names instead.
#pragma once

#include "common/as_float/bits.h"
#include "common/as_float/circular.h"
#include "common/as_float/exponential.h"
#include "common/as_float/inverse_circular.h"
#include "common/as_float/power.h"
