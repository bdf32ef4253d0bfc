// `diptych watch`: a render that follows the edits of its scene.
#pragma once

#include "host/commands/render_command.hpp"

namespace diptych {

struct WatchCommand {
    RenderCommand render;
};

CLI::App* add_watch_command(CLI::App& app, WatchCommand& command);

// 0: told to quit; 130: interrupted; the pictures are written in both cases. Errors are thrown as
// long as there is no picture, and told afterwards.
int run_watch_command(const WatchCommand& command);

}  // namespace diptych
