// `diptych merge`: slices of a picture's samples put together.
#pragma once

#include "host/image/image.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace diptych {

struct MergeCommand {
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
    std::string view = "standard";
    image::WriteOptions write;
    bool is_quiet = false;
};

CLI::App* add_merge_command(CLI::App& app, MergeCommand& command);

// 0: done. Errors are thrown.
int run_merge_command(const MergeCommand& command);

}  // namespace diptych
