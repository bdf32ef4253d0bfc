#include "backends/bvh_build.hpp"

#include "backends/bvh_embree.hpp"
#include "backends/bvh_flatten.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace diptych {
namespace {

Box mesh_bounds(const SceneData& scene, int first, int count)
{
    Box box;
    for (int id = first; id < first + count; ++id) box.add(triangle_box(scene, id));
    return box;
}

// The box of an instance in world space, with room for the rounding of the transformation.
Box world_bounds(const Instance& instance, const Box& mesh)
{
    Box box;
    for (int corner = 0; corner < 8; ++corner) {
        const float x = (corner & 1 ? mesh.high : mesh.low)[0];
        const float y = (corner & 2 ? mesh.high : mesh.low)[1];
        const float z = (corner & 4 ? mesh.high : mesh.low)[2];
        const auto along = [&](float4 row) { return row.x * x + row.y * y + row.z * z + row.w; };
        box.add_point(
            {along(instance.to_world_x), along(instance.to_world_y), along(instance.to_world_z)});
    }
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.low[axis]), std::abs(box.high[axis])});
    box.grow(largest * BVH_PADDING);
    return box;
}

bool is_invertible(const Instance& instance)
{
    for (const float4& row : {instance.to_object_x, instance.to_object_y, instance.to_object_z})
        if (!std::isfinite(row.x + row.y + row.z + row.w)) return false;
    return true;
}

using Mesh = std::pair<int, int>;  // first triangle, number of triangles

// Roots of the meshes, by mesh.
std::map<Mesh, int> build_meshes(SceneData& scene, BvhBuilder& builder, BvhFlattener& flattener)
{
    std::map<Mesh, int> roots;
    for (const Instance& instance : scene.instances) {
        const Mesh mesh{instance.first_triangle, instance.triangle_count};
        if (roots.contains(mesh)) continue;
        std::vector<BuildItem> items;
        items.reserve(mesh.second);
        for (int id = mesh.first; id < mesh.first + mesh.second; ++id)
            items.push_back({triangle_box(scene, id), id});
        roots[mesh] = flattener.add(builder.build(items, BVH_MESH_LEAF), BVH_MESH_DEPTH);
    }
    return roots;
}

void build_top_level(const SceneData& scene, BvhBuilder& builder, BvhFlattener& flattener)
{
    std::map<Mesh, Box> boxes;
    std::vector<BuildItem> items;
    for (int id = 0; id < int(scene.instances.size()); ++id) {
        const Instance& instance = scene.instances[id];
        if (instance.triangle_count == 0 || !is_invertible(instance)) continue;
        const Mesh mesh{instance.first_triangle, instance.triangle_count};
        if (!boxes.contains(mesh)) boxes[mesh] = mesh_bounds(scene, mesh.first, mesh.second);
        items.push_back({world_bounds(instance, boxes[mesh]), id});
    }
    flattener.add(builder.build(items, 1), BVH_TOP_DEPTH);
}

Instance identity_instance()
{
    Instance instance = {};
    instance.to_world_x = instance.to_object_x = {1, 0, 0, 0};
    instance.to_world_y = instance.to_object_y = {0, 1, 0, 0};
    instance.to_world_z = instance.to_object_z = {0, 0, 1, 0};
    return instance;
}

void check_limits(const SceneData& scene)
{
    const size_t most_items = size_t{1} << 28;  // what BVH_LEAF can address
    if (scene.triangles.size() > most_items)
        throw std::runtime_error("scene: " + std::to_string(scene.triangles.size()) +
                                 " triangles; at most 268435456 are supported");
    if (scene.instances.size() > size_t{1} << BVH_TOP_DEPTH)
        throw std::runtime_error("scene: " + std::to_string(scene.instances.size()) +
                                 " instances; at most 16777216 are supported");
}

}  // namespace

void build_bvh(SceneData& scene)
{
    check_limits(scene);
    if (scene.instances.empty()) scene.instances.push_back(identity_instance());
    scene.bvh_nodes.clear();
    scene.bvh_items.clear();
    BvhBuilder builder;
    BvhFlattener flattener(scene.bvh_nodes, scene.bvh_items);
    if (scene.effects & EFFECT_INSTANCES) build_top_level(scene, builder, flattener);
    const std::map<Mesh, int> roots = build_meshes(scene, builder, flattener);
    for (Instance& instance : scene.instances)
        instance.root_node = roots.at({instance.first_triangle, instance.triangle_count});
}

}  // namespace diptych
