// What can be known to be wrong with a farm before anything is submitted.
#pragma once

#include "host/commands/farm_command.hpp"

namespace diptych {

// Throws std::runtime_error where the tasks or their merging would end with an error that shows
// already: by the flags, or for want of Slurm.
void check_farm(const FarmCommand& command);

}  // namespace diptych
