// Scenes put together from files: what a glTF file says, into a scene that is yet to be finished.
#pragma once

#include "host/scene/load.hpp"

namespace diptych {

// As load_scene, without its last step.
void load_into(SceneBuilder& scene, const std::filesystem::path& file,
               const LoadOptions& options = {});

// A mesh of a glTF file where the file places it; materials are numbered as in the file.
struct ModelPlacement {
    std::vector<MeshPart> parts;
    Transform to_world;
    std::string name;
};

// What a glTF file shows, geometry alone with its first two sets of texture coordinates, to be
// placed in another scene. Throws SceneError as load_scene does.
std::vector<ModelPlacement> read_model(const std::filesystem::path& file);

}  // namespace diptych
