// URIs in glTF files, and text from files in messages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace diptych {

// One line, valid UTF-8 as far as it was, of bounded length: for messages.
std::string printable(const std::string& text);

bool is_data_uri(const std::string& uri);
// The bytes of a data: URI, base64 or percent-encoded. Throws SceneError.
std::vector<std::uint8_t> data_uri_bytes(const std::string& uri, const std::string& where);
// The path that a file URI names: percent-decoded, `file://` removed. Throws SceneError for other
// schemes.
std::filesystem::path uri_path(const std::string& uri, const std::string& where);

}  // namespace diptych
