// Makes up the mind of a ray that stopped where a texture gives the alpha: the textures have run
// for its record. The record of a ray that stays goes; the others' say behind what the ray goes on.
// Runs over the view of the records (common/buffers.h, LOOKUP_*).
#pragma once

#include "common/alpha.h"

SHARED void decide_alpha(const Scene* scene, const Paths* paths, int i)
{
    const int record = get_hit_triangle(paths, i);
    const int is_asked = record >= 0;
    const int triangle = is_asked ? record : 0;
    const int instance = is_asked ? get_hit_instance(paths, i) : 0;
    const WorldTriangle world = world_triangle(scene, instance, triangle);
    const float2 weights =
        triangle_barycentrics(world, get_ray_origin(paths, i), get_ray_direction(paths, i));
    const int output = scene->settings[0].texture_output[SLOT_BASE];
    const int plane = output < 0 ? 0 : 4 * output;
    const float4 texel = make_float4(1.0f, 1.0f, 1.0f, get_texture_result(paths, plane + 3, i));
    const float alpha = surface_colored(scene, triangle, weights, texel).w;
    const int purpose = paths->lookup == LOOKUP_SHADOW;
    const uint seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i), get_sample(paths, i),
                                 get_depth(paths, i), purpose);
    const int stops = alpha_stops(scene, instance, triangle, alpha, seed);
    set_hit_triangle(paths, i, (is_asked & !stops) ? record : -1);
}
