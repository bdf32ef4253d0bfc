#include "host/scene/scene_assembly.hpp"

#include "host/scene/environment.hpp"
#include "host/scene/tangents.hpp"

#include "common/textures/procedural.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

constexpr size_t index_limit = std::numeric_limits<int>::max();

// Twice the area of a triangle relative to the square of its longest edge, below which rounding of
// its corners alone decides which way it faces.
constexpr double thinnest_triangle = 1e-12;

bool is_finite(const float3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Vec3 to_vec(const float3& v) { return {v.x, v.y, v.z}; }
Vec3 to_vec(const float4& v) { return {v.x, v.y, v.z}; }
float3 to_float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }
float4 to_float4(const Vec3& v, double w = 0)
{
    return {float(v[0]), float(v[1]), float(v[2]), float(w)};
}
void set_rows(const Transform& t, float4& x, float4& y, float4& z)
{
    const auto row = [&](size_t i) -> float4 {
        const auto& r = t.row[i];
        return {float(r[0]), float(r[1]), float(r[2]), float(r[3])};
    };
    x = row(0), y = row(1), z = row(2);
}

Instance placed_instance(const Transform& to_world, const Transform& to_object)
{
    Instance instance{};
    set_rows(to_world, instance.to_world_x, instance.to_world_y, instance.to_world_z);
    set_rows(to_object, instance.to_object_x, instance.to_object_y, instance.to_object_z);
    instance.is_mirrored = to_world.determinant() < 0;
    return instance;
}

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 e1 = b - a, e2 = c - a, e3 = c - b;
    const double longest = std::max({dot(e1, e1), dot(e2, e2), dot(e3, e3)});
    return !(length(cross(e1, e2)) > thinnest_triangle * longest);
}

// Every corner its own vertex.
void unweld(MeshPart& part)
{
    const auto spread = [&](auto& values) {
        if (values.empty()) {
            return;
        }
        std::remove_reference_t<decltype(values)> spread_values;
        spread_values.reserve(part.indices.size());
        for (const uint v : part.indices) {
            spread_values.push_back(values[v]);
        }
        values = std::move(spread_values);
    };
    spread(part.positions);
    spread(part.normals);
    spread(part.colors);
    for (auto& set : part.uvs) {
        spread(set);
    }
    for (size_t i = 0; i < part.indices.size(); ++i) {
        part.indices[i] = uint(i);
    }
}

float3 face_normal(const MeshPart& part, size_t triangle)
{
    const uint* v = &part.indices[3 * triangle];
    const Vec3 a = to_vec(part.positions[v[0]]);
    return to_float3(
        unit(cross(to_vec(part.positions[v[1]]) - a, to_vec(part.positions[v[2]]) - a)));
}

// Replaces normals that have no direction by that of a face at the vertex.
size_t repair_normals(MeshPart& part)
{
    const auto is_good = [](const float3& n) { return is_finite(n) && length(to_vec(n)) > 0; };
    size_t repaired = 0;
    for (size_t i = 0; i < part.indices.size(); ++i) {
        float3& n = part.normals[part.indices[i]];
        if (is_good(n)) {
            continue;
        }
        n = face_normal(part, i / 3);
        if (!is_good(n)) {
            n = {0, 0, 1};
        }
        ++repaired;
    }
    for (float3& n : part.normals) {  // of vertices that no triangle uses
        if (!is_good(n)) {
            n = {0, 0, 1};
        }
    }
    return repaired;
}

uint packed_tangent(const float4& tangent, const Transform& to_world, bool is_mirrored)
{
    const float3 t = to_float3(unit(to_world.vector(to_vec(tangent))));
    const bool is_left = (tangent.w < 0) != is_mirrored;
    return (normal_pack(t) & ~1u) | (is_left ? 1u : 0u);
}

}  // namespace

