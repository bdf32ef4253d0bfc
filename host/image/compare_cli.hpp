// The flags of `diptych compare`.
#pragma once

#include "host/image/compare.hpp"

namespace CLI {
class App;
}

namespace diptych::image {

// Adds the subcommand `compare`, which fills `options` when it is parsed; `options` must live as
// long as `app`. The caller then looks at options.backends, and calls compare_command(options,
// std::cout, std::cerr) when that is empty. Returns the subcommand, for flags that comparing
// backends needs beside these.
CLI::App* add_compare_command(CLI::App& app, CompareOptions& options);

}  // namespace diptych::image
