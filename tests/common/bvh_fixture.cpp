#include "tests/common/bvh_fixture.hpp"

#include "kernels_cpu/embree.hpp"

#include <cmath>
#include <random>

using diptych::SceneData;

namespace {

std::uniform_real_distribution<float> uniform(0.0f, 1.0f);

float3 in_cube(std::mt19937& random, float offset)
{
    const float x = offset + uniform(random);
    const float y = offset + uniform(random);
    return {x, y, offset + uniform(random)};
}

float3 unit(float3 v) { return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

float3 unit_direction(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    const float x = normal(random);
    const float y = normal(random);
    return unit({x, y, normal(random)});
}

void add_triangle(SceneData& scene, float3 a, float3 b, float3 c)
{
    const int first = int(scene.positions.size());
    for (const float3& p : {a, b, c}) scene.positions.push_back({p.x, p.y, p.z, 0});
    scene.triangles.push_back({first, first + 1, first + 2, 0});
    if (scene.instances.empty()) {
        Instance instance = {};
        instance.to_world_x = instance.to_object_x = {1, 0, 0, 0};
        instance.to_world_y = instance.to_object_y = {0, 1, 0, 0};
        instance.to_world_z = instance.to_object_z = {0, 0, 1, 0};
        scene.instances.push_back(instance);
    }
    scene.instances[0].triangle_count = int(scene.triangles.size());
}

void add_box(SceneData& scene, float3 low, float3 high)
{
    const auto corner = [&](int k) {
        return make_float3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
    };
    const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& f : faces) {
        add_triangle(scene, corner(f[0]), corner(f[1]), corner(f[2]));
        add_triangle(scene, corner(f[0]), corner(f[2]), corner(f[3]));
    }
}

float3 sheet_point(int x, int y, int cells, float size)
{
    const float u = float(x) / float(cells);
    const float v = float(y) / float(cells);
    return {size * u, size * v, size * 0.02f * std::sin(20 * u) * std::cos(17 * v)};
}

float4 row(float3 v, float w) { return {v.x, v.y, v.z, w}; }

}  // namespace

SceneData soup(int count, float size, float offset)
{
    std::mt19937 random(101);
    SceneData scene;
    for (int k = 0; k < count; ++k) {
        const float3 p = in_cube(random, offset);
        const float3 a = unit_direction(random) * size;
        add_triangle(scene, p, p + a, p + unit_direction(random) * size);
    }
    return scene;
}

SceneData boxes(int count)
{
    std::mt19937 random(102);
    SceneData scene;
    for (int k = 0; k < count; ++k) {
        const float3 low = in_cube(random, 0);
        const float scale = count == 1 ? 1.0f : 0.1f;
        add_box(scene, low, low + in_cube(random, 0.1f) * scale);
    }
    return scene;
}

SceneData sheet(int cells, float size)
{
    SceneData scene;
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const float3 a = sheet_point(x, y, cells, size);
            const float3 c = sheet_point(x + 1, y + 1, cells, size);
            add_triangle(scene, a, sheet_point(x + 1, y, cells, size), c);
            add_triangle(scene, a, c, sheet_point(x, y + 1, cells, size));
        }
    return scene;
}

SceneData pile(int count)
{
    SceneData scene;
    for (int k = 0; k < count; ++k) add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 1});
    return scene;
}

SceneData spiral(int count)
{
    SceneData scene;
    float size = 1e-15f;
    for (int k = 0; k < count; ++k) {
        const float3 p = make_float3(std::cos(float(k)), std::sin(float(k)), 1.0f) * size;
        add_triangle(scene, p, p * 1.01f, make_float3(p.x, p.y, p.z * 1.01f));
        size *= 1.02f;
    }
    return scene;
}

void add_instances(SceneData& scene, int count)
{
    std::mt19937 random(103);
    const int triangles = scene.instances[0].triangle_count;
    scene.instances[0].triangle_count = 0;
    scene.effects |= EFFECT_INSTANCES;
    for (int k = 0; k < count; ++k) {
        const float3 z = unit_direction(random);
        const float3 x = unit(make_float3(z.y, -z.x, 0.0f));
        const float3 y = {z.y * x.z - z.z * x.y, z.z * x.x - z.x * x.z, z.x * x.y - z.y * x.x};
        const float scale = 0.05f + 0.3f * uniform(random);
        const float3 at = in_cube(random, 0);
        const auto back = [&](float3 v) {
            return row(v / scale, -(v.x * at.x + v.y * at.y + v.z * at.z) / scale);
        };
        Instance instance = {};
        instance.triangle_count = triangles;
        instance.to_object_x = back(x);
        instance.to_object_y = back(y);
        instance.to_object_z = back(z);
        instance.to_world_x = row(make_float3(x.x, y.x, z.x) * scale, at.x);
        instance.to_world_y = row(make_float3(x.y, y.y, z.y) * scale, at.y);
        instance.to_world_z = row(make_float3(x.z, y.z, z.z) * scale, at.z);
        scene.instances.push_back(instance);
    }
}

