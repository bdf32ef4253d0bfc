// Entry points of the shared stages, expanded from the rows. Compiled once per kernel set:
// KERNEL_SET is its namespace, VECTORISED says whether loops run over paths in vector lanes, and
// the include path picks the dialect.
#include "kernels_cpu/kernels.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

// Each set has the shared sources in a namespace of its own, so that their types never meet.
namespace diptych::KERNEL_SET {
#include "platform.h"

#include "common/stages/bodies.h"
#if !VECTORISED
#include "common/stages/intersect.h"
#include "common/stages/occlusion.h"
#include "common/stages/trace_texture_rays.h"
#endif

namespace {

#include "kernels_cpu/typed_views.hpp"

// Effects that vectorised loops are compiled for, from few to many; the first that covers a scene
// serves it. A condition that is the same for all paths would keep a loop from being vectorised, so
// it must be a constant.
constexpr unsigned variants[] = {
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS,
    EFFECT_EMISSION | EFFECT_SPECULAR,
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_SPECULAR,
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_SPECULAR | EFFECT_ENVIRONMENT |
        EFFECT_BASE_TEXTURE,
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_SPECULAR | EFFECT_ENVIRONMENT |
        EFFECT_BASE_TEXTURE | EFFECT_SURFACE_TEXTURES | EFFECT_NORMAL_MAP,
    ~unsigned(USER_TEXTURE_EFFECTS),
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_PROCEDURAL,
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_SPECULAR | EFFECT_ENVIRONMENT |
        EFFECT_PROCEDURAL,
    // without the last two g++ leaves evaluate_surface scalar
    EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS | EFFECT_SPECULAR | EFFECT_ENVIRONMENT |
        EFFECT_BASE_TEXTURE | EFFECT_SURFACE_TEXTURES | EFFECT_NORMAL_MAP | EFFECT_PROCEDURAL |
        EFFECT_INSTANCES | EFFECT_FLOAT_TEXTURES,
    ~unsigned(EFFECT_PROCEDURAL_EMISSION | EFFECT_PROCEDURAL_ALPHA),
    ~0u,
};
[[maybe_unused]] constexpr int variant_count = int(sizeof(variants) / sizeof(variants[0]));

#if VECTORISED
#define OVER_PATHS _Pragma("omp simd")
#define EFFECTS_OF(variant, view) variants[variant]
constexpr int variant_for(unsigned effects)
{
    int k = 0;
    while ((effects & ~variants[k]) != 0) ++k;
    return k;
}
// Without effects that no loop asks of the scene, only walks and users' code, and without those
// that one other stage alone asks.
constexpr unsigned effects_for(Stage stage, unsigned effects)
{
    effects &= ~unsigned(EFFECT_ALPHA | EFFECT_TEXTURE_OCCLUSION | ASIDE_EFFECTS);
    if (stage != STAGE_generate_paths) effects &= ~unsigned(EFFECT_ORTHOGRAPHIC);
    if (stage != STAGE_decide_alpha) effects &= ~unsigned(EFFECT_PROCEDURAL_ALPHA);
    if (stage != STAGE_evaluate_surface) effects &= ~unsigned(EFFECT_PROCEDURAL);
    if (stage != STAGE_sample_light)
        effects &= ~unsigned(EFFECT_PUNCTUAL_LIGHTS | EFFECT_PROCEDURAL_EMISSION);
    return effects;
}
constexpr int variant_of(Stage stage, unsigned effects)
{
    return variant_for(effects_for(stage, effects));
}
unsigned covered_effects(unsigned effects)
{
    unsigned covered = 0;
    for (int stage = 0; stage < STAGE_COUNT; ++stage)
        covered |= variants[variant_of(Stage(stage), effects)];
    return covered;
}
#else
#define OVER_PATHS
#define EFFECTS_OF(variant, view) (view).effects
unsigned covered_effects(unsigned effects) { return effects; }
#endif

#define ENTRY_shared(name)                                                                     \
    template<int variant>                                                                      \
    [[gnu::noinline]] void name##_loop(const SceneView& scene_view, const PathView& path_view, \
                                       int first, int count)                                   \
    {                                                                                          \
        Scene scene = scene_from(scene_view);                                                  \
        scene.effects = EFFECTS_OF(variant, scene_view);                                       \
        const Paths paths = paths_from(path_view);                                             \
        const auto settings = *scene.settings; /* local: no store to a plane can change it */  \
        scene.settings = &settings;                                                            \
        OVER_PATHS                                                                             \
        for (int i = first; i < first + count; ++i) name(&scene, &paths, i);                   \
    }
#define ENTRY_native(name)
#define ENTRY(name, body, when, needs) ENTRY_##body(name)
STAGES(ENTRY)

#define MISSED_each_surface(name)                                                              \
    void name##_missed_loop(const SceneView& scene_view, const PathView& path_view, int first, \
                            int count)                                                         \
    {                                                                                          \
        const Scene scene = scene_from(scene_view);                                            \
        const Paths paths = paths_from(path_view);                                             \
        for (int i = first; i < first + count; ++i) name##_missed(&scene, &paths, i);          \
    }
