#include "kernels_cpu/texture_rays.hpp"

#include "platform.h"

#include "common/as_cpp/path_rows.hpp"
#include "common/textures/texture_rays.h"
#include "kernels_cpu/texture_ray_loops.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace diptych {
namespace {

#include "kernels_cpu/typed_views.hpp"

constexpr int most_rays = 256;  // of a request
constexpr int passes = 8;       // surfaces that a ray to its own object passes, as in the walk
constexpr int padding = 48;     // packets are read and written whole; planes no power of two apart

// Rays in planes of their own, for EmbreeScene to read as if they were paths.
class Rays {
public:
    explicit Rays(int capacity) : capacity_(capacity), planes_(path_row_count, nullptr)
    {
        for (int row = 0; row < path_row_count; ++row) {
            if (!is_read(row)) continue;
            memory_.emplace_back(size_t(capacity) * size_t(path_rows[row].components) + 16);
            planes_[size_t(row)] = memory_.back().data();
        }
        view_.capacity = capacity;
        view_.planes = planes_.data();
    }

    float* reals(int row) const { return static_cast<float*>(planes_[size_t(row)]); }
    int* ints(int row) const { return static_cast<int*>(planes_[size_t(row)]); }
    void set3(int row, int k, float3 v) const
    {
        float* plane = reals(row);
        plane[k] = v.x;
        plane[capacity_ + k] = v.y;
        plane[2 * capacity_ + k] = v.z;
    }
    const PathView& view() const { return view_; }

private:
    static bool is_read(int row)
    {
        for (const int read :
             {row_pixel, row_sample, row_depth, row_ray_origin, row_ray_direction, row_hit_triangle,
              row_hit_instance, row_shadow_origin, row_shadow_direction, row_shadow_distance,
              row_light_contribution, row_is_occluded})
            if (row == read) return true;
        return false;
    }

    int capacity_;
    std::vector<std::vector<float>> memory_;
    std::vector<void*> planes_;
    PathView view_;
};

// Rays that only their own object stops: the nearest hits, pass by pass, until all are decided. The
// others have a depth below zero and are left alone.
int trace_to_own_object(const EmbreeScene& embree, const SceneView& scene_view, const Scene& scene,
                        const AskingPaths& asking, const Rays& rays)
{
    const int n = rays.view().capacity, count = asking.bundles * asking.rays;
    int* depth = rays.ints(row_depth);
    std::copy_n(rays.reals(row_shadow_origin), 3 * n, rays.reals(row_ray_origin));
    std::copy_n(rays.reals(row_shadow_direction), 3 * n, rays.reals(row_ray_direction));
    int traced = 0;
    for (int pass = 0; pass < passes; ++pass) {
        traced += embree.intersect(scene_view, rays.view(), count, false);
        for (int k = 0; k < count; ++k) {
            if (depth[k] < 0) continue;
            const int triangle = rays.ints(row_hit_triangle)[k];
            const int instance = rays.ints(row_hit_instance)[k];
            float& rest = rays.reals(row_shadow_distance)[k];
            float* o = rays.reals(row_ray_origin) + k;
            const float* d = rays.reals(row_ray_direction) + k;
            const float3 origin{o[0], o[n], o[2 * n]}, direction{d[0], d[n], d[2 * n]};
            const int alive = depth[k];
            depth[k] = -1;
            if (triangle < 0) continue;
            const WorldTriangle world = world_triangle(&scene, instance, triangle);
            const float2 w = triangle_barycentrics(world, origin, direction);
            const float3 at = world.corner + world.edge1 * w.x + world.edge2 * w.y;
            const float t = vec_dot(at - origin, direction);
            if (t > rest) continue;
            const int lane = asking.path_of_bundle[k / asking.rays];
            const int own = texture_object(&scene, asking.instance[lane], asking.triangle[lane]);
            if (texture_object(&scene, instance, triangle) == own) {
                rays.ints(row_is_occluded)[k] = 1;
                continue;
            }
            const float step = t * 1.00001f + 1e-6f * rest;
            rest -= step;
            o[0] += direction.x * step;
            o[n] += direction.y * step;
            o[2 * n] += direction.z * step;
            depth[k] = alive;
        }
    }
    return traced;
}

// Of the rays of one request of all lanes, which are occluded.
int trace_bundles(const EmbreeScene& embree, const SceneView& scene_view, const Scene& scene,
                  const AskingPaths& asking, const Rays& rays)
{
    const int* is_same_object = asking.is_same_object;
    const int same = int(std::count(is_same_object, is_same_object + asking.bundles, 1));
    const int count = asking.bundles * asking.rays;
    if (same == 0) {
        embree.occlusion_of_neighbours(scene_view, rays.view(), count);
        return count;
    }
    for (int k = 0; k < count; ++k) {
        const bool is_same = is_same_object[k / asking.rays] != 0;
        rays.ints(row_is_occluded)[k] = 0;
        rays.set3(row_light_contribution, k, make_float3(is_same ? 0.0f : 1.0f, 0.0f, 0.0f));
    }
    const int traced = embree.occlusion(scene_view, rays.view(), count);
    for (int k = 0; k < count; ++k)
        if (is_same_object[k / asking.rays] == 0) rays.ints(row_depth)[k] = -1;
    return traced + trace_to_own_object(embree, scene_view, scene, asking, rays);
}

// The work of one thread.
struct Tracer {
    const TextureRayLoops loops;
    const EmbreeScene& embree;
    const SceneView& scene_view;
    const PathView& path_view;
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    int traced = 0;

