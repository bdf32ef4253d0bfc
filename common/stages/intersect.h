// What each ray meets first, by the walk of common/bvh.h: for the backends that have no library for
// it.
#pragma once

#include "common/alpha.h"
#include "common/bvh.h"

SHARED void intersect(const Scene* scene, const Paths* paths, int i)
{
    const int depth = get_depth(paths, i);
    uint seed = 0;
    if (uses(scene, EFFECT_ALPHA))
        seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i), get_sample(paths, i), depth,
                          0);
    const Hit hit = bvh_closest(scene, get_ray_origin(paths, i), get_ray_direction(paths, i),
                                depth >= 0 ? FLOAT_MAX : 0.0f, seed);
    set_hit_triangle(paths, i, hit.triangle);
    set_hit_instance(paths, i, hit.instance);
}