#define MISSED_once(name)
#define MISSED_each_bounce(name)
#define MISSED_first_bounce(name)
#define MISSED_each_layer(name)
#define MISSED_at_end(name)
#define MISSED(name, body, when, needs) MISSED_##when(name)
STAGES(MISSED)

#if !VECTORISED
#define ENTRY_walk(name)                                                                           \
    void name##_loop(const SceneView& scene_view, const PathView& path_view, int first, int count) \
    {                                                                                              \
        const Scene scene = scene_from(scene_view);                                                \
        const Paths paths = paths_from(path_view);                                                 \
        for (int i = first; i < first + count; ++i) name(&scene, &paths, i);                       \
    }
ENTRY_walk(intersect) ENTRY_walk(occlusion) ENTRY_walk(trace_texture_rays)
#endif

    StageLoop loop_of(Stage stage, unsigned effects)
{
#if VECTORISED
    // Variants that differ in what the stage does not ask are one loop.
#define LOOP_OF(name, k) name##_loop<variant_of(STAGE_##name, variants[k])>
#define LOOPS_OF(name)                                                          \
    static constexpr StageLoop name##_loops[] = {                               \
        LOOP_OF(name, 0), LOOP_OF(name, 1), LOOP_OF(name, 2), LOOP_OF(name, 3), \
        LOOP_OF(name, 4), LOOP_OF(name, 5), LOOP_OF(name, 6), LOOP_OF(name, 7), \
        LOOP_OF(name, 8), LOOP_OF(name, 9), LOOP_OF(name, 10)};                 \
    static_assert(std::size(name##_loops) == variant_count);                    \
    if (stage == STAGE_##name) return name##_loops[variant_of(STAGE_##name, effects)];
#else
#define LOOPS_OF(name) \
    if (stage == STAGE_##name) return name##_loop<variant_count - 1>;
#endif
#define LOOP_shared(name) LOOPS_OF(name)
#define LOOP_native(name)
#define LOOP(name, body, when, needs) LOOP_##body(name)
    STAGES(LOOP)
#if !VECTORISED
    if (stage == STAGE_intersect) return intersect_loop;
    if (stage == STAGE_occlusion) return occlusion_loop;
    if (stage == STAGE_trace_texture_rays) return trace_texture_rays_loop;
#endif
    (void)effects;
    return nullptr;
}

StageLoop missed_of(Stage stage)
{
#undef MISSED_each_surface
#define MISSED_each_surface(name) \
    if (stage == STAGE_##name) return name##_missed_loop;
    STAGES(MISSED)
    return nullptr;
}

}  // namespace

extern const KernelSet set;
const KernelSet set{KERNEL_NAME, int(sizeof(PLANE(float))), loop_of, missed_of, covered_effects};

}  // namespace diptych::KERNEL_SET
