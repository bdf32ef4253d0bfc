// Runs another program and waits for it; words stay words: no shell reads them.
#pragma once

#include <string>
#include <vector>

namespace diptych {

struct Finished {
    int exit_code = 0;   // 128 + n: ended by signal n
    double seconds = 0;  // of the processor, that it and what it started took
    std::string output;  // standard output and error, together
};

// arguments[0]: a program's path, or its name on the PATH. Throws when it cannot be started.
Finished run_program(const std::vector<std::string>& arguments);

// The same for a program that may never end: it and each that it starts get so many seconds of the
// processor, and GiB of memory.
Finished run_program_within(int seconds, int gibibytes, const std::vector<std::string>& arguments);

// The full path of a program on the PATH, or of a path that exists; empty: there is none.
std::string find_program(const std::string& name);

}  // namespace diptych
