// Emissive triangles, sampled uniformly over their area; light leaves the front side only.
#pragma once

#include "common/lights/light_sample.h"
#include "common/surface.h"

// Weights of the second and third corner: a fold of the square that keeps strata together (Heitz,
// "A Low-Distortion Map Between Triangle and Square", 2019).
SHARED float2 triangle_sample(float2 u)
{
    const int is_upper = u.y > u.x;
    const float x = is_upper ? u.x * 0.5f : u.x - u.y * 0.5f;
    const float y = is_upper ? u.y - u.x * 0.5f : u.y * 0.5f;
    return make_float2(x, y);
}

SHARED LightSample triangle_light_sample(const Scene* scene, int light, float3 from, float2 u)
{
    const float3 corner = make_float3(ROW_AT(scene, lights, light).position.x,
                                      ROW_AT(scene, lights, light).position.y,
                                      ROW_AT(scene, lights, light).position.z);
    const float3 edge1 =
        make_float3(ROW_AT(scene, lights, light).edge1.x, ROW_AT(scene, lights, light).edge1.y,
                    ROW_AT(scene, lights, light).edge1.z);
    const float3 edge2 =
        make_float3(ROW_AT(scene, lights, light).edge2.x, ROW_AT(scene, lights, light).edge2.y,
                    ROW_AT(scene, lights, light).edge2.z);
    const float2 weights = triangle_sample(u);
    const float3 normal = vec_cross(edge1, edge2);  // length: twice the area
    const float length = vec_length(normal);
    const float3 unit_normal = normal * (1.0f / length);
    const float3 point = corner + edge1 * weights.x + edge2 * weights.y;

    const float magnitude = math_greater(vec_max_component(vec_abs(corner)),
                                         math_greater(vec_max_component(vec_abs(corner + edge1)),
                                                      vec_max_component(vec_abs(corner + edge2))));
    const float3 to_plane = from - point;
    const float3 target = offset_origin(point, unit_normal, surface_error(magnitude), to_plane);
    const float3 towards = target - from;
    const float distance2 = vec_dot(towards, towards);
    const float distance = math_sqrt(distance2);
    const float3 direction = towards * (distance > 0.0f ? 1.0f / distance : 0.0f);
    const float cosine =
        -vec_dot(unit_normal, direction) * ROW_AT(scene, lights, light).normal_sign;

    float3 radiance = make_float3(ROW_AT(scene, lights, light).emission.x,
                                  ROW_AT(scene, lights, light).emission.y,
                                  ROW_AT(scene, lights, light).emission.z);
    if (uses(scene, EFFECT_EMISSION_TEXTURE)) {
        const int triangle = ROW_AT(scene, lights, light).triangle;
        const int material = ROW_AT(scene, triangles, triangle).material;
        const int slot = scene->materials[material].emission_slot;
        const float4 texel = surface_texture(scene, triangle, weights, slot);
        radiance = make_float3(scene->materials[material].emission.x * texel.x,
                               scene->materials[material].emission.y * texel.y,
                               scene->materials[material].emission.z * texel.z);
    }
    const float area_pdf = ROW_AT(scene, lights, light).emission.w * 2.0f / length;
    const int is_visible = (cosine > 0.0f) & (distance > 0.0f);
    LightSample sample;
    sample.direction = direction;
    sample.distance = distance;
    sample.radiance = make_float3(is_visible ? radiance.x : 0.0f, is_visible ? radiance.y : 0.0f,
                                  is_visible ? radiance.z : 0.0f);
    sample.pdf = is_visible ? area_pdf * distance2 / cosine : 0.0f;
    sample.is_punctual = 0;
    return sample;
}
