// `diptych texture memory SCENE`: the buffer of materials as devices see it.
#pragma once

#include "host/commands/scene_flags.hpp"

#include <nlohmann/json_fwd.hpp>

namespace diptych {

// Pages, materials, regions of arguments, programs with their steps; words count from the buffer's
// begin, pages hold page_words of them.
nlohmann::json texture_memory(const SceneData& scene);

// Prints it. json: a file for it, "-" is standard output instead of the text. Returns 0.
int show_texture_memory(const SceneFlags& flags, const std::string& json);

}  // namespace diptych
