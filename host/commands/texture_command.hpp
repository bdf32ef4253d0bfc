// `diptych texture check|show|preview|cost FILE`: one texture, without a scene; `diptych texture
// memory SCENE`: those of a scene.
#pragma once

#include "host/commands/scene_flags.hpp"

namespace diptych {

struct TextureCommand {
    std::string file;  // FILE.c[:FUNCTION], or the name of a texture of the library
    std::vector<std::string> values;
    std::string code;  // show: in which language; empty: none
    std::string output = "preview.png";
    std::string slot = "baseColor";
    std::string size = "640x320";
    int samples = 32;
    DeviceFlags device;
    std::string backends;  // cost
    SceneFlags scene;      // memory
    std::string json;      // memory
};

CLI::App* add_texture_command(CLI::App& app, TextureCommand& command);

// 0: done; 2: the texture is refused, its errors on standard error. Other errors are thrown.
int run_texture_command(const CLI::App& texture, const TextureCommand& command);

}  // namespace diptych
