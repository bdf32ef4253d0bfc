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

// Of a record on the way of a shadow ray.
inline constexpr StandIn shadow_records[] = {
    {row_hit_triangle, true, row_record_triangle},
    {row_hit_instance, true, row_record_instance},
    {row_ray_origin, false, row_shadow_origin},
    {row_ray_direction, false, row_shadow_direction},
};

// Runs the textures for the records of all paths; run(stage, lookup) launches a stage.
template<typename Run>
void look_up_textures(unsigned effects, int lookup, const Run& run)
{
    if ((effects & EFFECT_TEXTURE_OCCLUSION) != 0) run(STAGE_trace_texture_rays, lookup);
    run(STAGE_evaluate_textures, lookup);
}

}  // namespace diptych
