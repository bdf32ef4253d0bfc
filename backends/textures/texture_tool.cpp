#include "backends/textures/texture_tool.hpp"

#include "backends/program_cache.hpp"
#include "backends/sha256.hpp"
#include "backends/textures/scratch_folder.hpp"
#include "backends/textures/subprocess.hpp"

#include "platform.h"

#include "common/textures/procedural.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path program_folder()
{
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error).parent_path();
}

// Beside the program, where it was built, or on the PATH.
std::string tool()
{
    const char* chosen = std::getenv("DIPTYCH_TEXTURE_TOOL");
    if (chosen && *chosen) {
        if (const std::string found = find_program(chosen); !found.empty()) return found;
        throw std::runtime_error("DIPTYCH_TEXTURE_TOOL: " + std::string(chosen) +
                                 ": no such program; name diptych-texture, or unset it");
    }
    for (const std::string& place :
         {(program_folder() / "diptych-texture").string(), std::string(DIPTYCH_BUILT_TEXTURE_TOOL),
          std::string("diptych-texture")})
        if (const std::string found = find_program(place); !found.empty()) return found;
    throw std::runtime_error("procedural textures: the texture tool, diptych-texture, is neither "
                             "beside the program nor on the PATH; install it, or set "
                             "DIPTYCH_TEXTURE_TOOL");
}

// What the tool writes, as one text.
std::string translated(const std::string& program, const TextureSource& source)
{
    const ScratchFolder folder;
    std::vector<std::string> command = {
        program,  source.file.string(), "--id",     source.id,
        "--name", source.name,          "--opencl", folder / "out.cl",
        "--cpp",  folder / "out.hpp",   "--json",   folder / "out.json"};
    if (!source.watched.empty()) command.insert(command.end(), {"--watch", source.watched});
    if (!source.entry.empty()) command.insert(command.end(), {"--entry", source.entry});
    const Finished done = run_program(command);
    if (done.exit_code != 0) {
        std::string text = done.output;
        while (!text.empty() && text.back() == '\n') text.pop_back();
        throw std::runtime_error(text.empty()
                                     ? source.name + ": the texture tool ended with code " +
                                           std::to_string(done.exit_code) + "; simplify the texture"
                                     : text);
    }
    const json all = {{"description", json::parse(text_of(folder / "out.json"))},
                      {"opencl", text_of(folder / "out.cl")},
                      {"cpp", text_of(folder / "out.hpp")}};
    return all.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string key_of(const std::string& program, const TextureSource& source)
{
    Sha256 hash;
    std::error_code error;
    for (const std::string& part :
         {program, std::to_string(fs::file_size(program, error)),
          std::to_string(fs::last_write_time(program, error).time_since_epoch().count()),
          text_of(source.file), source.name, source.entry, source.id, source.watched}) {
        hash.add(std::to_string(part.size()) + ":");
        hash.add(part);
    }
    return hash.finish();
}

unsigned attribute_bit(const std::string& name)
{
#define MATCH_ATTRIBUTE(attribute, bit, type, field) \
    if (name == #attribute) return 1u << bit;
    TEXTURE_ATTRIBUTES(MATCH_ATTRIBUTE)
    return 0;
}

std::string trimmed(const std::string& text)
{
    const size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos
               ? ""
               : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The text of a line that is a comment, or a line of one: behind //, /* or *, before */.
std::string comment_in(const std::string& line)
{
    std::string text = trimmed(line);
    const size_t signs = text.starts_with("//") || text.starts_with("/*") ? 2
                         : text.starts_with("*")                          ? 1
                                                                          : 0;
    if (signs == 0) return "";
    if (text.ends_with("*/") && text.size() >= signs + 2) text.resize(text.size() - 2);
    return trimmed(text.substr(signs));
}

// Comment lines "// NAME (TYPE, ...; default JSON): what it is" tell of arguments; the last part
// may be missing.
void read_comments(const std::string& source, std::vector<TextureArgument>& arguments)
{
    std::istringstream lines(source);
    for (std::string line; std::getline(lines, line);) {
        const std::string comment = comment_in(line);
        const size_t open = comment.find(" (");
        const size_t colon = comment.find("):");
        const size_t close = colon != std::string::npos ? colon
                             : comment.ends_with(")")   ? comment.size() - 1
                                                        : std::string::npos;
        if (open == std::string::npos || close == std::string::npos || open > close) continue;
        const auto argument =
            std::ranges::find(arguments, comment.substr(0, open), &TextureArgument::name);
        const std::string inside = comment.substr(open + 2, close - open - 2);
        const bool is_told = argument != arguments.end() &&
                             (!argument->about.empty() || !argument->default_value.empty());
        if (argument == arguments.end() || is_told) continue;
        if (colon != std::string::npos) argument->about = trimmed(comment.substr(colon + 2));
        const size_t at = inside.rfind("; default ");
        if (at != std::string::npos) argument->default_value = trimmed(inside.substr(at + 10));
    }
}

OcclusionRequest occlusion_request(const json& from)
{
    OcclusionRequest request;
    const json& distance = from.at("distance");
    if (distance.is_object())
        request.distance_argument = distance.at("argument").get<int>();
    else
        request.distance = distance.get<double>();
    const auto hemisphere = from.at("hemisphere").get<std::string>();
    request.hemisphere = hemisphere == "lower"  ? Hemisphere::lower
                         : hemisphere == "both" ? Hemisphere::both
                                                : Hemisphere::upper;
    request.is_same_object = from.value("same_object", false);
    return request;
}

TextureFunction function_of(const json& all, const TextureSource& source)
{
    const json& from = all.at("description");
    TextureFunction function;
    function.id = source.id;
    function.file = source.name;
    function.entry = from.at("entry").get<std::string>();
    function.channels = width_of({"", from.at("result").get<std::string>()});
    function.description = from.dump();
    function.cpp = all.at("cpp").get<std::string>();
    function.opencl = all.at("opencl").get<std::string>();
    for (const json& argument : from.at("arguments")) {
        const json& length = argument.at("length");
        function.arguments.push_back(
            {argument.at("name").get<std::string>(), argument.at("type").get<std::string>(),
             argument.at("is_array").get<bool>(), length.is_number() ? length.get<int>() : 0});
    }
    read_comments(text_of(source.file), function.arguments);
    for (const json& request : from.at("occlusion"))
        function.occlusion.push_back(occlusion_request(request));
    for (const json& name : from.at("attributes"))
        function.attributes |= attribute_bit(name.get<std::string>());
    for (const json& warning : from.at("warnings"))
        function.warnings.push_back(warning.is_string() ? warning.get<std::string>()
                                                        : warning.dump());
    return function;
}

}  // namespace

TextureFunction translate_texture(const TextureSource& source)
{
    const std::string program = tool();
    ProgramCache cache(ProgramCache::default_folder());
    const std::string key = key_of(program, source);
    std::string text = cache.load(key).value_or("");
    if (text.empty()) {
        text = translated(program, source);
        cache.store(key, text);
    }
    return function_of(json::parse(text), source);
}

fs::path library_texture(const std::string& name)
{
    const bool is_name =
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
    if (name.empty() || !is_name) return {};
    const char* chosen = std::getenv("DIPTYCH_TEXTURE_LIBRARY");
    for (const fs::path& folder :
         {fs::path(chosen ? chosen : ""), program_folder() / "../share/diptych/textures",
          fs::path(DIPTYCH_BUILT_TEXTURE_LIBRARY)})
        if (!folder.empty() && fs::is_regular_file(folder / (name + ".c")))
            return folder / (name + ".c");
    return {};
}

}  // namespace diptych