SceneData SceneAssembly::run()
{
    if (builder_.width_ < 1 || builder_.height_ < 1) {
        throw SceneError(fmt::format("picture: {} x {} pixels; both must be 1 or more",
                                     builder_.width_, builder_.height_));
    }
    data_.settings.resize(1, Settings{});
    data_.notices = std::move(builder_.notices_);
    data_.settings[0].width = builder_.width_;
    data_.settings[0].height = builder_.height_;
    data_.settings[0].max_bounces = 64;
    data_.settings[0].filter = FILTER_BLACKMAN_HARRIS;
    data_.settings[0].environment_light = -1;
    survey_placements();
    survey_materials();
    survey_textures();
    assemble_images();
    assemble_materials();
    assemble_geometry();
    assemble_bounds();
    assemble_camera();
    if (builder_.environment_) {
        const auto& [map, rotation, scale] = *builder_.environment_;
        environment_power_ = assemble_environment(map, rotation, scale, data_);
    }
    assemble_effects();
    assemble_textures();
    estimate_emitters();
    assemble_lights();
    tell_what_was_repaired();
    return std::move(data_);
}

const TextureUse* SceneAssembly::normal_texture(const MeshPart& part) const
{
    const MaterialInput& material = builder_.materials_[size_t(part.material)];
    const TextureUse& use = material.normal_texture;
    return (use.image >= 0 || use.node >= 0) && !material.is_unlit ? &use : nullptr;
}

// Whether a mesh's vertices are kept in world space.
bool SceneAssembly::is_merged(const SceneBuilder::Placement& placement) const
{
    return placement_counts_[size_t(placement.mesh)] == 1;
}

void SceneAssembly::tell_what_was_repaired()
{
    const auto tell = [&](size_t count, const char* what) {
        if (count > 0) {
            data_.notices.push_back(fmt::format("meshes: {} {}", count, what));
        }
    };
    tell(data_.degenerate_triangles, "triangles without area dropped");
    tell(repaired_normals_, "normals without a direction replaced by the faces'");
    tell(repaired_uvs_, "texture coordinates that are not finite taken as (0, 0)");
}

// Counts the placements of each mesh, leaving out those that flatten it to nothing.
void SceneAssembly::survey_placements()
{
    auto& placements = builder_.placements_;
    std::erase_if(placements, [&](const SceneBuilder::Placement& placement) {
        const Transform back = inverse(placement.to_world);
        if (placement.to_world.determinant() != 0 && back.is_finite()) {
            return false;
        }
        for (const MeshPart& part : builder_.meshes_[size_t(placement.mesh)].parts) {
            data_.degenerate_triangles +=
                (part.indices.empty() ? part.positions.size() : part.indices.size()) / 3;
        }
        return true;
    });
    placement_counts_.assign(builder_.meshes_.size(), 0);
    for (const auto& placement : placements) {
        ++placement_counts_[size_t(placement.mesh)];
    }
}

// Which materials are used, and what of the meshes they need.
void SceneAssembly::survey_materials()
{
    for (size_t m = 0; m < builder_.meshes_.size(); ++m) {
        for (MeshPart& part : builder_.meshes_[m].parts) {
            if (part.material >= 0 || placement_counts_[m] == 0) {
                continue;
            }
            if (builder_.materials_.empty() ||
                builder_.materials_.back().name != default_material_name) {
                builder_.add_material({.name = default_material_name, .metallic = 1});
            }
            part.material = int(builder_.materials_.size()) - 1;
        }
    }
    material_used_.assign(builder_.materials_.size(), 0);
    material_colored_.assign(builder_.materials_.size(), 0);
    for (size_t m = 0; m < builder_.meshes_.size(); ++m) {
        for (const MeshPart& part : builder_.meshes_[m].parts) {
            if (placement_counts_[m] == 0 || part.positions.empty()) {
                continue;
            }
            if (size_t(part.material) >= builder_.materials_.size()) {
                throw SceneError(fmt::format("mesh {}: there is no material {}; name one that "
                                             "was added",
                                             builder_.meshes_[m].name, part.material));
            }
            material_used_[size_t(part.material)] = 1;
            if (!part.colors.empty()) {
                material_colored_[size_t(part.material)] = 1;
            }
            any_normals_ |= !part.normals.empty();
            any_colors_ |= !part.colors.empty();
            any_normal_map_ |= normal_texture(part) != nullptr;
        }
    }
}

