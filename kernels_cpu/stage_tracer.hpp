// Runs a dispatch stage by stage over all its paths at once, without compaction, and shows the
// state after each: for comparing backends, not for speed.
#pragma once

#include "kernels_cpu/embree_scene.hpp"
#include "kernels_cpu/kernels.hpp"
#include "kernels_cpu/record_view.hpp"

#include <functional>
#include <vector>

namespace diptych {

class StageTracer {
public:
    // results: as for Chunk::run, for the whole dispatch of `paths` paths.
    StageTracer(const KernelSet& kernels, const EmbreeScene* embree, const SceneView& scene,
                const PathView& results, int paths);

    // Planes in the order of PATH_BUFFERS, widened to double; components of float3 rows follow each
    // other.
    using Planes = std::vector<std::vector<double>>;
    void run(const std::function<void(Stage, int bounce, Planes)>& after_stage);

    // Inside after_stage: what the stage gave in planes of TEXTURE_BUFFERS.
    std::vector<double> texture_results(Stage stage) const;

private:
    void run_stage(Stage stage, int bounce);
    void run_stage(Stage stage, const PathView& view, int bounce);
    Planes planes() const;
    bool is_any_alive() const;

    const KernelSet& kernels_;
    const EmbreeScene* embree_;
    SceneView scene_;
    PathView view_;
    RecordViews records_;
    int paths_;
    std::vector<std::vector<unsigned char>> memory_;
    std::vector<void*> planes_;
    std::vector<void*> texture_planes_;
};

}  // namespace diptych
