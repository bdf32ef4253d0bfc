#include "backends/textures/texture_source.hpp"

#include <algorithm>
#include <stdexcept>

namespace diptych {
namespace {

const std::string place = "#pragma diptych textures\n";

// What the stage looks at beside the textures themselves.
constexpr unsigned effects_read = EFFECT_INSTANCES | EFFECT_SMOOTH_NORMALS | EFFECT_VERTEX_COLOR |
                                  EFFECT_FLOAT_TEXTURES | EFFECT_ORTHOGRAPHIC;

std::string definitions(const SceneData& scene)
{
    std::string text = "#define TEXTURE_FUNCTIONS(X)";
    int number = 0;
    for (const TextureFunction& function : scene.textures.functions)
        text += " X(" + std::to_string(number++) + ", " + function.id + ")";
    text += "\n#define TEXTURE_ASKED " + std::to_string(scene.textures.attributes) + "u\n";
    text += "#define TEXTURE_SLOTS " + std::to_string(std::max(1, scene.textures.slots)) + "\n";
    return text;
}

}  // namespace

std::string cpp_texture_functions(const SceneData& scene)
{
    std::string text;
    for (const TextureFunction& function : scene.textures.functions) text += function.cpp + "\n";
    text += "#line 1 \"texture stage\"\n" + definitions(scene);
    return text + "#define TEXTURE_EFFECTS " + std::to_string(scene.effects & effects_read) + "u\n";
}

std::string opencl_texture_program(const SceneData& scene, const std::string& stage)
{
    const size_t at = stage.find(place);
    if (at == std::string::npos)
        throw std::runtime_error("evaluate_textures.cl: the place for the textures is missing; "
                                 "rebuild the program");
    std::string text;
    for (const TextureFunction& function : scene.textures.functions) text += function.opencl + "\n";
    text += definitions(scene);
    const auto line = std::count(stage.begin(), stage.begin() + long(at), '\n');
    text += "#line " + std::to_string(line + 2) + " \"evaluate_textures (flattened)\"\n";
    return std::string(stage).replace(at, place.size(), text);
}

}  // namespace diptych
