// Arguments of procedural textures: values from JSON, checked against what a function takes, as the
// words that devices read.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace diptych {

// "NODE.ARGUMENT=JSON". Throws SceneError that begins with `where`.
struct TextureValue {
    std::string node;  // name or number
    std::string argument;
    nlohmann::json value;
};
TextureValue parse_texture_value(const std::string& text, const std::string& where);

// JSON as TextureNode::values holds it.
std::string dumped(const nlohmann::json& value);

// What the comment in the function's file gives where nobody else does; none: it gives nothing.
std::optional<nlohmann::json> default_of(const TextureArgument& argument);

// A number, a boolean, or an array of them or of such arrays: their numbers, end to end. None when
// there are texts or objects in it, which may name images or nodes. Throws SceneError for all else.
std::optional<std::vector<double>> constant_numbers(const nlohmann::json& value,
                                                    const std::string& where);

// The function's argument of that name. Throws SceneError where it has none.
const TextureArgument& argument_named(const std::string& name, const TextureNode& node,
                                      const TextureFunction& function);
// Whether the node gives the function what it takes, all of it and nothing else. Throws SceneError
// that names the node and the argument; the second for one argument alone.
void check_node(const TextureNode& node, const TextureFunction& function);
void check_argument(const TextureNode& node, const TextureFunction& function,
                    const std::string& name, const TextureInput& value);

// Words from one element of a value to the next: those of three take four.
int stride_of(const TextureArgument& argument);
// A value that has been checked, as it lies in a region (common/textures/procedural.h).
std::vector<uint> constant_words(const TextureArgument& argument,
                                 const std::vector<double>& numbers);

}  // namespace diptych
