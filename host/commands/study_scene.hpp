// The scene of the textures' study: the helmet of bevy-FlightHelmet-512 in gi-lux-kitchen, as the
// same experiment in Cycles places it.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace diptych {

struct StudyOptions {
    std::filesystem::path scenes;  // folder that holds both
    int side = 512;                // of the picture
    int samples = 64;
    int rays = 16;  // of each occlusion request
};

// What the helmet is made of: plain light-grey diffuse, or what a texture gives.
enum class HelmetMaterial { plain, rust, open_rust, scratches };

class StudyScenes {
public:
    // Throws std::runtime_error when a scene is not there.
    explicit StudyScenes(const StudyOptions& options);

    SceneData scene(HelmetMaterial material) const;

private:
    StudyOptions options_;
    SceneBuilder kitchen_;
    std::vector<std::pair<std::vector<MeshPart>, Transform>> helmet_;
};

// The folder to look in when none is named: what DIPTYCH_SHARED says, or the build.
std::filesystem::path default_study_scenes();

}  // namespace diptych
