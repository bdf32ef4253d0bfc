#include "host/scene/uri.hpp"

#include "host/scene/scene_error.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace diptych {
namespace {

constexpr size_t longest_shown = 200;

int hex_value(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    if (c >= 'A' && c <= 'F') {
        return c - 'A' + 10;
    }
    return -1;
}

// A % that two hexadecimal digits do not follow stands for itself: exporters leave it in names.
std::string percent_decoded(const std::string& text)
{
    std::string result;
    result.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        const int high = text[i] == '%' && i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
        if (low >= 0) {
            result.push_back(char(high * 16 + low));
            i += 2;
        } else {
            result.push_back(text[i]);
        }
    }
    return result;
}

constexpr auto base64_values = [] {
    std::array<int, 256> values{};
    values.fill(-1);
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int k = 0; k < 64; ++k) {
        values[size_t(static_cast<unsigned char>(digits[k]))] = k;
    }
    values['-'] = 62;  // the URL alphabet
    values['_'] = 63;
    return values;
}();

std::vector<std::uint8_t> base64_decoded(const std::string& text, size_t from,
                                         const std::string& where)
{
    std::vector<std::uint8_t> result;
    result.reserve((text.size() - from) / 4 * 3);
    unsigned bits = 0;
    int held = 0;
    for (size_t i = from; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (c == '=' || std::isspace(c)) {
            continue;
        }
        const int value = base64_values[c];
        if (value < 0) {
            throw SceneError(where + ": its data URI is not base64; repair the file");
        }
        bits = bits << 6 | unsigned(value);
        held += 6;
        if (held >= 8) {
            held -= 8;
            result.push_back(std::uint8_t(bits >> held));
            bits &= (1u << held) - 1;
        }
    }
    return result;
}

}  // namespace

std::string printable(const std::string& text)
{
    std::string result;
    for (const char c : text.substr(0, longest_shown)) {
        result.push_back(static_cast<unsigned char>(c) < ' ' || c == 0x7f ? ' ' : c);
    }
    while (!result.empty() && result.back() == ' ') {
        result.pop_back();
    }
    return text.size() > longest_shown ? result + "..." : result;
}

bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

std::vector<std::uint8_t> data_uri_bytes(const std::string& uri, const std::string& where)
{
    const size_t comma = uri.find(',');
    if (comma == std::string::npos) {
        throw SceneError(where + ": its data URI has no comma; repair the file");
    }
    if (uri.substr(0, comma).ends_with(";base64")) {
        return base64_decoded(uri, comma + 1, where);
    }
    const std::string bytes = percent_decoded(uri.substr(comma + 1));
    return {bytes.begin(), bytes.end()};
}

std::filesystem::path uri_path(const std::string& uri, const std::string& where)
{
    std::string text = uri;
    if (text.starts_with("file://")) {
        text = text.substr(7);
    } else if (const size_t colon = text.find("://"); colon != std::string::npos) {
        throw SceneError(where + ": " + printable(uri) +
                         " is not in the file system; fetch it and name the file");
    }
    text = percent_decoded(text);
    if (text.empty() || text.find('\0') != std::string::npos) {
        throw SceneError(where + ": its URI names no file; repair the file");
    }
    std::ranges::replace(text, '\\', '/');  // written so by some exporters
    return std::filesystem::path(text);
}

}  // namespace diptych
