// A scene whose one square is painted by a texture of the test, for the commands to run on.
#pragma once

#include "tests/host/commands/program.hpp"
#include "tests/host/scene/gltf_text.hpp"

#include <string>
#include <vector>

namespace diptych {

// Lines are asked for by what stands in them: line_of(painted_source, "stripe * tint").
inline const std::string painted_source = R"(// A texture to step through.
float3 stripes(float3 p, float scale)
{
    const float wave = sin(p.x * scale);
    const float3 result = make_float3(wave * wave, p.y, 0.25f);
    return result;
}

float4 userProc(float scale, float3 tint)
{
    float3 place = readAttr("WorldPos");
    float3 stripe = stripes(place, scale);
    return to_float4(stripe * tint, 1.0f);
}
)";

inline int line_of(const std::string& source, const std::string& text)
{
    int line = 1;
    for (size_t at = 0; at < source.size(); ++line) {
        const size_t end = std::min(source.find('\n', at), source.size());
        if (source.substr(at, end - at).find(text) != std::string::npos) return line;
        at = end + 1;
    }
    return 0;
}

inline nlohmann::json painted_node(const std::string& name, double scale,
                                   const std::vector<double>& tint)
{
    return {{"name", name}, {"source", 0}, {"arguments", {{"scale", scale}, {"tint", tint}}}};
}

// The square (0,0,0) to (1,1,0), facing +z, and beside it a plain one. Nodes "left" and "paint"
// call the same function; the square's roughness and colour read them.
inline void write_painted_scene(const TestFolder& folder)
{
    folder.write("paint.c", painted_source);
    GltfText gltf;
    const nlohmann::json extension = {
        {"sources", {{{"uri", "paint.c"}}}},
        {"nodes", {painted_node("left", 2, {1, 1, 1}), painted_node("paint", 7, {0.5, 0.75, 1})}}};
    gltf.document["extensionsUsed"] = {"DIPTYCH_procedural_texture"};
    gltf.document["extensions"] = {{"DIPTYCH_procedural_texture", extension}};
    gltf.document["materials"] = {{{"name", "painted"},
                                   {"extensions",
                                    {{"DIPTYCH_procedural_texture",
                                      {{"metallicRoughnessTexture", {{"node", "left"}}},
                                       {"baseColorTexture", {{"node", "paint"}}}}}}}},
                                  {{"name", "plain"}}};
    gltf.add_triangle({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0})["material"] = 0;
    gltf.add_triangle({1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 0, 0, 2, 1, 0, 1, 1, 0})["material"] = 1;
    folder.write("scene.gltf", gltf.text());
}

// Flags for a view of both squares, 40 x 20 pixels: the painted one on the left.
inline const std::vector<std::string> painted_view = {
    "--eye", "1,0.5,2", "--target", "1,0.5,0", "--fov", "40", "--size", "40x20", "--filter", "box"};

}  // namespace diptych
