// User code in C++: included where texture_openness_at is in scope. TEXTURE_FUNCTIONS_FILE, made
// beside it, includes what the texture tool wrote for each texture and says
//   TEXTURE_FUNCTIONS(X)  a row X(number, id) for each function
//   TEXTURE_ASKED         mask of ATTRIBUTE_*: what some of them ask
//   TEXTURE_SLOTS         of the stack, at least one
//   TEXTURE_EFFECTS       of the scene: what is not there is not asked for every path
#pragma once

#include "common/textures/procedural.h"
#include "common/user_language/as_cpp/user_language.h"

namespace user_language {
#include "common/textures/as_vectors/hooks.h"
#include "common/user_language/as_vectors/arguments.h"

// In place of tx_occlusion where the study has textures trace their rays themselves.
SHARED float tx_traced_occlusion(const TextureContext* tx, int request)
{
    return texture_openness_at(tx->scene, tx->paths, tx->path, tx->first_occlusion + request);
}

#include TEXTURE_FUNCTIONS_FILE
}  // namespace user_language

#define VALUE_OF(value) \
    TextureValue { (value).x, (value).y, (value).z, (value).w }
