// A hostile file costs at most 10 s of processor time and 1 GiB.
#pragma once

#include <string>

namespace texture_tool {

// From here on the process ends with exit code 2 and a message about `file` when it has used too
// much, or when the parser breaks down.
void set_limits(const std::string& file);

[[noreturn]] void give_up(const std::string& why);

}  // namespace texture_tool
