// Next-event estimation: one point on one light, what it would contribute, and the shadow ray that
// decides.
#pragma once

#include "common/lights/lights.h"
#include "common/random.h"
#include "common/stages/scale_light.h"
#include "common/stages/surface_frame.h"

SHARED void sample_light_missed(const Scene* scene, const Paths* paths, int i)
{
    (void)scene;  // where effects are constants
    set_light_contribution(paths, i, make_float3(0.0f, 0.0f, 0.0f));
    if (uses(scene, EFFECT_PROCEDURAL_EMISSION)) set_record_triangle(paths, 0, i, -1);
}

SHARED void sample_light(const Scene* scene, const Paths* paths, int i)
{
    const int depth = get_depth(paths, i);
    const int kind = get_surface_kind(paths, i);
    const int may_scatter =
        (depth >= 0) & (depth < scene->settings[0].max_bounces) & (kind == SURFACE_LIT);
    const SampleKey key = sample_key(scene->settings[0].seed, scene->settings[0].sequence_quanta,
                                     get_pixel(paths, i), get_sample(paths, i));
    const SampleBits bits = sample_bits(key, bounce_dimension(depth, PAIR_LIGHT));

    const float3 position = get_position(paths, i);
    const float3 face_normal = get_face_normal(paths, i);
    const float3 normal = get_normal(paths, i);
    const float3 origin = position + face_normal * get_position_error(paths, i);
    const LightChoice choice = light_choose(scene, bits.x);
    const int light = choice.light;
    const float2 on_light = make_float2(choice.rest, uniform_from_bits(bits.y));
    const LightSample sample = light_sample(scene, light, origin, on_light);

    const Frame frame = frame_of(normal);
    const float3 wi = to_frame(frame, sample.direction);
    Scatter scatter;
    if (uses(scene, EFFECT_SPECULAR)) {
        const float3 wo = to_frame(frame, -get_ray_direction(paths, i));
        const Lobes lobes = lobes_of(surface_of_path(paths, i), wo.z);
        scatter = lobes_evaluate(lobes, wo, wi);
    } else {
        scatter = diffuse_evaluate(get_base_color(paths, i), wi);
    }
    const float power_weight = mis_weight(sample.pdf, scatter.pdf);
    float weight = power_weight;
    if (uses(scene, EFFECT_ENVIRONMENT)) {
        const int is_environment = light == scene->settings[0].environment_light;
        const float balance_weight = mis_balance_weight(sample.pdf, scatter.pdf);
        weight = is_environment ? balance_weight : power_weight;
    }
    const float share = sample.is_punctual ? 1.0f : weight;
    const float inverse = sample.pdf > 0.0f ? share / sample.pdf : 0.0f;
    const float3 contribution =
        get_throughput(paths, i) * scatter.value * sample.radiance * inverse;

    const int is_lit = may_scatter & (vec_dot(face_normal, sample.direction) > 0.0f);
    const float3 none = make_float3(0.0f, 0.0f, 0.0f);
    set_shadow_origin(paths, i, origin);
    set_shadow_direction(paths, i, sample.direction);
    set_shadow_distance(paths, i, sample.distance);
    const float3 lit = select3(is_lit, contribution, none);
    set_light_contribution(paths, i, lit);
    set_is_occluded(paths, i, 1);
    if (uses(scene, EFFECT_PROCEDURAL_EMISSION)) record_light(scene, paths, i, light, lit);
}
