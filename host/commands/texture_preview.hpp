// Scenes that show one texture and nothing else.
#pragma once

#include "host/commands/texture_file.hpp"

namespace diptych {

struct PreviewOptions {
    std::vector<std::string> values;  // ARGUMENT=JSON
    std::string slot = "baseColor";   // as in --texture
    int width = 640;
    int height = 320;
};

// A sphere of 1 m and an upright square of 1 m on a grey floor under the neutral sky.
SceneData preview_scene(const TextureFile& file, const PreviewOptions& options);

// A square of 1 m that fills the picture, so that every camera ray is one evaluation.
SceneData square_scene(const TextureFile& file, const PreviewOptions& options);

}  // namespace diptych
