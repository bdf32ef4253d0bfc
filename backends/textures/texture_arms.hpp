// The other ways to make the texture stage, which `diptych study textures` compares with the one
// that Diptych uses (common/textures/procedural.h). They are other textures for the same stage.
#pragma once

#include "backends/scene_data.hpp"

namespace diptych {

struct TextureArm {
    // Each material's nodes, their children at every place that reads them and the values of all
    // arguments are pasted into one function for each result; what reads its program becomes
    // constant, so that compilers leave nothing of the interpreter, its stack and its regions.
    bool pastes_arguments = false;
    // Occlusion rays are traced one by one where a texture asks, not by the stage before.
    bool traces_inside = false;
};

// Makes the scene, as it was loaded, into one of the arm. Before it is uploaded; once.
void make_texture_arm(SceneData& scene, TextureArm arm);

}  // namespace diptych
