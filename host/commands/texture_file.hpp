// The file of one texture on its own, for commands that need no scene.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace diptych {

struct TextureFile {
    std::filesystem::path path;
    std::string name;   // as in messages: what the user typed, without the function
    std::string entry;  // empty: the only function that no other calls
};

// "rust.c", "rust.c:function", or the name of a texture of the library. Throws std::runtime_error.
TextureFile find_texture_file(const std::string& words);

// The tool's translation under the id t0; debuggers find the file by its whole path. Throws
// std::runtime_error with the tool's messages.
TextureFunction translate_file(const TextureFile& file);

// A node that calls the function, each argument with the value that `given` (ARGUMENT=JSON; for an
// image the name of its file) names, else with what its comment says is the default, else with one
// half, which is told by a notice. Throws std::runtime_error.
TextureNode node_of(const TextureFunction& function, const TextureFile& file,
                    const std::vector<std::string>& given, SceneBuilder& scene);

}  // namespace diptych
