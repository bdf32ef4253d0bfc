#include "kernels_cpu/embree_scene.hpp"

#include "platform.h"

#include "common/alpha.h"
#include "common/buffers.h"
#include "kernels_cpu/embree.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace diptych {
namespace {

#include "kernels_cpu/typed_views.hpp"

#include "kernels_cpu/embree_filters.hpp"

[[noreturn]] void fail(RTCDevice device, const std::string& what)
{
    throw std::runtime_error("Embree: " + what + " (error " +
                             std::to_string(int(rtcGetDeviceError(device))) +
                             "); try less --memory or a smaller scene");
}

// Whether path i has a ray in this round.
bool is_waiting(const Paths& paths, int i)
{
    return paths.lookup == LOOKUP_SURFACE || paths.record_triangle[i] >= 0;
}

// Whether there are records, and surfaces to leave them of.
bool has_records(const Views& views)
{
    return views.paths.record_triangle && uses(&views.scene, EFFECT_PROCEDURAL_ALPHA);
}

// Leaves a record of what a ray met, if a texture has to be asked about it; triangle -1: nothing.
void leave_record(const Views& views, int i, int instance, int triangle, float distance)
{
    const bool is_asked = triangle >= 0 && alpha_is_asked(&views.scene, triangle);
    views.paths.record_triangle[i] = is_asked ? triangle : -1;
    views.paths.record_instance[i] = instance;
    views.paths.record_distance[i] = distance;
}

// purpose: as of alpha_seed().
PacketContext context_of(const Views& views, const std::vector<int>& first_triangle,
                         bool is_coherent, int purpose)
{
    PacketContext context;
    context.query = embree::begin_query(is_coherent);
    context.views = &views;
    context.first_triangle = first_triangle.data();
    context.purpose = purpose;
    return context;
}

// Of ray i of the planes, of n entries each, between two distances.
RTCRayHit query_of(const float* origin, const float* direction, int n, int i, float nearest,
                   float farthest)
{
    // as vectors: Embree reads them as such, and would wait for single stores
    using Quad __attribute__((vector_size(16))) = float;
    const Quad from{origin[i], origin[n + i], origin[2 * n + i], nearest};
    const Quad along{direction[i], direction[n + i], direction[2 * n + i], 0.0f};
    RTCRayHit query;
    std::memcpy(&query.ray.org_x, &from, sizeof from);    // and tnear
    std::memcpy(&query.ray.dir_x, &along, sizeof along);  // and time
    query.ray.tfar = farthest;
    query.ray.mask = ~0u;
    query.ray.id = 0;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

// One query a living path, in `context`, for rays that have nothing in common. Returns their
// number.
int intersect_singly(RTCScene scene, PacketContext& context, const Views& views, int count)
{
    const Paths& paths = views.paths;
    const int n = paths.capacity;
    int rays = 0;
    for (int i = 0; i < count; ++i) {
        if (!is_waiting(paths, i)) continue;
        const float nearest = begin_lane(context, paths, 0, i, true);
        paths.hit_instance[i] = 0;
        paths.hit_triangle[i] = -1;
        if (context.leaves_records) leave_record(views, i, 0, -1, 0);
        if (paths.depth[i] < 0) continue;
        ++rays;
        RTCRayHit query = query_of(paths.ray_origin, paths.ray_direction, n, i, nearest, far_away);
        embree::intersect(scene, context.query, query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
        const int instance = instance_of(query.hit.instID[0]);
        paths.hit_instance[i] = instance;
        paths.hit_triangle[i] = context.first_triangle[instance] + int(query.hit.primID);
        if (context.leaves_records)
            leave_record(views, i, instance, paths.hit_triangle[i], query.ray.tfar);
    }
    return rays;
}

}  // namespace

struct EmbreeScene::Implementation {
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<RTCScene> meshes;
    std::vector<int> first_triangle;
    std::atomic<long> bytes{0};

    ~Implementation()
    {
        for (RTCScene mesh : meshes) rtcReleaseScene(mesh);
        if (top) rtcReleaseScene(top);
        if (device) rtcReleaseDevice(device);
    }

    RTCGeometry triangles_of(const EmbreeMesh& mesh, unsigned effects) const
    {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.positions, 0, 16, mesh.vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles, 0, 16, size_t(mesh.triangle_count));
        if ((effects & EFFECT_PROCEDURAL_ALPHA) != 0) {
            rtcSetGeometryIntersectFilterFunction(geometry, filter_passed_then_alpha);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_asked_then_alpha);
        } else if ((effects & EFFECT_ALPHA) != 0) {
            rtcSetGeometryIntersectFilterFunction(geometry, filter_alpha_then_ties);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_alpha);
        } else {
            rtcSetGeometryIntersectFilterFunction(geometry, filter_ties);
        }
        rtcCommitGeometry(geometry);
        return geometry;
    }

    void attach(RTCScene scene, RTCGeometry geometry, unsigned id) const
    {
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    RTCScene new_scene() const
    {
        RTCScene scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        return scene;
    }

    // Instances of one mesh share its scene: `same_as` is that of an earlier instance of it, or
    // nullptr.
    RTCScene mesh_scene(const EmbreeMesh& mesh, unsigned effects)
    {
        RTCScene scene = new_scene();
        attach(scene, triangles_of(mesh, effects), 0);
        rtcCommitScene(scene);
        meshes.push_back(scene);
        return scene;
    }
};

