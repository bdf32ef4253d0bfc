// Occlusion that textures ask for: rays about the place that a path has met, traced by a stage of
// their own before the textures are evaluated.
#pragma once

#include "common/alpha.h"
#include "common/materials/metallic_roughness.h"
#include "common/textures/procedural.h"

// As backends/textures/texture_function.hpp has them.
#define HEMISPHERE_UPPER 0
#define HEMISPHERE_LOWER 1
#define HEMISPHERE_BOTH 2

#define TEXTURE_REQUEST_WORDS 4

typedef struct {
    float distance;
    int hemisphere;
    int is_same_object;
} TextureRequest;

// Requests of all steps of a program, in the order of their results.
typedef struct {
    int first;  // word of the first
    int count;
} TextureRequests;

SHARED TextureRequests texture_requests(const Scene* scene, int program)
{
    TextureRequests requests;
    requests.first = (int)material_word(scene, program + 2);
    requests.count = (int)material_word(scene, program + 3);
    return requests;
}

// The distance is an argument, or a constant beside the arguments: a word either way. Or it is what
// another texture gave for path i.
SHARED TextureRequest texture_request(const Scene* scene, const Paths* paths, int i, int first,
                                      int k)
{
    const int word = first + k * TEXTURE_REQUEST_WORDS;
    const int at = (int)material_word(scene, word);
    float asked = as_float(material_word(scene, at < 0 ? 0 : at));
    if (uses(scene, EFFECT_OCCLUSION_DISTANCE) && at < 0)
        asked = get_request_distance(paths, ~at, i);
    const float otherwise = as_float(material_word(scene, (int)material_word(scene, word + 3)));
    TextureRequest request;
    request.distance = asked > 0.0f ? asked : otherwise;
    request.hemisphere = (int)material_word(scene, word + 1);
    request.is_same_object = (int)material_word(scene, word + 2);
    return request;
}

typedef struct {
    float3 origin;
    float3 direction;
} TextureRay;

// What the rays of a request of path i have in common: the seed of their stratified sample.
SHARED uint texture_ray_seed(const Scene* scene, const Paths* paths, int i, TexturePlace place,
                             int request)
{
    const SampleKey key = sample_key(scene->settings[0].seed, scene->settings[0].sequence_quanta,
                                     get_pixel(paths, i), get_sample(paths, i));
    const uint bits = (uint)(get_depth(paths, i) * 64 + request);
    const int is_own = (paths->lookup == LOOKUP_SURFACE) | (paths->lookup == LOOKUP_AOV);
    const uint where =  // else a surface and what it is lit by would be seen through the same rays
        is_own ? 0u : hash_pair((uint)paths->lookup, (uint)(place.triangle ^ place.instance << 16));
    return hash_pair(hash_pair(key.seed, key.index), bits ^ where ^ 0x2545f491u);
}

// Ray `ray` of a request: cosine-distributed about the shading normal, or opposite to it; of
// `both`, every second. The rays of a request are stratified among themselves.
SHARED TextureRay texture_ray(TexturePlace place, uint seed, int hemisphere, int ray)
{
    SampleKey key;
    key.index = (uint)ray;
    key.seed = seed;
    const float2 u = sample_pair(key, 0);
    // In whole numbers: a truth that is the same for all rays would keep loops over them scalar.
    const int always = hemisphere == HEMISPHERE_LOWER ? 1 : 0;
    const int every_second = hemisphere == HEMISPHERE_BOTH ? 1 : 0;
    const int is_lower = always | (ray & every_second);
    const float side = (float)(1 - 2 * is_lower) * (place.is_front ? 1.0f : -1.0f);
    const float3 normal = place.normal * side;
    const float3 face_normal = place.face_normal * side;
    const float turn = 2.0f * u.y;
    const float disc = math_sqrt(u.x);
    TextureRay result;
    result.direction = frame_tangent(normal) * (disc * math_cospi(turn)) +
                       frame_bitangent(normal) * (disc * math_sinpi(turn)) +
                       normal * math_sqrt(1.0f - u.x);
    result.origin = place.position + face_normal * place.error;
    return result;
}

// In place of the path's sample number, for what the ray meets of surfaces with holes
// (common/alpha.h).
SHARED int texture_ray_sample(int sample, int request, int ray)
{
    return (int)((uint)sample ^ ((uint)(request * 256 + ray + 1) * 0x9e3779b1u));
}
