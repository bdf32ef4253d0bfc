// Clang reads a texture; what it found leaves as plain data.
#pragma once

#include <string>

#include "texture_tool/description.hpp"

namespace texture_tool {

// Never throws for what a file holds: that becomes problems. `name` is only printed.
Description find(const std::string& name, const std::string& source);

// Of LLVM.
std::string parser_version();

}  // namespace texture_tool
