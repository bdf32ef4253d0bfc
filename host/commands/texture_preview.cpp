#include "host/commands/texture_preview.hpp"

#include "host/scene/environment.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace diptych {
namespace {

// A material whose slot reads the texture, everything else plain; `slot` as in --texture.
MaterialInput material_for(const std::string& slot)
{
    MaterialInput material;
    material.name = "texture";
    material.roughness = 0.35f;
    if (slot == "baseColor") {
        material.base_texture.node = 0;
        material.specular = 0;
    } else if (slot == "metallicRoughness") {
        material.metallic_roughness_texture.node = 0;
        material.metallic = material.roughness = 1;
    } else if (slot == "normal") {
        material.normal_texture.node = 0;
    } else if (slot == "emissive") {
        material.emission_texture.node = 0;
        material.emission = {1, 1, 1};
        material.base_color = {0, 0, 0, 1};
    } else if (slot == "specular") {
        material.specular_texture.node = 0;
    } else if (slot == "specularColor") {
        material.specular_color_texture.node = 0;
    } else {
        throw std::runtime_error("--slot " + slot +
                                 ": no such slot; use baseColor, metallicRoughness, normal, "
                                 "emissive, specular or specularColor");
    }
    return material;
}

// The texture's material. All textures of these scenes are node 0 of function 0.
int add_texture(SceneBuilder& scene, const TextureFile& file, const PreviewOptions& options)
{
    TextureFunction function = translate_file(file);
    for (const std::string& warning : function.warnings) scene.notice(warning);
    TextureNode node = node_of(function, file, options.values, scene);
    scene.add_texture_function(std::move(function));
    scene.add_texture_node(std::move(node));
    return scene.add_material(material_for(options.slot));
}

// An upright square whose image has its first row on top.
MeshPart square(const Vec3& low, const Vec3& along, int material)
{
    MeshPart part = quad_mesh(low, along, {0, 1, 0}, material);
    for (float2& uv : part.uvs[0]) uv.y = 1 - uv.y;
    return part;
}

}  // namespace

SceneData preview_scene(const TextureFile& file, const PreviewOptions& options)
{
    SceneBuilder scene;
    const int textured = add_texture(scene, file, options);
    const int floor = scene.add_material(
        {.name = "floor", .base_color = {0.32f, 0.32f, 0.32f, 1}, .specular = 0});
    scene.place(scene.add_mesh(sphere_mesh({-0.6, 0.5, 0}, 0.5, 128, textured)), {}, "sphere");
    scene.place(scene.add_mesh(square({0.12, 0, -0.12}, {0.97, 0, 0.24}, textured)), {}, "square");
    scene.place(scene.add_mesh(quad_mesh({-40, 0, 40}, {80, 0, 0}, {0, 0, -80}, floor)), {},
                "floor");
    scene.set_environment(neutral_sky(), 0, 1.4f);
    scene.set_camera({.eye = {0, 0.72, 3.3}, .target = {-0.02, 0.47, 0}, .fov = 0.40});
    scene.set_picture_size(options.width, options.height);
    return scene.finish();
}

SceneData square_scene(const TextureFile& file, const PreviewOptions& options)
{
    SceneBuilder scene;
    const int textured = add_texture(scene, file, options);
    scene.place(scene.add_mesh(square({0, 0, 0}, {1, 0, 0}, textured)), {}, "square");
    scene.set_environment(neutral_sky());
    scene.set_camera({.eye = {0.5, 0.5, 1}, .target = {0.5, 0.5, 0}, .half_height = 0.45});
    scene.set_picture_size(options.width, options.height);
    return scene.finish();
}

}  // namespace diptych
