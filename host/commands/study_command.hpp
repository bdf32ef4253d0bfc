// `diptych study textures`: table 1 of "Restricted Extensions for GPU Photo-realistic Renderer",
// measured on this machine.
#pragma once

#include "host/commands/scene_flags.hpp"
#include "host/commands/study_scene.hpp"

#include <string>

namespace CLI {
class App;
}

namespace diptych {

struct StudyCommand {
    StudyOptions study;
    DeviceFlags device;
    std::string scenes;
    std::string backends = "cpu,opencl";
    std::string output;  // the beginning of the pictures' names; empty: none is written
    int repetitions = 1;
    bool is_without_devices = false;  // leave out what compilers for GPUs say
};

CLI::App* add_study_command(CLI::App& app, StudyCommand& command);

// 0: measured, whatever the signs; 1: the pictures of two arms differ. Errors are thrown.
int run_study_command(const StudyCommand& command);

}  // namespace diptych
