// Runs another program and waits for it; no shell in between.
#pragma once

#include <string>
#include <vector>

namespace diptych {

struct Finished {
    int exit_code = 0;   // 128 + n: ended by signal n
    std::string output;  // standard output and error, together
};

// arguments[0]: a program's path, or its name on the PATH. Throws when it cannot be started.
Finished run_program(const std::vector<std::string>& arguments);

// The full path of a program on the PATH, or of a path that exists; empty: there is none.
std::string find_program(const std::string& name);

}  // namespace diptych
