// From sources to programs on a device: only what the scene needs, in parallel (unless
// BackendOptions::threads is 1), through the cache.
#pragma once

#include "backends/backend.hpp"
#include "backends/opencl_devices.hpp"
#include "backends/program_cache.hpp"

#include <array>
#include <optional>

namespace diptych {

// The compiler's options: language, effects, pages of large buffers, exactness, planted fault.
std::string program_options(const DeviceInfo& device, const BackendOptions& options,
                            const SceneData& scene);

struct ProgramSet {
    std::array<std::optional<opencl::Program>, STAGE_COUNT> programs;  // none: not active
    int from_cache = 0;
    int compiled = 0;
};

// The programs of all stages that are active for the scene's effects. Throws with the compiler's
// log.
ProgramSet build_programs(const opencl::Context& context, const DeviceInfo& device,
                          const BackendOptions& options, const SceneData& scene,
                          ProgramCache& cache);

// What an NVIDIA device's compiler says of the texture stage's program, which is compiled for that
// alone; none: another maker's device. Throws with the log of an error.
std::optional<std::string> verbose_texture_log(const DeviceInfo& device,
                                               const BackendOptions& options,
                                               const SceneData& scene);

// That of the texture stage alone.
opencl::Program build_texture_program(const opencl::Context& context, const DeviceInfo& device,
                                      const BackendOptions& options, const SceneData& scene,
                                      ProgramCache& cache);

}  // namespace diptych
