// What each ray meets first, by the walk of common/bvh.h: for the backends that have no library for
// it.
#pragma once

#include "common/alpha.h"
#include "common/bvh.h"

SHARED void intersect(const Scene* scene, const Paths* paths, int i)
{
    if (uses(scene, EFFECT_PROCEDURAL_ALPHA) && !bvh_is_waiting(paths, i)) return;
    const int depth = get_depth(paths, i);
    BvhAlpha alpha = bvh_alpha(0);
    if (uses(scene, EFFECT_ALPHA))
        alpha.seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i), get_sample(paths, i),
                                depth, 0);
    if (uses(scene, EFFECT_PROCEDURAL_ALPHA)) alpha = bvh_alpha_of(paths, i, alpha.seed);
    const Hit hit = bvh_walk(scene, get_ray_origin(paths, i), get_ray_direction(paths, i),
                             depth >= 0 ? FLOAT_MAX : 0.0f, alpha, 0);
    set_hit_triangle(paths, i, hit.triangle);
    set_hit_instance(paths, i, hit.instance);
    if (uses(scene, EFFECT_PROCEDURAL_ALPHA)) bvh_record(scene, paths, i, hit);
}