std::vector<TestRay> random_rays(int count, float offset, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<TestRay> rays;
    for (int k = 0; k < count; ++k) {
        const float3 from = in_cube(random, offset);
        const float3 centre = make_float3(offset + 0.5f, offset + 0.5f, offset + 0.5f);
        const float3 origin = centre + (from - centre) * (k % 2 ? 1.0f : 4.0f);
        const float3 to = in_cube(random, offset);
        rays.push_back({origin, unit(to - origin)});
    }
    return rays;
}

std::vector<TestRay> axis_rays(int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<TestRay> rays;
    for (int k = 0; k < count; ++k) {
        const float sign = k & 1 ? 1.0f : -1.0f;
        const int axis = (k / 2) % 3;
        const float3 direction = {axis == 0 ? sign : 0.0f * sign, axis == 1 ? sign : -0.0f,
                                  axis == 2 ? sign : 0.0f};
        rays.push_back({in_cube(random, 0) - direction, direction});
    }
    return rays;
}

std::vector<TestRay> grazing_rays(int count, float size, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<TestRay> rays;
    for (int k = 0; k < count; ++k) {
        const float3 p = in_cube(random, 0);
        const float3 origin = make_float3(p.x - 1.0f, p.y, 0.05f * (p.z - 0.5f)) * size;
        const float3 d = in_cube(random, 0);
        rays.push_back({origin, unit(make_float3(1.0f, d.y - 0.5f, 0.02f * (d.z - 0.5f)))});
    }
    return rays;
}

float3 box_centre(const SceneData& box)
{
    double sum[3] = {};
    for (const float4& p : box.positions) {
        sum[0] += p.x;
        sum[1] += p.y;
        sum[2] += p.z;
    }
    const double n = double(box.positions.size());
    return {float(sum[0] / n), float(sum[1] / n), float(sum[2] / n)};
}

// From around the centre at points between two corners of a triangle: edges, diagonals, corners.
std::vector<TestRay> edge_rays(const SceneData& box, int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<TestRay> rays;
    for (int k = 0; k < count; ++k) {
        const Triangle& t = box.triangles[size_t(k) % box.triangles.size()];
        const float3 a = xyz(box.positions[size_t(t.vertex0)]);
        const float3 b = xyz(box.positions[size_t(k % 2 ? t.vertex1 : t.vertex2)]);
        const float along = k % 7 == 0 ? 0.0f : uniform(random);
        const float3 jitter = (in_cube(random, 0) - make_float3(0.5f, 0.5f, 0.5f)) * 0.05f;
        const float3 origin = box_centre(box) + jitter;
        rays.push_back({origin, unit(a + (b - a) * along - origin)});
    }
    return rays;
}

Scene view_of(const SceneData& scene)
{
    Scene view = {};
    view.effects = scene.effects;
#define VIEW_FIELD(type, name) view.name = scene.name.data();
    SCENE_BUFFERS(VIEW_FIELD)
#undef VIEW_FIELD
    return view;
}

Hit closest_of_all(const SceneData& scene, const TestRay& ray)
{
    const TriangleRay prepared = triangle_ray(ray.origin, ray.direction);
    Hit best = {FLOAT_MAX, -1, -1};
    for (int id = 0; id < int(scene.triangles.size()); ++id) {
        const Triangle& t = scene.triangles[size_t(id)];
        const TriangleHit at = triangle_intersect(prepared, xyz(scene.positions[size_t(t.vertex0)]),
                                                  xyz(scene.positions[size_t(t.vertex1)]),
                                                  xyz(scene.positions[size_t(t.vertex2)]), best.t);
        if (at.is_hit && (best.triangle < 0 || at.t < best.t)) best = {at.t, id, 0};
    }
    return best;
}

int depth_of(const SceneData& scene, int node)
{
    int deepest = 0;
    for (const int child : scene.bvh_nodes[size_t(node)].child)
        if (child >= 0) deepest = std::max(deepest, depth_of(scene, child));
    return deepest + 1;
}

EmbreeScene::EmbreeScene(const SceneData& scene)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_))
{
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const Instance& instance : scene.instances) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t count = size_t(instance.triangle_count);
        auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * count));
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
        for (size_t k = 0; k < 3 * count; ++k) {
            const Triangle& t = scene.triangles[size_t(instance.first_triangle) + k / 3];
            const int vertex[3] = {t.vertex0, t.vertex1, t.vertex2};
            const float4& p = scene.positions[size_t(vertex[k % 3])];
            const float4 rows[3] = {instance.to_world_x, instance.to_world_y, instance.to_world_z};
            for (size_t axis = 0; axis < 3; ++axis) {
                const float4& r = rows[axis];
                corners[3 * k + axis] = r.x * p.x + r.y * p.y + r.z * p.z + r.w;
            }
            indices[k] = unsigned(k);
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene()
{
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

Hit EmbreeScene::closest(const TestRay& ray) const
{
    RTCRayHit query = {};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tfar = FLOAT_MAX;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    diptych::embree::Query context = diptych::embree::begin_query(false);
    diptych::embree::intersect(scene_, context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {FLOAT_MAX, -1, -1};
    return {query.ray.tfar, int(query.hit.primID), int(query.hit.geomID)};
}
