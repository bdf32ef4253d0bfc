// Small scenes that together call for every effect.
#pragma once

#include "backends/scene_data.hpp"

namespace diptych {

struct SelftestScene {
    const char* name;
    SceneData scene;
};

// Pictures of 32 x 32 pixels.
std::vector<SelftestScene> selftest_scenes();

}  // namespace diptych
