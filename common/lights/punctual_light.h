// Point, spot and directional lights of KHR_lights_punctual.
#pragma once

#include "common/buffers.h"
#include "common/lights/light_sample.h"
#include "common/math.h"

// The window that fades a light with a range (KHR_lights_punctual, "Range Property").
SHARED float range_window(float distance, float range)
{
    const float x = distance / range;
    const float x2 = x * x;
    const float inside = math_clamp(1.0f - x2 * x2, 0.0f, 1.0f);
    return range > 0.0f ? inside : 1.0f;
}

SHARED LightSample punctual_light_sample(const Scene* scene, int light, float3 from)
{
    const int kind = ROW_AT(scene, lights, light).kind;
    const float3 position = make_float3(ROW_AT(scene, lights, light).position.x,
                                        ROW_AT(scene, lights, light).position.y,
                                        ROW_AT(scene, lights, light).position.z);
    const float3 axis =
        make_float3(ROW_AT(scene, lights, light).edge1.x, ROW_AT(scene, lights, light).edge1.y,
                    ROW_AT(scene, lights, light).edge1.z);
    const float3 emission = make_float3(ROW_AT(scene, lights, light).emission.x,
                                        ROW_AT(scene, lights, light).emission.y,
                                        ROW_AT(scene, lights, light).emission.z);
    const float3 towards = position - from;
    const float distance2 = vec_dot(towards, towards);
    const float distance = math_sqrt(distance2);
    const float inverse = distance > 0.0f ? 1.0f / distance : 0.0f;
    const float3 unit = towards * inverse;

    const float cosine = -vec_dot(unit, axis);
    const float ramp = math_clamp((cosine - ROW_AT(scene, lights, light).edge2.x) *
                                      ROW_AT(scene, lights, light).edge2.y,
                                  0.0f, 1.0f);
    const float cone = kind == LIGHT_SPOT ? ramp * ramp : 1.0f;
    const float falloff =
        inverse * inverse * cone * range_window(distance, ROW_AT(scene, lights, light).range);

    const int is_far = kind == LIGHT_DIRECTIONAL;
    const float strength = is_far ? 1.0f : falloff;
    LightSample sample;
    sample.direction = make_float3(is_far ? -axis.x : unit.x, is_far ? -axis.y : unit.y,
                                   is_far ? -axis.z : unit.z);
    sample.distance = is_far ? FLOAT_MAX : distance;
    sample.radiance = emission * strength;
    sample.pdf = ROW_AT(scene, lights, light).emission.w;
    sample.is_punctual = 1;
    return sample;
}
