#include "host/scene/texture_arguments.hpp"

#include "host/scene/uri.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace diptych {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const TextureNode& node, const std::string& what)
{
    throw SceneError(fmt::format("texture node {}: {}", node.name, what));
}

std::string argument_names(const TextureFunction& function)
{
    std::string names;
    for (const TextureArgument& argument : function.arguments)
        names += (names.empty() ? "" : ", ") + type_of(argument) + " " + argument.name;
    return names.empty() ? "none" : names;
}

void check_numbers(const TextureNode& node, const TextureArgument& argument,
                   const TextureInput& value)
{
    const std::string at = fmt::format("its argument {} ", argument.name);
    const size_t width = size_t(width_of(argument));
    const size_t count = value.numbers.size();
    if (!value.images.empty() || value.node >= 0)
        fail(node, at + fmt::format("is of type {}; give it numbers", type_of(argument)));
    if (argument.is_array ? count == 0 || count % width != 0 : count != width)
        fail(node,
             at + fmt::format("is of type {}, but has {} numbers; give it {}", type_of(argument),
                              count, argument.is_array ? "whole elements" : std::to_string(width)));
    if (argument.is_array && argument.length > 0 && count / width != size_t(argument.length))
        fail(node, at + fmt::format("has {} elements; the function wants {}", count / width,
                                    argument.length));
    const bool is_whole = argument.type.starts_with("int") || argument.type.starts_with("uint");
    const double low = argument.type.starts_with("uint") ? 0 : -2147483648.0;
    const double high = argument.type.starts_with("uint") ? 4294967295.0 : 2147483647.0;
    for (const double x : value.numbers) {
        if (is_whole && !(x == std::floor(x) && x >= low && x <= high))
            fail(node,
                 at + fmt::format("is of type {}; {} is not such a number", argument.type, x));
        if (!is_whole && !std::isfinite(float(x)))
            fail(node, at + fmt::format("has the value {}, beyond the range of float", x));
    }
}

void check_argument(const TextureNode& node, const TextureArgument& argument,
                    const TextureInput& value)
{
    const std::string at = fmt::format("its argument {} ", argument.name);
    if (argument.type == "sam2D") {
        const size_t count = value.images.size();
        if (!value.numbers.empty() || value.node >= 0 || count == 0)
            fail(node, at + "is an image; name one with {\"texture\": N}");
        if (!argument.is_array && count != 1) fail(node, at + "is one image; name just one");
        if (argument.is_array && argument.length > 0 && count != size_t(argument.length))
            fail(node,
                 at + fmt::format("has {} images; the function wants {}", count, argument.length));
        return;
    }
    if (value.node < 0) return check_numbers(node, argument, value);
    if (argument.is_array || !argument.type.starts_with("float"))
        fail(node, at + fmt::format("is of type {}, which no node gives; give it {}",
                                    type_of(argument), "numbers"));
}

// False: something in it is no constant.
bool add_numbers(const json& value, const std::string& where, int depth,
                 std::vector<double>& numbers)
{
    if (value.is_array()) {
        if (depth > 1)
            throw SceneError(where +
                             ": is nested too deeply; give an array of numbers or of vectors");
        return std::ranges::all_of(value, [&](const json& element) {
            return add_numbers(element, where, depth + 1, numbers);
        });
    }
    if (value.is_object() || value.is_string()) return false;
    if (value.is_boolean()) {
        numbers.push_back(value.get<bool>() ? 1 : 0);
        return true;
    }
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        throw SceneError(where + ": must be a finite number");
    numbers.push_back(value.get<double>());
    return true;
}

}  // namespace

TextureValue parse_texture_value(const std::string& text, const std::string& where)
{
    const size_t equals = text.find('=');
    const size_t dot = text.rfind('.', equals);
    if (equals == std::string::npos || dot == std::string::npos)
        throw SceneError(where + ": not a value; give NODE.ARGUMENT=JSON, as rust.scale=2.5");
    TextureValue parsed{text.substr(0, dot), text.substr(dot + 1, equals - dot - 1),
                        json::parse(text.substr(equals + 1), nullptr, false)};
    if (parsed.value.is_discarded())
        throw SceneError(where + ": its value is not JSON; give a number, [1, 2, 3], or "
                                 "{\"node\": \"name\"}");
    return parsed;
}

std::string dumped(const json& value)
{
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<json> default_of(const TextureArgument& argument)
{
    if (argument.default_value == "white") return argument.default_value;
    json value = json::parse(argument.default_value, nullptr, false);
    if (value.is_discarded()) return std::nullopt;
    return value;
}

std::optional<std::vector<double>> constant_numbers(const json& value, const std::string& where)
{
    std::vector<double> numbers;
    if (!add_numbers(value, where, 0, numbers)) return std::nullopt;
    return numbers;
}

const TextureArgument& argument_named(const std::string& name, const TextureNode& node,
                                      const TextureFunction& function)
{
    const auto at = std::ranges::find(function.arguments, name, &TextureArgument::name);
    if (at == function.arguments.end())
        fail(node, fmt::format("{} has no argument {}; it takes: {}", function.entry,
                               printable(name), argument_names(function)));
    return *at;
}

void check_argument(const TextureNode& node, const TextureFunction& function,
                    const std::string& name, const TextureInput& value)
{
    check_argument(node, argument_named(name, node, function), value);
}

void check_node(const TextureNode& node, const TextureFunction& function)
{
    for (const auto& [name, value] : node.arguments) {
        check_argument(node, function, name, value);
    }
    for (const TextureArgument& argument : function.arguments)
        if (!node.arguments.count(argument.name))
            fail(node,
                 fmt::format("its argument {} {} is missing; give it a value: --set {}.{}=JSON, "
                             "in the scene, or as a default in the file's comment",
                             type_of(argument), argument.name, node.name, argument.name));
}

int stride_of(const TextureArgument& argument)
{
    return width_of(argument) == 3 ? 4 : width_of(argument);
}

std::vector<uint> constant_words(const TextureArgument& argument,
                                 const std::vector<double>& numbers)
{
    const int width = width_of(argument), stride = stride_of(argument);
    const bool is_int = argument.type.starts_with("int");
    const bool is_uint = argument.type.starts_with("uint");
    std::vector<uint> words;
    for (size_t k = 0; k < numbers.size(); ++k) {
        const double x = numbers[k];
        words.push_back(is_int ? uint(int(x)) : is_uint ? uint(x) : std::bit_cast<uint>(float(x)));
        if (k % size_t(width) == size_t(width) - 1) words.resize(words.size() + stride - width, 0);
    }
    return words;
}

}  // namespace diptych
