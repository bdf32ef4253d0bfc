// The native stages of a CPU that walks the same BVH as OpenCL. Included into the namespace of a
// kernel set.
#pragma once

#include "common/alpha.h"
#include "common/bvh.h"

SHARED void intersect(const Scene* scene, const Paths* paths, int i)
{
    const int depth = get_depth(paths, i);
    const uint seed =
        alpha_seed(scene->settings[0].seed, get_pixel(paths, i), get_sample(paths, i), depth, 0);
    const Hit hit =
        bvh_closest(scene, get_ray_origin(paths, i), get_ray_direction(paths, i), FLOAT_MAX, seed);
    set_hit_triangle(paths, i, depth >= 0 ? hit.triangle : -1);
    set_hit_instance(paths, i, hit.instance);
}

SHARED void occlusion(const Scene* scene, const Paths* paths, int i)
{
    const float3 light = get_light_contribution(paths, i);
    if (vec_max_component(light) > 0.0f) {
        const uint seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i),
                                     get_sample(paths, i), get_depth(paths, i), 1);
        set_is_occluded(paths, i,
                        bvh_occluded(scene, get_shadow_origin(paths, i),
                                     get_shadow_direction(paths, i), get_shadow_distance(paths, i),
                                     seed));
    }
}
