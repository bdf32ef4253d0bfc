// Whether something stands between a surface and the point chosen on a light, by the walk of
// common/bvh.h; where the light would bring nothing, nobody asks.
#pragma once

#include "common/alpha.h"
#include "common/bvh.h"

SHARED void occlusion(const Scene* scene, const Paths* paths, int i)
{
    if (vec_max_component(get_light_contribution(paths, i)) > 0.0f) {
        uint seed = 0;
        if (uses(scene, EFFECT_ALPHA))
            seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i), get_sample(paths, i),
                              get_depth(paths, i), 1);
        const int is_occluded =
            bvh_occluded(scene, get_shadow_origin(paths, i), get_shadow_direction(paths, i),
                         get_shadow_distance(paths, i), seed);
        set_is_occluded(paths, i, is_occluded);
    }
}
