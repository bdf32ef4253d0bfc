// What a host must know of a texture, as JSON.
#pragma once

#include <string>

#include "texture_tool/description.hpp"

namespace texture_tool {

std::string describe(const Description& description, const std::string& id, int changed_lines,
                     int total_lines);

// file:line:column: error: reason; remedy
std::string message(const Description& description, const Problem& problem);

}  // namespace texture_tool
