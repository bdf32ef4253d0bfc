// The open fraction of the rays that textures ask for, by the walk of common/bvh.h.
#pragma once

#include "common/bvh.h"
#include "common/textures/texture_rays.h"

// Of surfaces that a ray to its own object passes on the way, at most.
#define TEXTURE_RAY_PASSES 8

// Whether the ray meets the object within the distance; other objects let it through.
SHARED int bvh_occluded_by_object(const Scene* scene, float3 origin, float3 direction,
                                  float distance, uint seed, int object)
{
    float3 from = origin;
    float rest = distance;
    int is_occluded = 0;
    for (int pass = 0; pass < TEXTURE_RAY_PASSES && rest > 0.0f && !is_occluded; ++pass) {
        const Hit hit = bvh_closest(scene, from, direction, rest, seed);
        const int is_hit = hit.triangle >= 0;
        is_occluded = is_hit && texture_object(scene, hit.instance, hit.triangle) == object;
        const float step = hit.t * 1.00001f + 1e-6f * distance;
        from = from + direction * step;
        rest = is_hit ? rest - step : 0.0f;
    }
    return is_occluded;
}

SHARED float texture_openness(const Scene* scene, const Paths* paths, int i, TexturePlace place,
                              TextureRequest request, int number)
{
    const int rays = scene->settings[0].occlusion_rays;
    const int object = texture_object(scene, place.instance, place.triangle);
    const uint ray_seed = texture_ray_seed(scene, paths, i, place, number);
    int open = 0;
    for (int ray = 0; ray < rays; ++ray) {
        const TextureRay r = texture_ray(place, ray_seed, request.hemisphere, ray);
        const uint seed = alpha_seed(scene->settings[0].seed, get_pixel(paths, i),
                                     texture_ray_sample(get_sample(paths, i), number, ray),
                                     get_depth(paths, i), 1);
        int is_occluded;
        if (request.is_same_object)
            is_occluded = bvh_occluded_by_object(scene, r.origin, r.direction, request.distance,
                                                 seed, object);
        else
            is_occluded = bvh_occluded(scene, r.origin, r.direction, request.distance, seed);
        open += is_occluded ? 0 : 1;
    }
    return (float)open / (float)rays;
}

// The same where a texture runs that has asked, for its material's request `number`.
SHARED float texture_openness_at(const Scene* scene, const Paths* paths, int i, int number)
{
    const TextureRequests requests = texture_requests(scene, texture_program_of(scene, paths, i));
    return texture_openness(scene, paths, i, texture_place(scene, paths, i),
                            texture_request(scene, paths, i, requests.first, number), number);
}

SHARED void trace_texture_rays(const Scene* scene, const Paths* paths, int i)
{
    const int program = texture_program_of(scene, paths, i);
    if ((program != 0) & (get_depth(paths, i) >= 0)) {
        const TextureRequests requests = texture_requests(scene, program);
        const TexturePlace place = texture_place(scene, paths, i);
        for (int k = 0; k < requests.count; ++k)
            set_occlusion_result(
                paths, k, i,
                texture_openness(scene, paths, i, place,
                                 texture_request(scene, paths, i, requests.first, k), k));
    }
}
