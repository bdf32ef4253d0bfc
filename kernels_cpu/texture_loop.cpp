// One function of the texture stage in vector lanes (see texture_lanes.hpp). Compiled as
// texture_stage.cpp is, for TEXTURE_ID, the function; IS_UNIFORM: lanes have the same region.
#include "kernels_cpu/texture_tracer.hpp"

#include "platform.h"

#include "common/textures/procedural.h"

// What the thread evaluates, for textures that have a ray traced.
static thread_local const diptych::SceneView* evaluated_scene;
static thread_local const diptych::PathView* evaluated_paths;

static float texture_openness_at(const Scene*, const Paths*, int path, int request)
{
    const auto& kernels =
        *static_cast<const diptych::TracingTextureKernels*>(evaluated_scene->textures);
    return kernels.openness(kernels.tracer, *evaluated_scene, *evaluated_paths, path, request);
}

#include "kernels_cpu/texture_functions.hpp"
#include "kernels_cpu/texture_lanes.hpp"

namespace {

using diptych::PathView;
using diptych::SceneView;

#include "kernels_cpu/typed_views.hpp"

#define LOAD_float(field) lanes.field[0][k]
#define LOAD_int(field) lanes.field[0][k]
#define LOAD_float2(field) make_float2(lanes.field[0][k], lanes.field[1][k])
#define LOAD_float3(field) make_float3(lanes.field[0][k], lanes.field[1][k], lanes.field[2][k])
#define LOAD_float4(field) \
    make_float4(lanes.field[0][k], lanes.field[1][k], lanes.field[2][k], lanes.field[3][k])
#define NONE_float 0.0f
#define NONE_int 0
#define NONE_float2 make_float2(0.0f, 0.0f)
#define NONE_float3 make_float3(0.0f, 0.0f, 0.0f)
#define NONE_float4 make_float4(1.0f, 1.0f, 1.0f, 1.0f)
#define LOAD_FIELD(name, bit, type, field)                 \
    if constexpr ((TEXTURE_ASKED & ATTRIBUTE_##name) != 0) \
        tx.field = LOAD_##type(field);                     \
    else                                                   \
        tx.field = NONE_##type;

SHARED TextureContext context_of(const Scene* scene, const Paths* paths, const Lanes& lanes, int k)
{
    TextureContext tx;
    tx.scene = scene;
    tx.paths = paths;
    tx.path = lanes.path[k];
    TEXTURE_ATTRIBUTES(LOAD_FIELD)
    tx.stack = &lanes.stack[0][0];
    tx.stack_stride = lane_count;
    tx.lane = k;
    return tx;
}

#define ENTRY_OF(id) user_language::id::id##_entry
#define CALL_ENTRY(id, tx, region) ENTRY_OF(id)(tx, region)

// A local variable of the loop itself would become an array: see texture_lanes.cpp.
SHARED void run_lane(const Scene* scene, const Paths* paths, Lanes& lanes, int k, TextureStep step,
                     int offset)
{
    TextureContext tx = context_of(scene, paths, lanes, k);
    texture_begin(&tx, step);
    const int own = int(material_word(scene, lanes.first_step[k] + offset));
    const auto given = CALL_ENTRY(TEXTURE_ID, &tx, IS_UNIFORM ? step.region : own);
    lanes.verdict[k] = texture_faults_on_the_way(&tx);
    lanes.value[0][k] = given.x;
    lanes.value[1][k] = given.y;
    lanes.value[2][k] = given.z;
    lanes.value[3][k] = given.w;
}

[[gnu::noinline]] void run_lanes(const Scene& scene_in, const Paths& paths_in, Lanes& lanes,
                                 int count, TextureStep step, int step_number)
{
    LOCAL_SCENE
    const int offset = step_number * TEXTURE_STEP_WORDS + 1;
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); ++k) run_lane(&scene, &paths, lanes, k, step, offset);
}

}  // namespace

#if IS_UNIFORM
#define LOOP_OF(id) TEXTURE_LOOP(SAME_REGION_LOOP(id))
#else
#define LOOP_OF(id) TEXTURE_LOOP(ANY_REGION_LOOP(id))
#endif
LOOP_OF(TEXTURE_ID)
{
    evaluated_scene = &scene_view;
    evaluated_paths = &path_view;
    run_lanes(scene_from(scene_view), paths_from(path_view), lanes, count, step, step_number);
}
