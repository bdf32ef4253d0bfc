// What can be known to be wrong with a farm before anything is submitted.
#pragma once

#include "host/commands/farm_command.hpp"

namespace diptych {

// Throws std::runtime_error where the tasks or their merging would end with an error that shows
// already: by the flags, by slices in the folder that they cannot go on from, or for want of Slurm.
void check_farm(const FarmCommand& command);

// The folder that the tasks share, and a task's checkpoint in it.
std::string folder_of(const FarmCommand& command);
std::string slice_name(const FarmCommand& command, int task);

// An error about a checkpoint of a task (name: what; what to do), with what a farm's user can do.
std::string with_farms_advice(const std::string& error, const FarmCommand& command);

}  // namespace diptych
