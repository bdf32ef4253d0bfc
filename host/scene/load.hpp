// Scenes for the renderer: glTF 2.0 files, and one of our own.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <filesystem>
#include <string>

namespace diptych {

struct LoadOptions {
    std::string camera{};   // name of a camera or of its node, or its number; empty: the first
    bool has_view = false;  // look from eye to target instead, with `fov`
    float eye[3] = {0, 0, 0};
    float target[3] = {0, 0, 0};
    float up[3] = {0, 1, 0};
    float fov = 0.78539816f;    // vertical field of view, radians
    std::string environment{};  // empty: a neutral sky if nothing emits; "none"; or an image file
    float environment_rotation = 0;  // radians about +Y
    float environment_scale = 1;     // radiance = texel * scale
    int width = 512;                 // of the picture: the horizontal field of view follows it
    int height = 512;
    bool allow_outside = false;  // URIs may leave the scene's folder
    int scene_index = -1;        // of the file's scenes; -1: its default
    unsigned disabled_effects = 0;
    // Procedural textures beside those of the file: "MATERIAL.SLOT=FILE.c[:FUNCTION]", and values
    // of arguments, "NODE.ARGUMENT=JSON" (docs/textures.md).
    std::vector<std::string> textures{};
    std::vector<std::string> texture_values{};
    // More values, above those, each as far as its node is there and takes it.
    std::vector<std::string> typed_values{};
    std::string solo{};               // show what this texture node gives, unlit, and nothing else
    std::vector<std::string> aovs{};  // texture nodes that layers of the picture show
    size_t max_image_pixels = size_t(1) << 28;
    size_t copied_triangles = 64;  // SceneBuilder::copy_small_meshes; 0: every mesh is stored once
};

// Loads a .gltf or .glb file. Angles in radians, +Y up, lengths in metres; candela and lux are
// taken as W/sr and W/m^2. What was skipped, replaced or assumed is told in SceneData::notices.
// Throws SceneError: "file: where: what; what to do", one line.
SceneData load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

// A room of our own, built by code: what `diptych render` shows without a scene.
SceneData demo_scene(const LoadOptions& options = {});

// The part of both that follows from the options: picture size, view and environment.
void apply_options(SceneBuilder& scene, const LoadOptions& options);

}  // namespace diptych
