#include "tests/bench/bare_embree.hpp"

#include "kernels_cpu/embree.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace diptych {
namespace {

using embree::RayHits;
using embree::Rays;
using embree::width;

void fill(Rays& packet, const BareRays& rays, int first)
{
    const int n = rays.stride;
    for (int k = 0; k < width; ++k) {
        const int i = first + k;
        packet.org_x[k] = rays.origin[i];
        packet.org_y[k] = rays.origin[n + i];
        packet.org_z[k] = rays.origin[2 * n + i];
        packet.dir_x[k] = rays.direction[i];
        packet.dir_y[k] = rays.direction[n + i];
        packet.dir_z[k] = rays.direction[2 * n + i];
        packet.tnear[k] = 0.0f;
        packet.tfar[k] = rays.distance ? rays.distance[i] : std::numeric_limits<float>::infinity();
        packet.time[k] = 0.0f;
        packet.mask[k] = ~0u;
        packet.id[k] = unsigned(k);
        packet.flags[k] = 0;
    }
}

void set_valid(int (&valid)[width], int rest)
{
    for (int k = 0; k < width; ++k) valid[k] = k < rest ? -1 : 0;
}

}  // namespace

struct BareEmbree::Implementation {
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<RTCScene> scenes;
    bool is_robust = false;

    ~Implementation()
    {
        for (RTCScene scene : scenes) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    RTCScene new_scene()
    {
        RTCScene scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        if (is_robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        scenes.push_back(scene);
        return scene;
    }

    static void attach(RTCScene scene, RTCGeometry geometry)
    {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    RTCGeometry triangles_of(const EmbreeMesh& mesh) const
    {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.positions, 0, 16, mesh.vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles, 0, 16, size_t(mesh.triangle_count));
        return geometry;
    }

    RTCGeometry instance_of(RTCScene scene, const EmbreeMesh& mesh) const
    {
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, scene);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, mesh.to_world);
        return instance;
    }
};

BareEmbree::BareEmbree(const std::vector<EmbreeMesh>& meshes, int threads, bool is_robust)
    : implementation_(std::make_unique<Implementation>())
{
    Implementation& self = *implementation_;
    self.is_robust = is_robust;
    self.device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (!self.device) throw std::runtime_error("Embree: cannot start; is the processor x86-64?");
    self.top = self.new_scene();
    int placed = -1;  // first triangle of the mesh in `shared`
    RTCScene shared = nullptr;
    for (const EmbreeMesh& mesh : meshes) {
        if (mesh.triangle_count == 0) continue;
        if (!mesh.to_world) {
            self.attach(self.top, self.triangles_of(mesh));
            continue;
        }
        if (mesh.first_triangle != placed) {
            shared = self.new_scene();
            self.attach(shared, self.triangles_of(mesh));
            rtcCommitScene(shared);
            placed = mesh.first_triangle;
        }
        self.attach(self.top, self.instance_of(shared, mesh));
    }
    rtcCommitScene(self.top);
}

BareEmbree::~BareEmbree() = default;

int BareEmbree::intersect(const BareRays& rays, bool is_coherent) const
{
    embree::Query query = embree::begin_query(is_coherent);
    int hits = 0;
    for (int first = 0; first < rays.count; first += width) {
        alignas(64) int valid[width];
        alignas(64) RayHits packet;
        set_valid(valid, rays.count - first);
        fill(packet.ray, rays, first);
        std::fill_n(packet.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
        embree::intersect(valid, implementation_->top, query, packet);
        for (int k = 0; k < width; ++k)
            hits += valid[k] && packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

int BareEmbree::occlude(const BareRays& rays) const
{
    embree::Query query = embree::begin_query(false);
    int hits = 0;
    for (int first = 0; first < rays.count; first += width) {
        alignas(64) int valid[width];
        alignas(64) Rays packet;
        set_valid(valid, rays.count - first);
        fill(packet, rays, first);
        embree::occlude(valid, implementation_->top, query, packet);
        for (int k = 0; k < width; ++k) hits += valid[k] && packet.tfar[k] < 0.0f;
    }
    return hits;
}

}  // namespace diptych
