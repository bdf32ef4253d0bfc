// The user language in C++20: OpenCL's vectors, and the functions that textures may call. All in
// namespace user_language, where the generated text of a texture is read too; its float3 is not the
// renderer's.
#pragma once

#include "platform.h"

#include "common/user_language/common_functions.h"
#include "common/user_language/integer_functions.h"

#include "common/user_language/as_cpp/vectors.h"

namespace user_language {

#define TX_NEW(type, ...) (type(__VA_ARGS__))
#define TX_TABLE(type) const type*

SHARED float tx_fma_float(float a, float b, float c) { return (float)__builtin_fma(a, b, c); }

#include "common/user_language/as_vectors/engine.h"

}  // namespace user_language
