// What an evaluation of one texture costs, and where its values differ.
#pragma once

#include "backends/backend.hpp"
#include "host/commands/texture_file.hpp"

#include <optional>

namespace diptych {

// Of one backend.
struct TextureTiming {
    std::string backend;
    std::string device;
    double nanoseconds = 0;         // an evaluation, the stage around it included
    double stage_nanoseconds = 0;   // of a texture that is constant
    double ray_nanoseconds = 0;     // of its occlusion rays on a plane without surroundings
    double largest_difference = 0;  // of a component, to twin
    size_t differing = 0;           // evaluations that are not bit for bit twin's
    size_t compared = 0;
    std::string failure;       // why there is no measurement; empty: there is one
    std::string no_reference;  // why twin's values are not there to compare with; empty: they are
};

// Each backend on one thread (OpenCL: the device's time). Throws std::runtime_error for a texture
// or a value that is refused; a backend that does not work says so in its row.
std::vector<TextureTiming> time_texture(const TextureFile& file,
                                        const std::vector<std::string>& values,
                                        const std::vector<std::string>& backends,
                                        const BackendOptions& options);

// What a compiler for GPUs says of the texture stage.
struct DeviceCost {
    std::string target;  // sm_80, gfx900
    int registers = 0;
    int stack_bytes = 0;
    int spill_bytes = 0;  // sm_80: stored; gfx900: four a spilled register of one work item
    int code_bytes = 0;   // of the stage's machine code; 0: unknown
    double seconds = 0;   // that compilation took
    std::string missing;  // which program or library is not there; empty: measured
};

// Of the texture stage for the scene's textures, with as many registers as the compiler likes and,
// if `most_registers` is above zero, with no more than so many.
struct DeviceCosts {
    std::vector<DeviceCost> free;
    std::vector<DeviceCost> limited;
};
DeviceCosts device_costs(const SceneData& scene, int most_registers = 0);

// By what ptxas -v prints, and NVIDIA's OpenCL with -cl-nv-verbose: the most that a function takes.
DeviceCost ptxas_cost(const std::string& target, const std::string& log);
// The same for the OpenCL device in use, from its own compiler; none: it is not one of NVIDIA's.
std::optional<DeviceCost> driver_cost(const SceneData& scene, const BackendOptions& options);

std::string first_line(const std::string& text);  // of a compiler's words

// All of it as text. `backends`: names with commas, or empty for all.
std::string cost_card(const TextureFile& file, const std::vector<std::string>& values,
                      const std::string& backends, const BackendOptions& options);

}  // namespace diptych
