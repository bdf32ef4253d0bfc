// The library's functions, read as they are.
#pragma once

#include "tests/texture_tool/library_language.hpp"

namespace user_language {

#include "texture_tool/library/functions/hash.c"

#include "texture_tool/library/functions/perlin.c"

#include "texture_tool/library/functions/simplex.c"

#include "texture_tool/library/functions/fractal.c"

#include "texture_tool/library/functions/worley.c"

#include "texture_tool/library/functions/gabor.c"

#include "texture_tool/library/functions/ramp.c"

// Place k of a fixed sequence without visible order, in a cube of half width `reach`.
SHARED float3 scattered(int k, float reach)
{
    const uint h = hash_scramble(uint(k) * 3u + 1u);
    const uint i = hash_scramble(uint(k) * 3u + 2u);
    const uint j = hash_scramble(uint(k) * 3u + 3u);
    return (float3(hash_fraction(h), hash_fraction(i), hash_fraction(j)) - float3(0.5f)) *
           (2.0f * reach);
}

}  // namespace user_language
