// The user language in OpenCL C 1.2, which brings vectors and their operators itself.
#pragma once

#define TX_NEW(type, ...) ((type)(__VA_ARGS__))
#define TX_TABLE(type) __constant const type*

#include "common/user_language/common_functions.h"
#include "common/user_language/integer_functions.h"

SHARED float tx_fma_float(float a, float b, float c) { return fma(a, b, c); }

#include "common/user_language/as_vectors/engine.h"
