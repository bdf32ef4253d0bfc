// `diptych debug SCENE --pixel X,Y --texture NODE`: a debugger, stopped inside a texture in its
// author's own file, where that pixel is evaluated.
#pragma once

#include "host/commands/scene_flags.hpp"

namespace diptych {

struct DebugCommand {
    SceneFlags scene;  // among scene.load.textures, the one without a "=" names the node
    DeviceFlags device;
    std::string pixel;
    int line = 0;  // of the texture's file; 0: where its function begins
    std::string debugger = "gdb";
    std::vector<std::string> commands;  // for the debugger once it has stopped; then it ends
    bool is_print = false;
    std::string replay;  // a capture, whose hits are run instead of a render
    bool is_vscode = false;
    std::vector<std::string> words;  // of the command line
};

CLI::App* add_debug_command(CLI::App& app, DebugCommand& command);

// Becomes the debugger; or prints the command, or writes .vscode/launch.json, and gives 0.
int run_debug_command(const DebugCommand& command);

// Where a debugger must stop.
struct DebugStop {
    std::string entry;     // in generated code: what calls the user's function for a region
    std::string function;  // the user's, with its namespace
    std::string file;
    int line = 0;
    int region = -1;  // of the arguments of this node, where the material calls the function for
                      // others too; -1: it does not
};

// The stop for the first sample of a pixel: traced on the twin backend. Throws std::runtime_error
// when the pixel does not show the node.
DebugStop find_stop(SceneData& scene, const std::string& node, int x, int y, int line);

// Likewise, for a node where the material is known.
DebugStop find_stop_in(const SceneData& scene, const std::string& node, int material, int line);

// The debugger's whole command line around `program`. `commands`: see DebugCommand.
std::vector<std::string> debugger_command(const std::string& debugger, const DebugStop& stop,
                                          const std::vector<std::string>& program,
                                          const std::vector<std::string>& commands);

}  // namespace diptych
