// A square that shows one texture of the test's, and what goes wrong in it.
#pragma once

#include "tests/host/commands/program.hpp"
#include "tests/host/scene/gltf_text.hpp"

#include <string>
#include <vector>

namespace diptych {

// Node "planted" calls `function` of planted.c, and gives the square's base colour.
inline void write_planted_scene(const TestFolder& folder, const std::string& source,
                                const nlohmann::json& arguments)
{
    folder.write("planted.c", source);
    GltfText gltf;
    const nlohmann::json extension = {{"sources", {{{"uri", "planted.c"}}}},
                                      {"nodes",
                                       {{{"name", "planted"},
                                         {"source", 0},
                                         {"function", "planted"},
                                         {"arguments", arguments}}}}};
    gltf.document["extensionsUsed"] = {"DIPTYCH_procedural_texture"};
    gltf.document["extensions"] = {{"DIPTYCH_procedural_texture", extension}};
    gltf.document["materials"] = {
        {{"name", "square"},
         {"extensions",
          {{"DIPTYCH_procedural_texture", {{"baseColorTexture", {{"node", "planted"}}}}}}}}};
    gltf.add_triangle({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0})["material"] = 0;
    folder.write("scene.gltf", gltf.text());
}

// 16 x 8 pixels, the square in their middle.
inline const std::vector<std::string> planted_view = {
    "--eye",  "0.5,0.5,2", "--target", "0.5,0.5,0", "--fov",     "45",
    "--size", "16x8",      "--filter", "box",       "--bounces", "0"};

}  // namespace diptych
