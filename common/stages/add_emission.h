// Light that the ray ran into: an emissive surface, or the environment where it left the scene.
// Weighted against light sampling, which could have found the same (multiple importance sampling,
// Veach and Guibas 1995).
#pragma once

#include "common/lights/lights.h"
#include "common/stages/evaluate_surface.h"

SHARED void add_emission(const Scene* scene, const Paths* paths, int i)
{
    const int kind = get_surface_kind(paths, i);
    const float scatter_pdf = get_scatter_pdf(paths, i);
    const int is_alone =
        scatter_pdf <= 0.0f;  // from the camera or a mirror: light sampling cannot make this path
    float3 light = make_float3(0.0f, 0.0f, 0.0f);
    if (uses(scene, EFFECT_EMISSION)) {
        const float weight = mis_weight(scatter_pdf, get_emission_pdf(paths, i));
        const float share = is_alone ? 1.0f : weight;
        light = select3(kind == SURFACE_LIT, get_emission(paths, i) * share, light);
    }
    if (uses(scene, EFFECT_ENVIRONMENT)) {
        const float2 uv =
            environment_uv(direction_to_environment(scene, get_ray_direction(paths, i)));
        const float pdf = scene->settings[0].environment_probability * environment_pdf(scene, uv);
        const float weight = mis_balance_weight(scatter_pdf, pdf);
        const float share = is_alone ? 1.0f : weight;
        light = select3(kind == SURFACE_NONE, environment_radiance(scene, uv) * share, light);
    }
    if (uses(scene, EFFECT_UNLIT))
        light = select3(kind == SURFACE_UNLIT, get_base_color(paths, i), light);
    const int depth = get_depth(paths, i);
    const float3 seen = get_radiance(paths, i) + get_throughput(paths, i) * light;
    set_radiance(paths, i, select3(depth >= 0, seen, get_radiance(paths, i)));
}
