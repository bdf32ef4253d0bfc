// Somebody's own C++ program with a texture in it: prints the bits of its results.
#include <cstdio>

#include "common/user_language/as_cpp/user_language.h"

namespace user_language {
// clang-format off
#include "tests/texture_tool/foreign_hooks.h"
#include "common/user_language/as_vectors/arguments.h"
#include TEXTURE_TEXT
// clang-format on
}  // namespace user_language

int main()
{
    for (int hit = 0; hit < 64; ++hit) {
        user_language::TextureContext tx = user_language::foreign_context(hit);
        const user_language::float4 v = user_language::texture::texture_entry(&tx, 0);
        std::printf("%.9g %.9g %.9g %.9g %d %d\n", v.x, v.y, v.z, v.w, tx.clamped, tx.fault_line);
    }
}
