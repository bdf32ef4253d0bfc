#include "host/commands/study_scene.hpp"

#include "backends/textures/scratch_folder.hpp"
#include "host/commands/texture_file.hpp"
#include "host/scene/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace diptych {
namespace {

namespace fs = std::filesystem;

// Before the camera, and the radius that the helmet is given, metres.
constexpr double distance_to_helmet = 0.9;
constexpr double helmet_radius = 0.85;
constexpr double occlusion_distance = 0.1;

fs::path scene_file(const fs::path& folder, const std::string& name)
{
    const fs::path file = folder / name;
    if (!fs::is_regular_file(file))
        throw std::runtime_error(fmt::format(
            "{}: no such scene; name the folder with gi-lux-kitchen and bevy-FlightHelmet-512 by "
            "--scenes",
            file.string()));
    return file;
}

// Corners of the boxes about the meshes, each in its mesh's own axes.
std::vector<Vec3> box_corners(const std::vector<ModelPlacement>& model)
{
    std::vector<Vec3> corners;
    for (const ModelPlacement& mesh : model) {
        Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
        for (const MeshPart& part : mesh.parts)
            for (const float3& p : part.positions)
                for (size_t c = 0; c < 3; ++c) {
                    const double x = c == 0 ? p.x : c == 1 ? p.y : p.z;
                    low[c] = std::min(low[c], x);
                    high[c] = std::max(high[c], x);
                }
        for (int k = 0; k < 8; ++k)
            corners.push_back(mesh.to_world.point(
                {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]}));
    }
    return corners;
}

// Scaled and moved to before the camera.
Transform place_before(SceneBuilder kitchen, const std::vector<Vec3>& corners)
{
    const SceneData data = kitchen.finish();
    const float4 eye = data.settings.at(0).camera_origin;
    const float4 forward = data.settings.at(0).camera_forward;
    Vec3 centre{0, 0, 0};
    for (const Vec3& corner : corners) centre = centre + corner * (1.0 / double(corners.size()));
    double radius = 0;
    for (const Vec3& corner : corners) radius = std::max(radius, length(corner - centre));
    const double scale = helmet_radius / radius;
    const Vec3 at =
        Vec3{eye.x, eye.y, eye.z} + Vec3{forward.x, forward.y, forward.z} * distance_to_helmet;
    const Vec3 moved = at - centre * scale;
    return translation(moved[0], moved[1], moved[2]) * scaling(scale, scale, scale);
}

// Rust whose occlusion finds everything open: the texture's code alone.
TextureFile without_occlusion(const TextureFile& file, const ScratchFolder& folder)
{
    std::ifstream in(file.path);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string asked = "readOcclusion(\"upper\", reach)";
    const size_t at = text.find(asked);
    if (at == std::string::npos)
        throw std::runtime_error(file.path.string() + ": does not ask for occlusion as the study "
                                                      "expects; use the library of this version");
    text.replace(at, asked.size(), "1.0f");
    const std::string path = folder / "open_rust.c";
    std::ofstream(path) << text;
    return {path, "open_rust.c", "rust"};
}

int textured_material(SceneBuilder& scene, HelmetMaterial kind)
{
    const ScratchFolder folder;
    const bool is_rust = kind != HelmetMaterial::scratches;
    TextureFile file = find_texture_file(is_rust ? "rust" : "scratches");
    if (kind == HelmetMaterial::open_rust) file = without_occlusion(file, folder);
    TextureFunction function = translate_file(file);
    std::vector<std::string> values;
    if (is_rust) values.push_back(fmt::format("reach={}", occlusion_distance));
    TextureNode node = node_of(function, file, values, scene);
    scene.add_texture_function(std::move(function));
    MaterialInput material{.name = "helmet", .specular = 0};
    material.base_texture.node = scene.add_texture_node(std::move(node));
    return scene.add_material(material);
}

}  // namespace

fs::path default_study_scenes()
{
    const char* shared = std::getenv("DIPTYCH_SHARED");
    return shared && *shared ? fs::path(shared) / "scenes" : fs::path("scenes");
}

StudyScenes::StudyScenes(const StudyOptions& options) : options_(options)
{
    LoadOptions load;
    load.width = load.height = options.side;
    load_into(kitchen_, scene_file(options.scenes, "gi-lux-kitchen/gi-lux-kitchen.glb"), load);
    const std::vector<ModelPlacement> model =
        read_model(scene_file(options.scenes, "bevy-FlightHelmet-512/FlightHelmet.gltf"));
    if (model.empty())
        throw std::runtime_error(
            "the study: bevy-FlightHelmet-512 shows nothing; use the original");
    const Transform placed = place_before(kitchen_, box_corners(model));
    for (const ModelPlacement& mesh : model)
        helmet_.emplace_back(mesh.parts, placed * mesh.to_world);
}

SceneData StudyScenes::scene(HelmetMaterial kind) const
{
    SceneBuilder scene = kitchen_;
    scene.set_textures({.occlusion_rays = options_.rays});
    const int material =
        kind == HelmetMaterial::plain
            ? scene.add_material(
                  {.name = "helmet", .base_color = {0.7f, 0.7f, 0.7f, 1}, .specular = 0})
            : textured_material(scene, kind);
    for (const auto& [parts, to_world] : helmet_) {
        std::vector<MeshPart> own = parts;
        for (MeshPart& part : own) part.material = material;
        scene.place(scene.add_mesh(std::move(own)), to_world, "helmet");
    }
    SceneData data = scene.finish();
    data.settings.at(0).max_bounces = 64;
    data.settings.at(0).samples = options_.samples;
    return data;
}

}  // namespace diptych
