// Compiled once for each set of vectors, as stages.cpp is.
#include "kernels_cpu/texture_ray_loops.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace diptych::KERNEL_SET {
#include "platform.h"

#include "common/textures/texture_rays.h"

namespace {

#include "kernels_cpu/typed_views.hpp"

[[gnu::noinline]] void texture_programs(const SceneView& scene_view, const PathView& path_view,
                                        int first, int count, int* programs)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
#pragma omp simd
    for (int k = 0; k < count; ++k) programs[k] = texture_program_of(&scene, &paths, first + k);
}

SHARED void store3(float (&planes)[3][AskingPaths::capacity], int k, float3 v)
{
    planes[0][k] = float(v.x);
    planes[1][k] = float(v.y);
    planes[2][k] = float(v.z);
}

SHARED float3 load3(const float (&planes)[3][AskingPaths::capacity], int k)
{
    return make_float3(planes[0][k], planes[1][k], planes[2][k]);
}

SHARED void store_place(const Scene* scene, const Paths* paths, AskingPaths& asking, int k)
{
    const TexturePlace place = texture_place(scene, paths, asking.path[k]);
    asking.triangle[k] = place.triangle;
    asking.instance[k] = place.instance;
    asking.is_front[k] = place.is_front;
    asking.error[k] = place.error;
    store3(asking.position, k, place.position);
    store3(asking.face_normal, k, place.face_normal);
    store3(asking.normal, k, place.normal);
}

template<unsigned effects>
[[gnu::noinline]] void texture_places(const SceneView& scene_view, const PathView& path_view,
                                      AskingPaths& asking)
{
    Scene scene = scene_from(scene_view);
    scene.effects = effects;
    const auto settings = *scene.settings;
    scene.settings = &settings;
    const Paths paths = paths_from(path_view);
    const int count = asking.count;
#pragma omp simd
    for (int k = 0; k < count; ++k) store_place(&scene, &paths, asking, k);
}

// What the rays of one request of one path have in common.
struct CommonToRays {
    TexturePlace place;
    uint seed;
    int hemisphere;
    float distance;
    int pixel, sample, depth, request;
};

SHARED void store_ray(const Paths* rays, const CommonToRays& common, int k, int ray)
{
    const TextureRay r = texture_ray(common.place, common.seed, common.hemisphere, ray);
    set_shadow_origin(rays, k, r.origin);
    set_shadow_direction(rays, k, r.direction);
    set_shadow_distance(rays, k, common.distance);
    set_pixel(rays, k, common.pixel);
    set_sample(rays, k, texture_ray_sample(common.sample, common.request, ray));
    set_depth(rays, k, common.depth);
}

// Even rays before odd ones: of points of Sobol's sequence these are the two halves of the first
// dimension, so that the rays of a packet go to the same half of the hemisphere. Their order
// changes no result: they are counted.
[[gnu::noinline]] void store_rays(const Paths& rays_in, const CommonToRays& common, int first,
                                  int count)
{
    const Paths rays = rays_in;
    const CommonToRays same = common;
    const int even = (count + 1) / 2;
#pragma omp simd
    for (int k = 0; k < count; ++k)
        store_ray(&rays, same, first + k, k < even ? 2 * k : 2 * (k - even) + 1);
}

// The rays of all asking paths that have so many requests, path by path; says which these are and
// what they ask.
[[gnu::noinline]] void texture_rays(const SceneView& scene_view, const PathView& path_view,
                                    AskingPaths& asking, int request, const PathView& ray_view)
{
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view), rays = paths_from(ray_view);
    asking.rays = scene.settings[0].occlusion_rays;
    asking.bundles = 0;
    for (int k = 0; k < asking.count; ++k) {
        const TextureRequests requests = texture_requests(&scene, asking.program[k]);
        if (request >= requests.count) continue;
        const TextureRequest asked =
            texture_request(&scene, &paths, asking.path[k], requests.first, request);
        const int i = asking.path[k];
        CommonToRays common;
        common.place.triangle = asking.triangle[k];
        common.place.instance = asking.instance[k];
        common.place.weights = make_float2(0.0f, 0.0f);
        common.place.position = load3(asking.position, k);
        common.place.face_normal = load3(asking.face_normal, k);
        common.place.normal = load3(asking.normal, k);
        common.place.error = asking.error[k];
        common.place.is_front = asking.is_front[k];
        common.seed = texture_ray_seed(&scene, &paths, i, common.place, request);
        common.hemisphere = asked.hemisphere;
        common.distance = asked.distance;
        common.pixel = get_pixel(&paths, i);
        common.sample = get_sample(&paths, i);
        common.depth = get_depth(&paths, i);
        common.request = request;
        store_rays(rays, common, asking.bundles * asking.rays, asking.rays);
        asking.path_of_bundle[asking.bundles] = k;
        asking.is_same_object[asking.bundles++] = asked.is_same_object;
    }
}

// What the place of a path depends on.
constexpr unsigned smooth = EFFECT_SMOOTH_NORMALS, placed = EFFECT_INSTANCES;

}  // namespace

TextureRayLoops texture_ray_loops(unsigned effects)
{
    const bool is_smooth = (effects & smooth) != 0, is_placed = (effects & placed) != 0;
    const auto places = is_smooth
                            ? (is_placed ? texture_places<smooth | placed> : texture_places<smooth>)
                            : (is_placed ? texture_places<placed> : texture_places<0>);
    return {texture_programs, places, texture_rays};
}

}  // namespace diptych::KERNEL_SET
