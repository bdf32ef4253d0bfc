// VS Code's launch.json, which people write by hand: JSON with comments and commas after the last
// element.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace diptych {

// The file's text (empty: there is no file yet) with this configuration in the place of an earlier
// one of its name, or else as the last one. All else stays as it is. Throws std::runtime_error
// where the text has no list of configurations; the message does not name the file.
std::string with_configuration(const std::string& text, const nlohmann::json& configuration);

}  // namespace diptych
