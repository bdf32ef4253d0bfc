// The stage that holds user code. Not part of the build: backends/textures has the system's
// compiler make it into a shared object, for a scene's textures and a kernel set.
// TEXTURE_FUNCTIONS_FILE, made beside it, includes what the texture tool wrote for each texture and
// says
//   TEXTURE_FUNCTIONS(X)  a row X(number, id) for each function
//   TEXTURE_ASKED         mask of ATTRIBUTE_*: what some of them ask
//   TEXTURE_SLOTS         of the stack, at least one
//   TEXTURE_EFFECTS       of the scene: what is not there is not asked for every path
// VECTORISED: paths run side by side in vector lanes, those of one material's program at a time.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "kernels_cpu/kernels.hpp"

#include "platform.h"

#include "common/textures/procedural.h"
#include "common/user_language/as_cpp/user_language.h"

namespace user_language {
#include "common/textures/as_vectors/hooks.h"
#include "common/user_language/as_vectors/arguments.h"

#include TEXTURE_FUNCTIONS_FILE
}  // namespace user_language

namespace {

using diptych::PathView;
using diptych::SceneView;

#include "kernels_cpu/typed_views.hpp"

// Where the material of what path i has hit keeps its program; 0: nothing to run.
SHARED int program_of(const Scene* scene, const Paths* paths, int i)
{
    const int hit = get_hit_triangle(paths, i);
    const int triangle = hit < 0 ? 0 : hit;
    const int program = scene->materials[scene->triangles[triangle].material].texture_program;
    const int is_dead = (hit < 0) | (get_depth(paths, i) < 0);
    return is_dead ? 0 : program;
}

#define VALUE_OF(value) \
    TextureValue { (value).x, (value).y, (value).z, (value).w }

#if VECTORISED

#include "kernels_cpu/texture_lanes.hpp"

#else

TextureValue call(TextureContext* tx, int function, int region)
{
    switch (function) {
#define CALL_FUNCTION(number, id)                                     \
    case number: {                                                    \
        const auto value = user_language::id::id##_entry(tx, region); \
        return VALUE_OF(value);                                       \
    }
        TEXTURE_FUNCTIONS(CALL_FUNCTION)
    }
    return TextureValue{0, 0, 0, 0};
}

// All steps of path i; see(number, stack, value, tx) looks at each.
template<typename See>
void run_path(const Scene& scene, const Paths& paths, int i, const See& see)
{
    const int word = program_of(&scene, &paths, i);
    if (word == 0) return;
    const TextureProgram program = texture_program(&scene, word);
    TextureContext tx = texture_context(&scene, &paths, i, TEXTURE_ASKED);
    float stack[4 * TEXTURE_SLOTS] = {};
    tx.stack = stack;
    for (int k = 0; k < program.steps; ++k) {
        const TextureStep step = texture_step(&scene, program.first, k);
        texture_begin(&tx, step);
        const TextureValue given = call(&tx, step.function, step.region);
        see(k, stack, given, tx);
        const TextureValue value = texture_finite(given);
        texture_push(stack, step.slot, value);
        texture_store(&paths, i, step.outputs, value);
    }
}

void run(const Scene& scene, const Paths& paths, int first, int count)
{
    for (int i = first; i < first + count; ++i)
        run_path(scene, paths, i,
                 [&](int, const float*, const TextureValue& given, const TextureContext& tx) {
                     const int verdict = texture_verdict(&tx, given);
                     if (verdict != 0) texture_count(&paths, i, verdict);
                 });
}

#endif

}  // namespace

extern "C" __attribute__((visibility("default"))) void
diptych_evaluate_textures(const SceneView& scene_view, const PathView& path_view, int first,
                          int count)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    run(scene, paths, first, count);
}

#if !VECTORISED
extern "C" __attribute__((visibility("default"))) void
diptych_watch_textures(const SceneView& scene_view, const PathView& path_view, int path,
                       diptych::TextureWatch watch, void* watcher)
{
    run_path(scene_from(scene_view), paths_from(path_view), path,
             [&](int k, const float* stack, const TextureValue& v, const TextureContext& tx) {
                 double widened[4 * TEXTURE_SLOTS];
                 for (int c = 0; c < 4 * TEXTURE_SLOTS; ++c) widened[c] = double(stack[c]);
                 watch(watcher, {k,
                                 widened,
                                 {double(v.r), double(v.g), double(v.b), double(v.a)},
                                 tx.fault_line,
                                 tx.clamped});
             });
}
#endif