void SceneAssembly::check_part(const std::string& where, const MeshPart& part) const
{
    const size_t count = part.positions.size();
    for (size_t v = 0; v < count; ++v) {
        if (!is_finite(part.positions[v])) {
            throw SceneError(fmt::format(
                "{}: the position of vertex {} is not finite; correct the mesh", where, v));
        }
    }
    for (size_t i = 0; i < part.indices.size(); ++i) {
        if (part.indices[i] >= count) {
            throw SceneError(fmt::format("{}: index {} names vertex {} of {}; correct the mesh",
                                         where, i, part.indices[i], count));
        }
    }
    const auto fits = [&](size_t size) { return size == 0 || size == count; };
    bool all_fit =
        fits(part.normals.size()) && fits(part.colors.size()) && fits(part.tangents.size());
    for (const auto& set : part.uvs) {
        all_fit = all_fit && fits(set.size());
    }
    if (!all_fit) {
        throw SceneError(fmt::format("{}: its attributes have different numbers of vertices; give "
                                     "every attribute {}",
                                     where, count));
    }
}

// Indices for all, sound normals and, where a normal map asks for them, tangents.
void SceneAssembly::prepare_part(const std::string& where, MeshPart& part)
{
    check_part(where, part);
    if (part.indices.empty()) {
        part.indices.resize(part.positions.size());
        for (size_t i = 0; i < part.indices.size(); ++i) {
            part.indices[i] = uint(i);
        }
    }
    part.indices.resize(part.indices.size() / 3 * 3);
    if (!part.normals.empty()) {
        repaired_normals_ += repair_normals(part);
    }
    const TextureUse plain;
    const TextureUse* map = normal_texture(part);
    if (!map && any_tangents_) map = &plain;
    const auto is_bad = [](const float4& t) {
        return !is_finite(xyz(t)) || length(to_vec(t)) == 0;
    };
    if (std::ranges::any_of(part.tangents, is_bad)) {
        part.tangents.clear();
    }
    if (!map || (!part.tangents.empty() && !part.normals.empty())) {
        return;
    }

    const bool is_flat = part.normals.empty();
    if (is_flat) {
        part.tangents.clear();  // the specification: ignored without normals
        unweld(part);
        part.normals.resize(part.positions.size());
        for (size_t i = 0; i < part.indices.size(); ++i) {
            part.normals[i] = face_normal(part, i / 3);
        }
    }
    derive_tangents(part, *map);
    if (is_flat) {
        part.normals.clear();
    }
}

void SceneAssembly::reserve_geometry()
{
    size_t vertices = 0, triangles = 0;
    for (size_t m = 0; m < builder_.meshes_.size(); ++m) {
        if (placement_counts_[m] == 0) {
            continue;
        }
        for (const MeshPart& part : builder_.meshes_[m].parts) {
            vertices += part.positions.size();
            triangles += part.indices.size() / 3;
        }
    }
    if (vertices * size_t(std::max(uv_set_count_, 1)) > index_limit || triangles > index_limit) {
        throw SceneError(fmt::format("the scene: {} vertices and {} triangles are more than 32-bit "
                                     "indices reach; split the scene",
                                     vertices, triangles));
    }
    data_.positions.reserve(vertices);
    data_.triangles.reserve(triangles);
    data_.uvs.reserve(vertices * size_t(uv_set_count_));
    if (any_normals_) {
        data_.normals.reserve(vertices);
    }
    if (any_normal_map_ || any_tangents_) {
        data_.tangents.reserve(vertices);
    }
    if (any_colors_) {
        data_.colors.reserve(vertices);
    }
}

