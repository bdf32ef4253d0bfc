// Whether something stands between a surface and the point chosen on a light, by the walk of
// common/bvh.h; where the light would bring nothing, nobody asks.
#pragma once

#include "common/alpha.h"
#include "common/bvh.h"

SHARED void occlusion(const Scene* scene, const Paths* paths, int i)
{
    if (uses(scene, EFFECT_PROCEDURAL_ALPHA)) {
        if (!bvh_is_waiting(paths, i)) return;
        if (paths->lookup == LOOKUP_SURFACE) set_record_triangle(paths, 0, i, -1);
    }
    if (vec_max_component(get_light_contribution(paths, i)) > 0.0f) {
        BvhAlpha alpha = bvh_alpha(0);
        if (uses(scene, EFFECT_ALPHA))
            alpha.seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i),
                                    get_sample(paths, i), get_depth(paths, i), 1);
        if (uses(scene, EFFECT_PROCEDURAL_ALPHA)) alpha = bvh_alpha_of(paths, i, alpha.seed);
        const Hit hit = bvh_walk(scene, get_shadow_origin(paths, i), get_shadow_direction(paths, i),
                                 get_shadow_distance(paths, i), alpha, 1);
        set_is_occluded(paths, i, hit.triangle >= 0);
        if (uses(scene, EFFECT_PROCEDURAL_ALPHA)) bvh_record(scene, paths, i, hit);
    }
}
