// Meshes: every kind of primitive to indexed triangles.
#include "host/scene/gltf_loader.hpp"

#include <cstring>
#include <fmt/format.h>

namespace diptych {
namespace {

// Corners of the triangles of a strip or fan, or of a list, in an order that keeps their front.
std::vector<uint> triangle_corners(const std::vector<uint>& order, int mode)
{
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        return order;
    }
    std::vector<uint> corners;
    if (order.size() < 3) {
        return corners;
    }
    corners.reserve(3 * (order.size() - 2));
    for (size_t k = 0; k + 2 < order.size(); ++k) {
        // The specification's p = { v[k], v[k + 1 + k % 2], v[k + 2 - k % 2] } and
        // p = { v[k + 1], v[k + 2], v[0] }.
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            corners.insert(corners.end(), {order[k], order[k + 1 + k % 2], order[k + 2 - k % 2]});
        } else {
            corners.insert(corners.end(), {order[k + 1], order[k + 2], order[0]});
        }
    }
    return corners;
}

template<typename T>
std::vector<T> as_vectors(const std::vector<float>& values)
{
    static_assert(sizeof(T) % sizeof(float) == 0);
    std::vector<T> result(values.size() * sizeof(float) / sizeof(T));
    std::memcpy(static_cast<void*>(result.data()), values.data(), result.size() * sizeof(T));
    return result;
}

void check_count(size_t count, size_t expected, const std::string& where)
{
    if (count != expected) {
        throw SceneError(fmt::format("{}: {} elements for {} vertices; repair the file", where,
                                     count, expected));
    }
}

}  // namespace

// The set of the primitive, unless it was read before. False where it has none.
bool GltfLoader::read_uv_set(const tinygltf::Primitive& primitive, size_t set,
                             const std::string& where, MeshPart& part)
{
    if (part.uvs.size() <= set) part.uvs.resize(set + 1);
    if (!part.uvs[set].empty()) return true;
    const std::string key = fmt::format("TEXCOORD_{}", set);
    const auto at = primitive.attributes.find(key);
    if (at == primitive.attributes.end()) return false;
    part.uvs[set] =
        as_vectors<float2>(accessor_floats(document_, at->second, 2, 0, where + ", " + key));
    check_count(part.uvs[set].size(), part.positions.size(), where + ", " + key);
    return true;
}

// What the material's images read, and what its textures' nodes may ask for.
void GltfLoader::read_uvs(const tinygltf::Primitive& primitive, const std::string& where,
                          MeshPart& part)
{
    bool may_be_asked = reads_all_uvs_;
    if (primitive.material >= 0) {
        const MaterialInput& m = materials_[size_t(primitive.material)];
        for (const TextureUse* use :
             {&m.base_texture, &m.metallic_roughness_texture, &m.normal_texture,
              &m.emission_texture, &m.specular_texture, &m.specular_color_texture}) {
            may_be_asked |= use->node >= 0;
            if (use->image < 0) {
                continue;
            }
            if (use->uv_set > 7) {
                throw SceneError(fmt::format("{}: its material reads TEXCOORD_{}; sets 0 to 7 can "
                                             "be read",
                                             where, use->uv_set));
            }
            if (!read_uv_set(primitive, size_t(use->uv_set), where, part)) {
                ++missing_uv_sets_;
            }
        }
    }
    for (const size_t set : {size_t(0), size_t(1)}) {
        if (may_be_asked) {
            read_uv_set(primitive, set, where, part);
        }
    }
}

// Linear; values out of 0..1 are cut off, and what is no number counts as 1.
void GltfLoader::read_colors(const tinygltf::Primitive& primitive, const std::string& where,
                             MeshPart& part)
{
    const auto at = primitive.attributes.find("COLOR_0");
    if (at == primitive.attributes.end()) {
        return;
    }
    auto values = accessor_floats(document_, at->second, 4, 1, where + ", COLOR_0");
    for (float& value : values) {
        if (value >= 0 && value <= 1) {
            continue;
        }
        bad_colors_ += std::isfinite(value) ? 0 : 1;
        value = value < 0 ? 0.0f : 1.0f;
    }
    part.colors = as_vectors<float4>(values);
    check_count(part.colors.size(), part.positions.size(), where + ", COLOR_0");
}

