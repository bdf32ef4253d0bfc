#include "host/scene/scene_builder.hpp"

#include "host/scene/scene_assembly.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_emissive(const MaterialInput& m)
{
    return !m.is_unlit && (m.emission[0] > 0 || m.emission[1] > 0 || m.emission[2] > 0);
}

}  // namespace

int SceneBuilder::add_image(Picture picture)
{
    pictures_.push_back(std::move(picture));
    return int(pictures_.size()) - 1;
}

int SceneBuilder::add_material(const MaterialInput& material)
{
    materials_.push_back(material);
    return int(materials_.size()) - 1;
}

int SceneBuilder::add_texture_function(TextureFunction function)
{
    texture_functions_.push_back(std::move(function));
    return int(texture_functions_.size()) - 1;
}

int SceneBuilder::add_texture_node(TextureNode node)
{
    texture_nodes_.push_back(std::move(node));
    return int(texture_nodes_.size()) - 1;
}

void SceneBuilder::add_aov(int node)
{
    if (std::ranges::find(aovs_, node) == aovs_.end()) aovs_.push_back(node);
}

void SceneBuilder::set_textures(const TextureSettings& settings) { texture_settings_ = settings; }

int SceneBuilder::add_mesh(std::vector<MeshPart> parts, const std::string& name)
{
    Mesh mesh{
        name, std::move(parts), {infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const MeshPart& part : mesh.parts) {
        for (const float3& p : part.positions) {
            const Vec3 at{p.x, p.y, p.z};
            for (int k = 0; k < 3; ++k) {
                mesh.low[k] = std::min(mesh.low[k], at[k]);
                mesh.high[k] = std::max(mesh.high[k], at[k]);
            }
        }
    }
    meshes_.push_back(std::move(mesh));
    return int(meshes_.size()) - 1;
}

int SceneBuilder::add_mesh(MeshPart part, const std::string& name)
{
    std::vector<MeshPart> parts;
    parts.push_back(std::move(part));
    return add_mesh(std::move(parts), name);
}

void SceneBuilder::place(int mesh, const Transform& to_world, const std::string& name)
{
    const std::string& shown = name.empty() ? meshes_.at(size_t(mesh)).name : name;
    if (!to_world.is_finite()) {
        throw SceneError(fmt::format("{}: its transform is not finite; correct the matrix",
                                     shown.empty() ? "a mesh" : shown));
    }
    placements_.push_back({mesh, to_world, shown});
}

void SceneBuilder::copy_small_meshes(size_t triangles)
{
    std::vector<size_t> placed(meshes_.size(), 0), size(meshes_.size(), 0);
    for (size_t m = 0; m < meshes_.size(); ++m) {
        for (const MeshPart& part : meshes_[m].parts) {
            size[m] += (part.indices.empty() ? part.positions.size() : part.indices.size()) / 3;
        }
    }
    for (const Placement& placement : placements_) {
        ++placed[size_t(placement.mesh)];
    }
    std::vector<char> is_taken(meshes_.size(), 0);
    for (Placement& placement : placements_) {
        const size_t m = size_t(placement.mesh);
        if (size[m] * placed[m] > triangles) {
            continue;
        }
        if (is_taken[m]) {
            placement.mesh = int(meshes_.size());
            meshes_.push_back(Mesh(meshes_[m]));
        }
        is_taken[m] = 1;
    }
}

void SceneBuilder::add_light(const PunctualLight& light) { lights_.push_back(light); }

void SceneBuilder::set_camera(const CameraInput& camera) { camera_ = camera; }

void SceneBuilder::set_environment(Picture map, double rotation, float scale)
{
    environment_ = EnvironmentMap{std::move(map), rotation, scale};
}

void SceneBuilder::set_picture_size(int width, int height)
{
    width_ = width;
    height_ = height;
}

void SceneBuilder::disable_effects(unsigned mask) { disabled_effects_ = mask; }

void SceneBuilder::notice(const std::string& line) { notices_.push_back(line); }

bool SceneBuilder::has_lights() const
{
    if (!lights_.empty()) {
        return true;
    }
    for (const Placement& placement : placements_) {
        for (const MeshPart& part : meshes_[size_t(placement.mesh)].parts) {
            if (part.material >= 0 && !part.positions.empty() &&
                is_emissive(materials_[size_t(part.material)])) {
                return true;
            }
        }
    }
    return false;
}

bool SceneBuilder::bounds(Vec3& low, Vec3& high) const
{
    low = {infinity, infinity, infinity};
    high = {-infinity, -infinity, -infinity};
    for (const Placement& placement : placements_) {
        const Mesh& mesh = meshes_[size_t(placement.mesh)];
        if (mesh.low[0] > mesh.high[0]) {
            continue;
        }
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 p;
            for (int k = 0; k < 3; ++k) {
                p[k] = (corner >> k & 1) ? mesh.high[k] : mesh.low[k];
            }
            p = placement.to_world.point(p);
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], p[k]);
                high[k] = std::max(high[k], p[k]);
            }
        }
    }
    return low[0] <= high[0];
}

SceneData SceneBuilder::finish()
{
    SceneData data = SceneAssembly(*this).run();
    *this = SceneBuilder();
    return data;
}

void set_picture_size(SceneData& scene, int width, int height)
{
    Settings& s = scene.settings.at(0);
    const float change = float(double(width) / height * s.height / s.width);
    s.camera_right = s.camera_right * change;
    s.width = width;
    s.height = height;
}

}  // namespace diptych
