// Clang's messages with a remedy.
#pragma once

#include <string>

namespace texture_tool {

std::string with_remedy(const std::string& said);

}  // namespace texture_tool