// False if the primitive has no triangles.
bool GltfLoader::read_part(const tinygltf::Primitive& primitive, const std::string& where,
                           MeshPart& part)
{
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        ++points_and_lines_;
        return false;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        throw SceneError(
            fmt::format("{}.mode: {} is not a mode of glTF; repair the file", where, mode));
    }
    const auto& attributes = primitive.attributes;
    const auto position = attributes.find("POSITION");
    if (position == attributes.end()) {
        ++without_positions_;
        return false;
    }
    const auto positions = accessor_floats(document_, position->second, 3, 0, where + ", POSITION");
    for (size_t k = 0; k < positions.size(); ++k) {
        if (!std::isfinite(positions[k])) {
            throw SceneError(fmt::format("accessors[{}] ({}, POSITION): element {} is not finite; "
                                         "repair the mesh",
                                         position->second, where, k / 3));
        }
    }
    part.positions = as_vectors<float3>(positions);
    part.material = primitive.material;

    const auto implied = attributes.find(implied_indices_key);
    const int indices = implied == attributes.end() ? primitive.indices : implied->second;
    std::vector<uint> order;
    if (indices >= 0) {
        order = accessor_indices(document_, indices, where + ", indices");
        for (size_t k = 0; k < order.size(); ++k) {
            if (order[k] >= part.positions.size()) {
                throw SceneError(fmt::format("accessors[{}] ({}, indices): element {} names vertex "
                                             "{} of {}; repair the mesh",
                                             indices, where, k, order[k], part.positions.size()));
            }
        }
    } else {
        order.resize(part.positions.size());
        for (size_t k = 0; k < order.size(); ++k) {
            order[k] = uint(k);
        }
    }
    part.indices = triangle_corners(order, mode);
    if (part.indices.size() < 3) {
        return false;
    }

    if (const auto at = attributes.find("NORMAL"); at != attributes.end()) {
        part.normals =
            as_vectors<float3>(accessor_floats(document_, at->second, 3, 0, where + ", NORMAL"));
        check_count(part.normals.size(), part.positions.size(), where + ", NORMAL");
    }
    const bool has_normal_map =
        part.material >= 0 && materials_[size_t(part.material)].normal_texture.image >= 0;
    if (const auto at = attributes.find("TANGENT"); at != attributes.end() && has_normal_map) {
        part.tangents =
            as_vectors<float4>(accessor_floats(document_, at->second, 4, 0, where + ", TANGENT"));
        check_count(part.tangents.size(), part.positions.size(), where + ", TANGENT");
    }
    read_uvs(primitive, where, part);
    read_colors(primitive, where, part);
    return true;
}

std::vector<MeshPart> GltfLoader::mesh_parts(int index)
{
    std::vector<MeshPart> parts;
    const tinygltf::Mesh& mesh = model_.meshes[size_t(index)];
    for (size_t k = 0; k < mesh.primitives.size(); ++k) {
        MeshPart part;
        if (read_part(mesh.primitives[k], fmt::format("meshes[{}].primitives[{}]", index, k),
                      part)) {
            parts.push_back(std::move(part));
        }
    }
    return parts;
}

void GltfLoader::add_meshes()
{
    mesh_numbers_.assign(model_.meshes.size(), -1);
    for (const NodePlacement& placement : placements_) {
        int& number = mesh_numbers_[size_t(placement.mesh)];
        if (number < 0) {
            number = scene_.add_mesh(mesh_parts(placement.mesh),
                                     model_.meshes[size_t(placement.mesh)].name);
        }
    }
}

std::vector<ModelPlacement> GltfLoader::run_for_model()
{
    refuse_cycles();
    visit_nodes();
    add_materials();
    reads_all_uvs_ = true;
    std::vector<ModelPlacement> model;
    for (const NodePlacement& placement : placements_) {
        model.push_back({mesh_parts(placement.mesh), placement.to_world, placement.name});
    }
    document_.release_buffers();
    return model;
}

void GltfLoader::tell_what_was_skipped()
{
    const auto tell = [&](size_t count, const char* what) {
        if (count > 0) {
            scene_.notice(fmt::format("meshes: {} {}", count, what));
        }
    };
    tell(points_and_lines_, "primitives of points or lines skipped");
    tell(without_positions_, "primitives without positions skipped");
    tell(missing_uv_sets_, "sets of texture coordinates missing, taken as (0, 0)");
    tell(bad_colors_, "vertex colour values that are not numbers taken as 1");
}

}  // namespace diptych