    // All requests of the paths in `asking`, which are then done with.
    void trace(AskingPaths& asking, Rays& rays)
    {
        if (asking.count == 0) return;
        loops.places(scene_view, path_view, asking);
        for (int request = 0;; ++request) {
            loops.rays(scene_view, path_view, asking, request, rays.view());
            if (asking.bundles == 0) break;
            traced += trace_bundles(embree, scene_view, scene, asking, rays);
            const int* is_occluded = rays.ints(row_is_occluded);
            for (int k = 0; k < asking.bundles; ++k, is_occluded += asking.rays) {
                const int open =
                    asking.rays - std::accumulate(is_occluded, is_occluded + asking.rays, 0);
                set_occlusion_result(&paths, request, asking.path[asking.path_of_bundle[k]],
                                     float(open) / float(asking.rays));
            }
        }
        asking.count = 0;
    }
};

}  // namespace

int trace_texture_rays(const EmbreeScene& embree, const SceneView& scene_view,
                       const PathView& path_view, int count)
{
    const TextureRayLoops loops = vector_texture_ray_loops(scene_view.effects);
    thread_local Rays rays(AskingPaths::capacity * most_rays + padding);
    thread_local AskingPaths asking;
    thread_local std::vector<int> programs;
    programs.resize(size_t(count));
    loops.programs(scene_view, path_view, 0, count, programs.data());
    Tracer tracer{loops, embree, scene_view, path_view};
    for (int i = 0; i < count; ++i) {
        const int program = programs[size_t(i)];
        if (program == 0 || texture_requests(&tracer.scene, program).count == 0) continue;
        asking.path[asking.count] = i;
        asking.program[asking.count++] = program;
        if (asking.count == AskingPaths::capacity) tracer.trace(asking, rays);
    }
    tracer.trace(asking, rays);
    return tracer.traced;
}

float trace_texture_ray_by_ray(const void* embree_scene, const SceneView& scene_view,
                               const PathView& path_view, int path, int request)
{
    const EmbreeScene& embree = *static_cast<const EmbreeScene*>(embree_scene);
    const Scene scene = scene_from(scene_view);
    const Paths paths = paths_from(path_view);
    thread_local Rays rays(padding);
    thread_local AskingPaths asking;
    asking.count = 1;
    asking.path[0] = path;
    asking.program[0] = texture_program_of(&scene, &paths, path);
    const TexturePlace place = texture_place(&scene, &paths, path);
    asking.triangle[0] = place.triangle;
    asking.instance[0] = place.instance;
    const TextureRequests requests = texture_requests(&scene, asking.program[0]);
    const TextureRequest asked = texture_request(&scene, &paths, path, requests.first, request);
    const uint seed = texture_ray_seed(&scene, &paths, path, place, request);
    asking.bundles = asking.rays = 1;
    asking.path_of_bundle[0] = 0;
    asking.is_same_object[0] = asked.is_same_object;
    const int count = scene.settings[0].occlusion_rays;
    const Paths one = paths_from(rays.view());
    int open = 0;
    for (int ray = 0; ray < count; ++ray) {
        const TextureRay r = texture_ray(place, seed, asked.hemisphere, ray);
        set_shadow_origin(&one, 0, r.origin);
        set_shadow_direction(&one, 0, r.direction);
        set_shadow_distance(&one, 0, asked.distance);
        set_pixel(&one, 0, get_pixel(&paths, path));
        set_sample(&one, 0, texture_ray_sample(get_sample(&paths, path), request, ray));
        set_depth(&one, 0, get_depth(&paths, path));
        trace_bundles(embree, scene_view, scene, asking, rays);
        open += 1 - get_is_occluded(&one, 0);
    }
    return float(open) / float(count);
}

}  // namespace diptych
