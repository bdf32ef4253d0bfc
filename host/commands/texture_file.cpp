#include "host/commands/texture_file.hpp"

#include "backends/textures/texture_tool.hpp"
#include "host/scene/uri.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t elements_without_length = 4;  // of an array that nothing gives a length
constexpr size_t max_image_pixels = size_t(1) << 28;

[[noreturn]] void fail(const std::string& where, const std::string& what)
{
    throw std::runtime_error(where + ": " + what);
}

int white_image(SceneBuilder& scene)
{
    return scene.add_image({1, 1, {255, 255, 255, 255}, {}, true, 0});
}

void add_image(TextureInput& input, const std::string& name, const std::string& where,
               SceneBuilder& scene)
{
    TextureUse use;
    if (name == "white")
        use.image = white_image(scene);
    else if (fs::is_regular_file(name))
        use.image = scene.add_image(read_picture(name, printable(name), max_image_pixels));
    else
        fail(where, printable(name) + ": no such file; name an image");
    input.images.push_back(use);
}

void add_value(TextureInput& input, const TextureArgument& argument, const json& value,
               const std::string& where, SceneBuilder& scene)
{
    if (value.is_array()) {
        for (const json& element : value) add_value(input, argument, element, where, scene);
    } else if (argument.type == "sam2D") {
        if (!value.is_string()) fail(where, "is an image; name its file");
        add_image(input, value.get<std::string>(), where, scene);
    } else if (value.is_number() || value.is_boolean()) {
        input.numbers.push_back(value.is_boolean() ? value.get<bool>() : value.get<double>());
    } else {
        fail(where,
             fmt::format("is of type {}; give numbers, as 0.5 or [1, 2, 3]", type_of(argument)));
    }
}

// `text`: JSON, or for an image just its name.
TextureInput input_from(const TextureArgument& argument, const std::string& text,
                        const std::string& where, SceneBuilder& scene)
{
    json value = json::parse(text, nullptr, false);
    if (value.is_discarded() && argument.type == "sam2D") value = text;
    if (value.is_discarded())
        fail(where, "its value is not JSON; give a number, or an array as [1, 2, 3]");
    TextureInput input;
    add_value(input, argument, value, where, scene);
    return input;
}

TextureInput middling_input(const TextureArgument& argument, SceneBuilder& scene)
{
    TextureInput input;
    const size_t length = !argument.is_array    ? 1
                          : argument.length > 0 ? size_t(argument.length)
                                                : elements_without_length;
    if (argument.type == "sam2D") {
        for (size_t k = 0; k < length; ++k) add_image(input, "white", argument.name, scene);
        return input;
    }
    const bool is_whole = argument.type.starts_with("int") || argument.type.starts_with("uint");
    input.numbers.assign(length * size_t(width_of(argument)), is_whole ? 1 : 0.5);
    return input;
}

}  // namespace

TextureFile find_texture_file(const std::string& words)
{
    if (fs::is_regular_file(words)) return {words, words, ""};
    std::string name = words, entry;
    if (const size_t colon = words.rfind(':'); colon != std::string::npos) {
        name = words.substr(0, colon);
        entry = words.substr(colon + 1);
    }
    if (fs::is_regular_file(name)) return {name, name, entry};
    if (const fs::path shipped = library_texture(name); !shipped.empty())
        return {shipped, shipped.filename().string(), entry};
    if (fs::exists(name)) fail(printable(words), "is not a file; name the .c file of a texture");
    fail(printable(words), "no such file, nor a texture of the library; check the name");
}

TextureFunction translate_file(const TextureFile& file)
{
    return translate_texture(
        {file.path, fs::absolute(file.path).lexically_normal().string(), file.entry, "t0"});
}

TextureNode node_of(const TextureFunction& function, const TextureFile& file,
                    const std::vector<std::string>& given, SceneBuilder& scene)
{
    std::map<std::string, std::string> values;
    for (const std::string& flag : given) {
        const size_t equals = flag.find('=');
        const std::string name = flag.substr(0, equals);
        const bool is_known = std::ranges::count(function.arguments, name, &TextureArgument::name);
        std::vector<std::string> names;
        for (const TextureArgument& argument : function.arguments) names.push_back(argument.name);
        if (equals == std::string::npos || !is_known)
            fail("--set " + printable(flag),
                 fmt::format("not an argument's value; give ARGUMENT=JSON; arguments of {}: {}",
                             function.entry,
                             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
        values[name] = flag.substr(equals + 1);
    }
    TextureNode node;
    node.name = function.entry;
    for (const TextureArgument& argument : function.arguments) {
        const auto own = values.find(argument.name);
        TextureInput& input = node.arguments[argument.name];
        if (own != values.end()) {
            input = input_from(argument, own->second, "--set " + argument.name, scene);
        } else if (!argument.default_value.empty()) {
            input =
                input_from(argument, argument.default_value,
                           fmt::format("{}: the default of {}", file.name, argument.name), scene);
        } else {
            input = middling_input(argument, scene);
            scene.notice(fmt::format("argument {}: no value and no default; {} is taken; give "
                                     "--set {}=JSON, or write the default into the comment: // {} "
                                     "({}; default VALUE): what it means",
                                     argument.name,
                                     argument.type == "sam2D"                         ? "white"
                                     : argument.type.find("int") == std::string::npos ? "0.5"
                                                                                      : "1",
                                     argument.name, argument.name, type_of(argument)));
        }
    }
    return node;
}

}  // namespace diptych
