// `diptych explain`: what a scene calls for, and what that makes the renderer do.
#pragma once

#include "host/commands/scene_flags.hpp"

namespace diptych {

struct ExplainCommand {
    SceneFlags scene;
};

// Why the scene calls for an effect: "materials gold, mirror and 3 more". Empty if it does not.
std::string reason_for(const SceneData& scene, unsigned effect);

// The whole text.
std::string explanation(const SceneData& scene, const SceneFlags& flags);

CLI::App* add_explain_command(CLI::App& app, ExplainCommand& command);
int run_explain_command(const ExplainCommand& command);  // 0; errors are thrown

}  // namespace diptych
