#include "host/commands/launch_file.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace diptych {
namespace {

using nlohmann::json;

constexpr const char* new_file = "{\n"
                                 "    \"version\": \"0.2.0\",\n"
                                 "    \"configurations\": []\n"
                                 "}\n";
constexpr const char* key = "\"configurations\"";

// Behind the string that begins there.
size_t end_of_string(const std::string& text, size_t at)
{
    for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return std::min(at + 1, text.size());
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// JSON proper, byte for byte where it was: blanks for what VS Code allows beside it.
std::string blanked(std::string text)
{
    std::optional<size_t> comma;  // with nothing behind it so far
    for (size_t at = 0; at < text.size();) {
        const bool is_block = text.compare(at, 2, "/*") == 0;
        if (is_block || text.compare(at, 2, "//") == 0) {
            size_t end = text.find(is_block ? "*/" : "\n", at + 2);
            end = end == std::string::npos ? text.size() : end + (is_block ? 2 : 0);
            for (; at < end; ++at)
                if (text[at] != '\n') text[at] = ' ';
            continue;
        }
        const char c = text[at];
        if (comma && (c == ']' || c == '}')) text[*comma] = ' ';
        if (!is_space(c)) comma.reset();
        if (c == ',') comma = at;
        at = c == '"' ? end_of_string(text, at) : at + 1;
    }
    return text;
}

// Where the list's elements lie, in JSON proper that has the list.
struct Places {
    size_t begin = 0;  // of the list, behind its bracket
    size_t end = 0;    // of the last element; `begin` if there is none
    std::vector<std::pair<size_t, size_t>> objects;
};

Places places_in(const std::string& plain)
{
    Places places;
    int depth = 0;
    bool is_key = false;
    for (size_t at = 0; at < plain.size();) {
        const char c = plain[at];
        const size_t end = c == '"' ? end_of_string(plain, at) : at + 1;
        const bool is_inside = places.begin > 0;
        if (c == '"' && depth == 1 && plain.compare(at, end - at, key) == 0)
            is_key = plain[plain.find_first_not_of(" \t\r\n", end)] == ':';
        if (c == '[' && depth == 1 && is_key) places.begin = places.end = end;
        if (c == '{' && depth == 2 && is_inside) places.objects.emplace_back(at, at);
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
        if (is_inside && depth == 1) break;
        if (c == '}' && depth == 2 && is_inside) places.objects.back().second = end;
        if (is_inside && !is_space(c) && !(c == ',' && depth == 2)) places.end = end;
        at = end;
    }
    return places;
}

// As it stands within the list.
std::string indented(const json& configuration)
{
    std::string text;
    for (const char c : configuration.dump(4)) text += c == '\n' ? "\n        " : std::string(1, c);
    return text;
}

}  // namespace

std::string with_configuration(const std::string& text, const json& configuration)
{
    std::string result = text.empty() ? new_file : text;
    const std::string plain = blanked(result);
    const json launch = json::parse(plain, nullptr, false);
    const bool has_list = launch.is_object() && launch.contains("configurations") &&
                          launch["configurations"].is_array();
    const Places places = has_list ? places_in(plain) : Places{};
    if (places.begin == 0)
        throw std::runtime_error("is not JSON with a list of configurations, comments aside; "
                                 "repair it, or move it away");
    for (const auto& [begin, end] : places.objects) {
        const json other = json::parse(plain.substr(begin, end - begin));
        if (!other.contains("name") || other["name"] != configuration["name"]) continue;
        for (size_t at = begin; at < end; ++at)
            if (result[at] != plain[at] && result[at] != ',')
                throw std::runtime_error("there are comments in its configuration " +
                                         other["name"].dump() +
                                         ", which would be lost; give it another name");
        return result.replace(begin, end - begin, indented(configuration));
    }
    const bool is_first = places.end == places.begin;
    return result.insert(places.end, (is_first ? "\n        " : ",\n        ") +
                                         indented(configuration) + (is_first ? "\n    " : ""));
}

}  // namespace diptych
