// How much memory a render may take here.
#pragma once

#include <cstddef>

namespace diptych {

// Bytes beyond what this process has already: of the machine's memory, whoever uses it now, of what
// the control groups that it is in allow (a container's limit), and of its own limit (ulimit -v).
size_t host_memory_left();

}  // namespace diptych
