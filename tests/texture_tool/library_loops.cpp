#include "tests/texture_tool/library_loops.hpp"

#include "platform.h"

#include "common/user_language/as_cpp/user_language.h"

namespace user_language {

// clang-format off
#include "tests/texture_tool/library_hooks.h"
#include "common/user_language/as_vectors/arguments.h"
#include "library_textures.hpp"
// clang-format on

namespace {

// The body is a function, because g++ takes structs of a loop's own body for arrays of lanes.
#define LOOP(name)                                                                               \
    SHARED void name##_at(const float* hits, const std::uint32_t* words, int count, int k,       \
                          float* results, int* clamped)                                          \
    {                                                                                            \
        TextureContext tx = hit_context(hits, count, k, words);                                  \
        const float4 value = name::name##_entry(&tx, 0);                                         \
        float* green = results + count;                                                          \
        float* blue = green + count;                                                             \
        float* alpha = blue + count;                                                             \
        results[k] = value.x;                                                                    \
        green[k] = value.y;                                                                      \
        blue[k] = value.z;                                                                       \
        alpha[k] = value.w;                                                                      \
        clamped[k] = tx.clamped;                                                                 \
    }                                                                                            \
    [[gnu::noinline]] void name##_loop(const float* hits, const std::uint32_t* words, int count, \
                                       float* results, int* clamped)                             \
    {                                                                                            \
        _Pragma("omp simd") for (int k = 0; k < count; ++k)                                      \
            name##_at(hits, words, count, k, results, clamped);                                  \
    }
LIBRARY_TEXTURES(LOOP)

}  // namespace
}  // namespace user_language

const LibraryLoops& LOOPS()
{
#define ENTRY(name) {#name, user_language::name##_loop},
    static const LibraryLoops loops = {LIBRARY_TEXTURES(ENTRY)};
    return loops;
}
