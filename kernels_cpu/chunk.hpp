// Runs the whole row list for about two thousand paths at a time: few enough for their state to
// stay in the second-level cache, enough that packets have few empty lanes when most paths have
// ended.
#pragma once

#include "common/as_cpp/path_rows.hpp"
#include "kernels_cpu/embree_scene.hpp"
#include "kernels_cpu/kernels.hpp"
#include "kernels_cpu/record_view.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace diptych {

inline constexpr int chunk_paths = 2048;

// Paths first .. first + count - 1.
struct PathRange {
    int first;
    int count;
};

// Path state for one thread, and what its work has cost so far.
class Chunk {
public:
    Chunk(const KernelSet& kernels, const EmbreeScene* embree, const SceneView& scene);

    // How many work items of that many samples for each of 1 << pixel_shift pixels run together.
    static int items_at_once(int samples, int pixel_shift)
    {
        return std::max(1, (chunk_paths >> pixel_shift) / samples);
    }

    // All samples of `items` work items of a dispatch, which run together; `results` has the items,
    // what they have in common, and the planes for the results of the whole dispatch.
    void run(const PathView& results, int first_item, int items);

    size_t bytes() const { return memory_.size(); }

    std::array<double, STAGE_COUNT> stage_seconds{};
    std::uint64_t rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t undecided_rays = 0;
    // Over all bounces: lanes of packets, and those of them with a live path.
    std::uint64_t slot_steps = 0;
    std::uint64_t busy_steps = 0;

private:
    void run_stage(Stage stage, int count);
    void run_stage(Stage stage, const PathView& view, int count);
    void count_rays(Stage stage, const PathView& view, int count);
    void trace_paths(int count);
    void find_surfaces(int count);
    int compact(int count);
    void gather(const PathRow& row, int front, int count);
    void gather_carried(int front, int count);
    void retire(int count);

    const KernelSet& kernels_;
    const EmbreeScene* embree_;
    SceneView scene_;
    std::vector<unsigned char> memory_;
    std::vector<void*> planes_;
    std::vector<void*> retired_planes_;  // planes_, but radiance lies in the order of the slots
    std::vector<void*> texture_planes_;
    std::vector<int> slots_;
    std::vector<int> order_;           // in which paths close ranks
    std::vector<PathRange> surfaces_;  // of this bounce; outside these no ray has met anything
    std::vector<PathRange> misses_;
    PathView view_;
    RecordViews records_;
    int bounce_ = 0;
    int alive_ = 0;  // paths, at the beginning of the bounce
};

}  // namespace diptych
