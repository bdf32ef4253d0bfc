// The stages as kernels of one OpenCL device: built for a scene, launched over lists of paths in
// short pieces, timed.
#pragma once

#include "backends/opencl_memory.hpp"
#include "backends/opencl_programs.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace diptych {

// A stage's kernel, and how long its launches may be.
struct StageKernel {
    opencl::Kernel kernel;
    int lookup = LOOKUP_SURFACE;  // which planes it is bound to
    double seconds_per_path = 0;  // the slowest lately; 0: not measured yet

    // So many that a launch takes half of what is allowed; few as long as nothing is known.
    int paths_per_launch(double allowed_seconds) const
    {
        const int unknown = 1 << 14;
        if (seconds_per_path <= 0) return unknown;
        const double wanted = std::clamp(0.5 * allowed_seconds / seconds_per_path, 1024.0, 1e9);
        return int(wanted) & ~1023;
    }

    void measured(double seconds, int paths)
    {
        seconds_per_path = std::max(seconds / paths, 0.5 * seconds_per_path);
    }
};

class OpenclStages {
public:
    // What a dispatch may say in place of the result entry that begins, as in
    // kernels_cl/arguments.h.
    static constexpr int every_path = -1;
    static constexpr int follow_up = -2;

    // Paths to work on: those of a list, or the first `count` of all.
    struct Selection {
        int count = 0;
        const opencl::Buffer* list = nullptr;
    };

    // All outlive the stages; times and rays are added to `statistics`.
    OpenclStages(const BackendOptions& options, const DeviceInfo& device, opencl::Queue& queue,
                 Statistics& statistics)
        : options_(options), device_(device), queue_(queue), statistics_(statistics)
    {
    }

    void build(const opencl::Context& context, const SceneData& scene, ProgramCache& cache);
    void build_textures(const opencl::Context& context, const SceneData& scene,
                        ProgramCache& cache);
    // Both stay where they are as long as stages run.
    void bind(const SceneMemory& scene, const DispatchMemory& memory);

    // capacity: the distance between planes of a path's row.
    void begin(const Dispatch& dispatch, int capacity, int next_entry);
    // With the lookups of textures that belong to the stage.
    void run(Stage stage, const Selection& all);
    // The first samples of result entries from first_entry on, one in each slot.
    void begin_entries(const Selection& slots, int first_entry);
    // How many paths have a mark that is not negative, or, if not wants_live, one that is; their
    // list goes to `to`, if there is one.
    int select(const opencl::Buffer& marks, const Selection& from, const opencl::Buffer* to,
               bool wants_live = true);
    void collect_times();

private:
    struct Running {
        Stage stage;
        int paths;
        opencl::Event event;
    };

    bool is_launched(int stage) const
    {
        return programs_.programs[size_t(stage)] && stage != STAGE_compact;
    }
    void make_kernel(Stage stage);
    void bind_buffers(StageKernel& stage);
    void show_records(StageKernel& kernel, Stage stage, int lookup);
    void launch_over(Stage stage, int lookup, const Selection& paths);
    void launch(const opencl::Kernel& kernel, Stage stage, int paths, int groups);
    int groups_of(int paths) const;

    const BackendOptions& options_;
    const DeviceInfo& device_;
    opencl::Queue& queue_;
    Statistics& statistics_;
    unsigned effects_ = 0;
    const SceneMemory* scene_ = nullptr;
    const DispatchMemory* memory_ = nullptr;
    ProgramSet programs_;
    std::array<StageKernel, STAGE_COUNT> kernels_;
    opencl::Kernel compact_count_;
    opencl::Kernel compact_scan_;
    opencl::Kernel compact_write_;
    std::vector<Running> running_;
};

}  // namespace diptych
