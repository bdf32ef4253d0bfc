// One light is chosen with a probability proportional to its power, and one point on it.
#pragma once

#include "common/lights/environment.h"
#include "common/lights/punctual_light.h"
#include "common/lights/triangle_light.h"
#include "common/random.h"

typedef struct {
    int light;
    float rest;  // a sample in [0, 1) of its own
} LightChoice;

// Vose's alias method; u: a fraction of 2^32. What the choice leaves of u says where on the light:
// points on lights of one surface stay as evenly spread as the samples themselves are.
SHARED LightChoice light_choose(const Scene* scene, uint u)
{
    const uint count = (uint)scene->settings[0].light_count;
    const int drawn = (int)multiply_high(u, count);
    const float within = uniform_from_bits(u * count);  // wraps: what the upper half leaves
    const int alias = ROW_AT(scene, light_choice, drawn).alias;
    const float threshold = ROW_AT(scene, light_choice, drawn).threshold;
    const int is_alias = within >= threshold;
    const int mask = is_alias ? -1 : 0;  // bits, not a select, which would select addresses
    const float start = is_alias ? threshold : 0.0f;
    const float size = is_alias ? 1.0f - threshold : threshold;
    LightChoice choice;
    choice.light = drawn ^ ((drawn ^ alias) & mask);
    choice.rest = math_lesser((within - start) / size, 0.99999994f);
    return choice;
}

SHARED LightSample light_sample_select(int is_second, LightSample a, LightSample b)
{
    LightSample sample;
    sample.direction = make_float3(is_second ? b.direction.x : a.direction.x,
                                   is_second ? b.direction.y : a.direction.y,
                                   is_second ? b.direction.z : a.direction.z);
    sample.distance = is_second ? b.distance : a.distance;
    sample.radiance = make_float3(is_second ? b.radiance.x : a.radiance.x,
                                  is_second ? b.radiance.y : a.radiance.y,
                                  is_second ? b.radiance.z : a.radiance.z);
    sample.pdf = is_second ? b.pdf : a.pdf;
    sample.is_punctual = is_second ? b.is_punctual : a.is_punctual;
    return sample;
}

// A sample of the light `light` seen from `from`; the kinds that the scene has none of cost
// nothing.
SHARED LightSample light_sample(const Scene* scene, int light, float3 from, float2 u)
{
    const int kind = ROW_AT(scene, lights, light).kind;
    LightSample sample;
    sample.direction = make_float3(0.0f, 0.0f, 1.0f);
    sample.distance = FLOAT_MAX;
    sample.radiance = make_float3(0.0f, 0.0f, 0.0f);
    sample.pdf = 0.0f;
    sample.is_punctual = 0;
    if (uses(scene, EFFECT_EMISSION))
        sample = light_sample_select(kind == LIGHT_TRIANGLE, sample,
                                     triangle_light_sample(scene, light, from, u));
    if (uses(scene, EFFECT_PUNCTUAL_LIGHTS)) {
        const int is_punctual = (kind >= LIGHT_POINT) & (kind <= LIGHT_DIRECTIONAL);
        sample =
            light_sample_select(is_punctual, sample, punctual_light_sample(scene, light, from));
    }
    if (uses(scene, EFFECT_ENVIRONMENT))
        sample = light_sample_select(kind == LIGHT_ENVIRONMENT, sample,
                                     environment_light_sample(scene, u));
    return sample;
}

// Power heuristic (Veach and Guibas 1995, exponent 2) for the technique with density a.
SHARED float mis_weight(float a, float b)
{
    const float ratio = b / a;
    const float weight = 1.0f / (1.0f + ratio * ratio);
    return a > 0.0f ? weight : 0.0f;
}

// Balance heuristic, for the environment: what its samples leave to scattering is chosen for it.
SHARED float mis_balance_weight(float a, float b)
{
    const float weight = 1.0f / (1.0f + b / a);
    return a > 0.0f ? weight : 0.0f;
}
