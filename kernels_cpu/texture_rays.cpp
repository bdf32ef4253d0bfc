#include "kernels_cpu/texture_rays.hpp"

#include "platform.h"

#include "common/as_cpp/path_rows.hpp"
#include "common/textures/texture_rays.h"

#include <algorithm>
#include <vector>

namespace diptych {
namespace {

#include "kernels_cpu/typed_views.hpp"

constexpr int lane_count = 64;  // paths whose rays are traced together
constexpr int most_rays = 256;  // of a request
constexpr int passes = 8;       // surfaces that a ray to its own object passes, as in the walk

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

struct Views {
    Scene scene;
    Paths paths;
};

Views typed(const SceneView& scene, const PathView& paths)
{
    return {scene_from(scene), paths_from(paths)};
}

// The paths whose rays are traced together, each with its place.
struct Lanes {
    int count = 0;
    int path[lane_count];
    TextureRequests requests[lane_count];
    TexturePlace place[lane_count];
};

// One ray of a request of each lane into slots first ...; lanes without that request stay dark.
void add_rays(const Views& views, const Lanes& lanes, const Rays& rays, int request, int ray,
              int first)
{
    for (int k = 0; k < lanes.count; ++k) {
        const int i = lanes.path[k], at = first + k;
        const bool is_asked = request < lanes.requests[k].count;
        const TextureRequest asked =
            texture_request(&views.scene, lanes.requests[k].first, is_asked ? request : 0);
        const TextureRay r = texture_ray(&views.scene, &views.paths, i, lanes.place[k], request,
                                         asked.hemisphere, ray);
        rays.set3(row_shadow_origin, at, r.origin);
        rays.set3(row_shadow_direction, at, r.direction);
        rays.reals(row_shadow_distance)[at] = asked.distance;
        const float wanted = is_asked && !asked.is_same_object ? 1.0f : 0.0f;
        rays.set3(row_light_contribution, at, make_float3(wanted, 0.0f, 0.0f));
        rays.ints(row_is_occluded)[at] = 0;
        rays.ints(row_pixel)[at] = get_pixel(&views.paths, i);
        rays.ints(row_sample)[at] = texture_ray_sample(get_sample(&views.paths, i), request, ray);
        rays.ints(row_depth)[at] =
            is_asked && asked.is_same_object ? get_depth(&views.paths, i) : -1;
    }
}

// Rays that only their own object stops: the nearest hits, pass by pass, until all are decided.
int trace_to_own_object(const EmbreeScene& embree, const SceneView& scene_view, const Views& views,
                        const Lanes& lanes, const Rays& rays, int count)
{
    int* depth = rays.ints(row_depth);
    if (std::none_of(depth, depth + count, [](int d) { return d >= 0; })) return 0;
    const int n = rays.view().capacity;
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
            const WorldTriangle world = world_triangle(&views.scene, instance, triangle);
            const float2 w = triangle_barycentrics(world, origin, direction);
            const float3 at = world.corner + world.edge1 * w.x + world.edge2 * w.y;
            const float t = vec_dot(at - origin, direction);
            if (t > rest) continue;
            const TexturePlace& place = lanes.place[k % lanes.count];
            const int own = texture_object(&views.scene, place.instance, place.triangle);
            if (texture_object(&views.scene, instance, triangle) == own) {
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

int trace_lanes(const EmbreeScene& embree, const SceneView& scene_view, const Views& views,
                const Lanes& lanes, Rays& rays)
{
    const int per_request = std::min(views.scene.settings[0].occlusion_rays, most_rays);
    int most = 0, traced = 0;
    for (int k = 0; k < lanes.count; ++k) most = std::max(most, lanes.requests[k].count);
    for (int request = 0; request < most; ++request) {
        const int count = per_request * lanes.count;
        for (int ray = 0; ray < per_request; ++ray)
            add_rays(views, lanes, rays, request, ray, ray * lanes.count);
        traced += embree.occlusion(scene_view, rays.view(), count);
        traced += trace_to_own_object(embree, scene_view, views, lanes, rays, count);
        for (int k = 0; k < lanes.count; ++k) {
            if (request >= lanes.requests[k].count) continue;
            int open = 0;
            for (int ray = 0; ray < per_request; ++ray)
                open += 1 - rays.ints(row_is_occluded)[ray * lanes.count + k];
            set_occlusion_result(&views.paths, request, lanes.path[k],
                                 float(open) / float(per_request));
        }
    }
    return traced;
}

}  // namespace

int trace_texture_rays(const EmbreeScene& embree, const SceneView& scene_view,
                       const PathView& path_view, int count)
{
    const Views views = typed(scene_view, path_view);
    thread_local Rays rays(lane_count * most_rays + 16);
    Lanes lanes;
    int traced = 0;
    for (int i = 0; i < count; ++i) {
        const int program = texture_program_of(&views.scene, &views.paths, i);
        if (program == 0 || get_depth(&views.paths, i) < 0) continue;
        const TextureRequests requests = texture_requests(&views.scene, program);
        if (requests.count == 0) continue;
        lanes.path[lanes.count] = i;
        lanes.requests[lanes.count] = requests;
        lanes.place[lanes.count] = texture_place(&views.scene, &views.paths, i);
        if (++lanes.count < lane_count) continue;
        traced += trace_lanes(embree, scene_view, views, lanes, rays);
        lanes.count = 0;
    }
    if (lanes.count > 0) traced += trace_lanes(embree, scene_view, views, lanes, rays);
    return traced;
}

}  // namespace diptych
