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
#include "kernels_cpu/texture_tracer.hpp"

#include "platform.h"

#if !VECTORISED
#include "common/stages/trace_texture_rays.h"
#endif
#include "common/textures/procedural.h"
#include "common/user_language/as_cpp/user_language.h"

#if VECTORISED
// What the thread evaluates, for textures that have a ray traced.
static thread_local const diptych::SceneView* evaluated_scene;
static thread_local const diptych::PathView* evaluated_paths;

static float texture_openness_at(const Scene*, const Paths*, int path, int request)
{
    const auto& kernels =
        *static_cast<const diptych::TracingTextureKernels*>(evaluated_scene->textures);
    return kernels.openness(kernels.tracer, *evaluated_scene, *evaluated_paths, path, request);
}
#endif

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

namespace {

using diptych::PathView;
using diptych::SceneView;

#include "kernels_cpu/typed_views.hpp"

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

// Who looks at the steps of a path; nobody, as a rule: then what was wrong is counted.
struct Watcher {
    diptych::TextureWatch watch = nullptr;
    void* watcher = nullptr;
};

void texture_see(const Watcher& watcher, int number, const float* stack, const TextureValue& v,
                 const TextureContext* tx)
{
    if (!watcher.watch) {
        const int verdict = texture_verdict(tx, v);
        if (verdict != 0) texture_count(tx->paths, tx->path, verdict);
        return;
    }
    double widened[4 * TEXTURE_SLOTS];
    for (int c = 0; c < 4 * TEXTURE_SLOTS; ++c) widened[c] = double(stack[c]);
    watcher.watch(watcher.watcher, {number,
                                    widened,
                                    {double(v.r), double(v.g), double(v.b), double(v.a)},
                                    tx->fault_line,
                                    tx->clamped});
}

#include "common/textures/as_vectors/interpreter.h"

void run(const Scene& scene, const Paths& paths, int first, int count)
{
    for (int i = first; i < first + count; ++i) run_textures(&scene, &paths, i, Watcher{});
}

#endif

}  // namespace

extern "C" __attribute__((visibility("default"))) void
diptych_evaluate_textures(const SceneView& scene_view, const PathView& path_view, int first,
                          int count)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
#if VECTORISED
    evaluated_scene = &scene_view;
    evaluated_paths = &path_view;
#endif
    run(scene, paths, first, count);
}

#if !VECTORISED
extern "C" __attribute__((visibility("default"))) void
diptych_watch_textures(const SceneView& scene_view, const PathView& path_view, int path,
                       diptych::TextureWatch watch, void* watcher)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    run_textures(&scene, &paths, path, {watch, watcher});
}
#endif
