// How lookups of textures away from the point that a path is at are run, on every backend: the
// same texture stage, over a view whose planes are those of the records.
#pragma once

#include "common/as_cpp/path_rows.hpp"
#include "common/as_cpp/texture_rows.hpp"
#include "common/effects.h"
#include "common/stages/stages.h"

namespace diptych {

// In a view for records, the plane that stands for one of the path's own.
struct StandIn {
    PathRowName row;
    bool is_texture_row;
    int by;  // a PathRowName, or a TextureRowName
};

// Of a record on the way of the path's ray.
inline constexpr StandIn path_records[] = {
    {row_hit_triangle, true, row_record_triangle},
    {row_hit_instance, true, row_record_instance},
    {row_ray_origin, false, row_ray_origin},
    {row_ray_direction, false, row_ray_direction},
};

// Of a record on the way of a shadow ray.
inline constexpr StandIn shadow_records[] = {
    {row_hit_triangle, true, row_record_triangle},
    {row_hit_instance, true, row_record_instance},
    {row_ray_origin, false, row_shadow_origin},
    {row_ray_direction, false, row_shadow_direction},
};

// Runs the textures that say how far the occlusion is to reach that others ask for.
template<typename Run>
void look_up_distances(unsigned effects, int lookup, const Run& run)
{
    if ((effects & EFFECT_OCCLUSION_DISTANCE) != 0)
        run(STAGE_evaluate_textures, lookup | LOOKUP_DISTANCE);
}

// Runs the textures for the records of all paths; run(stage, lookup) launches a stage.
template<typename Run>
void look_up_textures(unsigned effects, int lookup, const Run& run)
{
    if ((effects & EFFECT_TEXTURE_OCCLUSION) != 0) {
        look_up_distances(effects, lookup, run);
        run(STAGE_trace_texture_rays, lookup);
    }
    run(STAGE_evaluate_textures, lookup);
}

// Whether a stage's launch for `lookup` is over the records, not over the rays that left them.
inline bool is_over_records(Stage stage, int lookup)
{
    const int place = LOOKUP_PLACE(lookup);
    return place != LOOKUP_SURFACE && place != LOOKUP_AOV && stage != STAGE_intersect &&
           stage != STAGE_occlusion;
}

// Surfaces one behind another that may let a ray through by a texture's alpha; the next one stops
// it, whatever its texture says, and is counted.
inline constexpr int most_alpha_layers = 64;

// After intersect or occlusion: asks the textures about the surfaces that stopped a ray, and lets
// those rays go on that they let through. waiting() says how many rays have a record. Returns how
// many were left to be asked about.
template<typename Run, typename Waiting>
int settle_alpha(Stage rays, unsigned effects, const Run& run, const Waiting& waiting)
{
    if ((effects & EFFECT_PROCEDURAL_ALPHA) == 0) return 0;
    const int lookup = rays == STAGE_intersect ? LOOKUP_ALPHA : LOOKUP_SHADOW;
    int count = waiting();
    for (int layer = 0; layer < most_alpha_layers && count > 0; ++layer) {
        look_up_textures(effects, lookup, run);
        run(STAGE_decide_alpha, lookup);
        run(rays, lookup);
        count = waiting();
    }
    return count;
}

// Runs a stage of the rows with the lookups that belong to it; as settle_alpha.
template<typename Run, typename Waiting>
int run_with_lookups(Stage stage, unsigned effects, const Run& run, const Waiting& waiting)
{
    if (stage == STAGE_scale_light) look_up_textures(effects, LOOKUP_EMISSION, run);
    if (stage == STAGE_trace_texture_rays) look_up_distances(effects, LOOKUP_SURFACE, run);
    if (stage == STAGE_record_features && (effects & EFFECT_TEXTURE_AOV) != 0)
        look_up_textures(effects, LOOKUP_AOV, run);
    run(stage, LOOKUP_SURFACE);
    const bool is_ray = stage == STAGE_intersect || stage == STAGE_occlusion;
    return is_ray ? settle_alpha(stage, effects, run, waiting) : 0;
}

}  // namespace diptych
