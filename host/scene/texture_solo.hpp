// Shows what one texture node gives, and nothing else.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <string>
#include <vector>

namespace diptych {

// Materials that read the node, directly or through others, become unlit and show its colour as it
// is; all others become black. Throws SceneError when there is no such node, or none reads it.
void show_only(const std::string& node, const std::vector<TextureNode>& nodes,
               std::vector<MaterialInput>& materials);

}  // namespace diptych