namespace {

bool count_bytes(void* pointer, ssize_t bytes, bool)
{
    *static_cast<std::atomic<long>*>(pointer) += long(bytes);
    return true;
}

}  // namespace

EmbreeScene::EmbreeScene(const EmbreeMesh* meshes, int count, int threads, unsigned effects)
    : implementation_(std::make_unique<Implementation>())
{
    Implementation& self = *implementation_;
    const std::string config = "threads=" + std::to_string(threads);
    self.device = rtcNewDevice(config.c_str());
    if (!self.device)
        throw std::runtime_error("Embree: cannot start; is the processor x86-64 or ARM64?");
    rtcSetDeviceMemoryMonitorFunction(self.device, count_bytes, &self.bytes);
    self.top = self.new_scene();
    std::vector<std::pair<int, RTCScene>> placed;  // first triangle of a mesh, its scene
    for (int k = 0; k < count; ++k) {
        const EmbreeMesh& mesh = meshes[k];
        self.first_triangle.push_back(mesh.first_triangle);
        if (mesh.triangle_count == 0) continue;
        if (!mesh.to_world) {
            self.attach(self.top, self.triangles_of(mesh, effects), unsigned(k));
            continue;
        }
        if (placed.empty() || placed.back().first != mesh.first_triangle)
            placed.emplace_back(mesh.first_triangle, self.mesh_scene(mesh, effects));
        RTCGeometry instance = rtcNewGeometry(self.device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, placed.back().second);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, mesh.to_world);
        rtcCommitGeometry(instance);
        self.attach(self.top, instance, unsigned(k));
    }
    rtcCommitScene(self.top);
    if (rtcGetDeviceError(self.device) != RTC_ERROR_NONE)
        fail(self.device, "cannot build the scene's structure");
}

EmbreeScene::~EmbreeScene() = default;

size_t EmbreeScene::bytes() const { return size_t(implementation_->bytes.load()); }

std::string EmbreeScene::version()
{
    return "Embree " + std::to_string(RTC_VERSION_MAJOR) + "." + std::to_string(RTC_VERSION_MINOR) +
           "." + std::to_string(RTC_VERSION_PATCH);
}