void SceneAssembly::append_vertices(const MeshPart& part, const Transform& to_world)
{
    const bool is_identity = to_world.is_identity();
    const bool is_mirrored = to_world.determinant() < 0;
    const Transform to_object = is_identity ? Transform{} : inverse(to_world);
    for (size_t v = 0; v < part.positions.size(); ++v) {
        const float4 p = to_float4(to_world.point(to_vec(part.positions[v])));
        if (!is_finite(xyz(p))) {
            throw SceneError("the scene: a vertex lies beyond the range of float in world space; "
                             "correct the node's transform");
        }
        data_.positions.push_back(p);
        if (any_normals_) {
            data_.normals.push_back(part.normals.empty()
                                        ? NORMAL_FLAT
                                        : normal_pack(to_float3(unit(to_object.transposed_vector(
                                              to_vec(part.normals[v]))))));
        }
        if (any_normal_map_ || any_tangents_) {
            data_.tangents.push_back(part.tangents.empty()
                                         ? 0
                                         : packed_tangent(part.tangents[v], to_world, is_mirrored));
        }
        if (any_colors_) {
            data_.colors.push_back(part.colors.empty() ? float4{1, 1, 1, 1} : part.colors[v]);
        }
    }
    const size_t first_uv = data_.uvs.size(), stride = size_t(uv_set_count_);
    data_.uvs.resize(first_uv + part.positions.size() * stride, float2{0, 0});
    for (size_t set = 0; set < part.uvs.size() && set < uv_slots_.size(); ++set) {
        if (uv_slots_[set] < 0) {
            continue;
        }
        for (size_t v = 0; v < part.uvs[set].size(); ++v) {
            float2 uv = part.uvs[set][v];
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
                uv = {0, 0};
                ++repaired_uvs_;
            }
            data_.uvs[first_uv + v * stride + size_t(uv_slots_[set])] = uv;
        }
    }
}

void SceneAssembly::append_triangles(const MeshPart& part, int first_vertex, bool is_mirrored)
{
    for (size_t i = 0; i < part.indices.size(); i += 3) {
        Triangle t{first_vertex + int(part.indices[i]), first_vertex + int(part.indices[i + 1]),
                   first_vertex + int(part.indices[i + 2]), part.material};
        if (is_mirrored) {
            std::swap(t.vertex1, t.vertex2);
        }
        if (is_degenerate(to_vec(data_.positions[size_t(t.vertex0)]),
                          to_vec(data_.positions[size_t(t.vertex1)]),
                          to_vec(data_.positions[size_t(t.vertex2)]))) {
            ++data_.degenerate_triangles;
        } else {
            data_.triangles.push_back(t);
        }
    }
}

// Appends a mesh in the space that `to_world` leads to, and lets go of it: placed once, it will not
// be asked for again, and instances share what was appended.
void SceneAssembly::append_mesh(SceneBuilder::Mesh& mesh, const Transform& to_world)
{
    for (MeshPart& part : mesh.parts) {
        const int first_vertex = int(data_.positions.size());
        append_vertices(part, to_world);
        append_triangles(part, first_vertex, to_world.determinant() < 0);
        part = MeshPart{};
    }
}

void SceneAssembly::assemble_geometry()
{
    for (size_t m = 0; m < builder_.meshes_.size(); ++m) {
        auto& mesh = builder_.meshes_[m];
        if (placement_counts_[m] == 0) {
            mesh.parts.clear();
            continue;
        }
        for (size_t p = 0; p < mesh.parts.size(); ++p) {
            prepare_part(fmt::format("mesh {}, part {}",
                                     mesh.name.empty() ? std::to_string(m) : mesh.name, p),
                         mesh.parts[p]);
        }
    }
    reserve_geometry();

    Instance world = placed_instance({}, {});
    int object = 0;
    for (const auto& placement : builder_.placements_) {
        if (is_merged(placement)) {
            append_mesh(builder_.meshes_[size_t(placement.mesh)], placement.to_world);
            data_.triangle_objects.resize(data_.triangles.size(), object);
        }
        ++object;
    }
    world.triangle_count = int(data_.triangles.size());
    data_.instances.push_back(world);
    data_.instance_names.push_back("world");

    std::vector<int> first_triangle(builder_.meshes_.size(), -1);
    std::vector<int> triangle_count(builder_.meshes_.size(), 0);
    object = -1;
    for (const auto& placement : builder_.placements_) {
        const size_t m = size_t(placement.mesh);
        ++object;
        if (is_merged(placement)) {
            continue;
        }
        if (first_triangle[m] < 0) {
            first_triangle[m] = int(data_.triangles.size());
            append_mesh(builder_.meshes_[m], {});
            triangle_count[m] = int(data_.triangles.size()) - first_triangle[m];
        }
        if (triangle_count[m] == 0) {
            continue;
        }
        Instance instance = placed_instance(placement.to_world, inverse(placement.to_world));
        instance.first_triangle = first_triangle[m];
        instance.triangle_count = triangle_count[m];
        instance.object = object;
        data_.instances.push_back(instance);
        data_.instance_names.push_back(placement.name);
    }
}

}  // namespace diptych
