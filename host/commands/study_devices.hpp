// The part of the textures' study that needs no device: what compilers for GPUs say of each arm.
#pragma once

#include "host/commands/study_scene.hpp"

namespace diptych {

// Prints registers, stack, spills, code and compile time of the arms for both targets, with 64
// registers and without a limit, and the same for one noise that is read by 1 to 16 arguments; then
// which signs of the paper hold.
void print_study_devices(const StudyScenes& scenes);

}  // namespace diptych