int EmbreeScene::intersect(const SceneView& scene_view, const PathView& path_view, int count,
                           bool is_coherent) const
{
    const Views views = typed(scene_view, path_view);
    const Paths& paths = views.paths;
    PacketContext context = context_of(views, implementation_->first_triangle, is_coherent, 0);
    context.leaves_records = has_records(views);
    // Rays that have scattered share so little of their way that packets of them are slower: by a
    // tenth on an interior with eight, by 13 % with sixteen.
    if (!is_coherent) return intersect_singly(implementation_->top, context, views, count);
    const int n = paths.capacity;
    int rays = 0;
    for (int first = 0; first < count; first += width) {
        alignas(64) int valid[width];
        alignas(64) RayHits packet;
        for (int k = 0; k < width; ++k) {
            const int i = first + k;
            const bool is_alive = i < count && paths.depth[i] >= 0 && is_waiting(paths, i);
            valid[k] = is_alive ? -1 : 0;
            rays += is_alive ? 1 : 0;
            packet.ray.org_x[k] = paths.ray_origin[i];
            packet.ray.org_y[k] = paths.ray_origin[n + i];
            packet.ray.org_z[k] = paths.ray_origin[2 * n + i];
            packet.ray.dir_x[k] = paths.ray_direction[i];
            packet.ray.dir_y[k] = paths.ray_direction[n + i];
            packet.ray.dir_z[k] = paths.ray_direction[2 * n + i];
            packet.ray.tnear[k] = begin_lane(context, paths, k, i, is_alive);
            packet.ray.tfar[k] = far_away;
            packet.ray.time[k] = 0.0f;
            packet.ray.mask[k] = ~0u;
            packet.ray.id[k] = unsigned(k);
            packet.ray.flags[k] = 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        embree::intersect(valid, implementation_->top, context.query, packet);
        for (int k = 0; k < width; ++k) {
            const int i = first + k;
            if (valid[k] == 0 && paths.lookup != LOOKUP_SURFACE) continue;
            const bool is_hit = valid[k] != 0 && packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
            const int instance = is_hit ? instance_of(packet.hit.instID[0][k]) : 0;
            paths.hit_instance[i] = instance;
            paths.hit_triangle[i] =
                is_hit ? context.first_triangle[instance] + int(packet.hit.primID[k]) : -1;
            if (context.leaves_records)
                leave_record(views, i, instance, paths.hit_triangle[i], packet.ray.tfar[k]);
        }
    }
    return rays;
}

// The nearest surface on the way of each shadow ray in the list about which a texture has to be
// asked; nothing else is left that could stop it.
void EmbreeScene::find_asked(const SceneView& scene_view, const PathView& path_view,
                             const int* list, int count) const
{
    const Views views = typed(scene_view, path_view);
    const Paths& paths = views.paths;
    PacketContext context = context_of(views, implementation_->first_triangle, false, 1);
    context.leaves_records = context.seeks_asked = true;
    const int n = paths.capacity;
    for (int k = 0; k < count; ++k) {
        const int i = list[k];
        const float nearest = begin_lane(context, paths, 0, i, true);
        RTCRayHit query = query_of(paths.shadow_origin, paths.shadow_direction, n, i, nearest,
                                   paths.shadow_distance[i]);
        embree::intersect(implementation_->top, context.query, query);
        const bool is_hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        const int instance = is_hit ? instance_of(query.hit.instID[0]) : 0;
        const int triangle = is_hit ? context.first_triangle[instance] + int(query.hit.primID) : -1;
        paths.is_occluded[i] = is_hit ? 1 : 0;
        leave_record(views, i, instance, triangle, query.ray.tfar);
    }
}

int EmbreeScene::occlusion(const SceneView& scene_view, const PathView& path_view, int count) const
{
    const Views views = typed(scene_view, path_view);
    const Paths& paths = views.paths;
    PacketContext context = context_of(views, implementation_->first_triangle, false, 1);
    context.leaves_records = has_records(views);
    std::vector<int> asked;
    if (context.leaves_records && paths.lookup != LOOKUP_SURFACE) {
        for (int i = 0; i < count; ++i)
            if (is_waiting(paths, i)) asked.push_back(i);
        find_asked(scene_view, path_view, asked.data(), int(asked.size()));
        return int(asked.size());
    }
    if (context.leaves_records) std::fill_n(paths.record_triangle, count, -1);
    const int n = paths.capacity;
    int rays = 0;
    int i = 0;
    while (i < count) {
        alignas(64) int valid[width] = {};
        alignas(64) Rays packet;
        int lanes = 0;
        for (; i < count && lanes < width; ++i) {
            const bool is_lit = paths.light_contribution[i] > 0.0f ||
                                paths.light_contribution[n + i] > 0.0f ||
                                paths.light_contribution[2 * n + i] > 0.0f;
            if (!is_lit) continue;
            valid[lanes] = -1;
            context.path[lanes] = i;
            context.has_asked[lanes] = false;
            packet.org_x[lanes] = paths.shadow_origin[i];
            packet.org_y[lanes] = paths.shadow_origin[n + i];
            packet.org_z[lanes] = paths.shadow_origin[2 * n + i];
            packet.dir_x[lanes] = paths.shadow_direction[i];
            packet.dir_y[lanes] = paths.shadow_direction[n + i];
            packet.dir_z[lanes] = paths.shadow_direction[2 * n + i];
            packet.tnear[lanes] = 0.0f;
            packet.tfar[lanes] = paths.shadow_distance[i];
            packet.time[lanes] = 0.0f;
            packet.mask[lanes] = ~0u;
            packet.id[lanes] = unsigned(lanes);
            packet.flags[lanes] = 0;
            ++lanes;
        }
        if (lanes == 0) break;
        embree::occlude(valid, implementation_->top, context.query, packet);
        for (int k = 0; k < lanes; ++k) {
            const bool is_occluded = packet.tfar[k] < 0.0f;
            paths.is_occluded[context.path[k]] = is_occluded ? 1 : 0;
            if (context.leaves_records && !is_occluded && context.has_asked[k])
                asked.push_back(context.path[k]);
        }
        rays += lanes;
    }
    if (context.leaves_records) find_asked(scene_view, path_view, asked.data(), int(asked.size()));
    return rays;
}

void EmbreeScene::occlusion_of_neighbours(const SceneView& scene_view, const PathView& path_view,
                                          int count) const
{
    const Views views = typed(scene_view, path_view);
    const Paths& paths = views.paths;
    PacketContext context = context_of(views, implementation_->first_triangle, false, 1);
    alignas(64) int valid[width];
    alignas(64) Rays packet;
    for (int k = 0; k < width; ++k) {
        packet.tnear[k] = 0.0f;
        packet.time[k] = 0.0f;
        packet.mask[k] = ~0u;
        packet.id[k] = unsigned(k);
        packet.flags[k] = 0;
    }
    const int n = paths.capacity;
    for (int first = 0; first < count; first += width) {
        // as vectors: Embree reads them as such, and would wait for single stores
        const auto copy = [first](float(&to)[width], const float* plane) {
            std::memcpy(to, plane + first, sizeof to);
        };
        copy(packet.org_x, paths.shadow_origin);
        copy(packet.org_y, paths.shadow_origin + n);
        copy(packet.org_z, paths.shadow_origin + 2 * n);
        copy(packet.dir_x, paths.shadow_direction);
        copy(packet.dir_y, paths.shadow_direction + n);
        copy(packet.dir_z, paths.shadow_direction + 2 * n);
        copy(packet.tfar, paths.shadow_distance);
        for (int k = 0; k < width; ++k) {
            context.path[k] = first + k;
            valid[k] = first + k < count ? -1 : 0;
        }
        embree::occlude(valid, implementation_->top, context.query, packet);
        for (int k = 0; k < width; ++k)
            paths.is_occluded[first + k] = packet.tfar[k] < 0.0f ? 1 : 0;
    }
}

}  // namespace diptych
