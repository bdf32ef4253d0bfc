// The stage that holds user code, a path at a time. Not part of the build: backends/textures has
// the system's compiler make it into a shared object, for a scene's textures and a kernel set. In
// vector lanes it is texture_lanes.cpp instead.
#include "kernels_cpu/kernels.hpp"
#include "kernels_cpu/texture_tracer.hpp"

#include "platform.h"

#include "common/stages/trace_texture_rays.h"
#include "kernels_cpu/texture_functions.hpp"

namespace {

using diptych::PathView;
using diptych::SceneView;

#include "kernels_cpu/typed_views.hpp"

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
        const int verdict = texture_verdict(texture_faults_on_the_way(tx), v);
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

}  // namespace

extern "C" __attribute__((visibility("default"))) void
diptych_evaluate_textures(const SceneView& scene_view, const PathView& path_view, int first,
                          int count)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    for (int i = first; i < first + count; ++i) run_textures(&scene, &paths, i, Watcher{});
}

extern "C" __attribute__((visibility("default"))) void
diptych_watch_textures(const SceneView& scene_view, const PathView& path_view, int path,
                       diptych::TextureWatch watch, void* watcher)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    run_textures(&scene, &paths, path, {watch, watcher});
}
