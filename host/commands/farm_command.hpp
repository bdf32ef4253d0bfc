// `diptych farm`: a picture by many machines, through Slurm.
#pragma once

#include "host/image/image.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace diptych {

struct FarmCommand {
    int tasks = 0;
    int samples = 64;
    std::string folder;
    std::vector<std::string> outputs;
    std::string view = "standard";  // of the pictures, as are these: for the merging
    image::WriteOptions write;
    std::vector<std::string> sbatch;  // words for sbatch, as --partition=long
    std::string script;
    bool is_detached = false;
    std::vector<std::string> render;  // what diptych render is given besides
};

CLI::App* add_farm_command(CLI::App& app, FarmCommand& command);

// 0: the picture is there, or the jobs are submitted with --detach; 130: interrupted while watching
// them. Errors are thrown.
int run_farm_command(const FarmCommand& command);

}  // namespace diptych
