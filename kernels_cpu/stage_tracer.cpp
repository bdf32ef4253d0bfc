#include "kernels_cpu/stage_tracer.hpp"

#include "common/as_cpp/path_rows.hpp"
#include "common/as_cpp/texture_rows.hpp"
#include "kernels_cpu/bounce_stages.hpp"
#include "kernels_cpu/texture_rays.hpp"

#include <algorithm>

namespace diptych {
namespace {

template<class Value>
std::vector<double> widen(const void* plane, size_t count)
{
    const Value* values = static_cast<const Value*>(plane);
    return std::vector<double>(values, values + count);
}

}  // namespace

StageTracer::StageTracer(const KernelSet& kernels, const EmbreeScene* embree,
                         const SceneView& scene, const PathView& results, int paths)
    : kernels_(kernels), embree_(embree), scene_(scene), view_(results), paths_(paths)
{
    const size_t padded = size_t(paths) + 16;  // packets write whole
    for (const PathRow& row : path_rows) {
        const size_t element = row.is_real ? size_t(kernels.real_bytes) : 4;
        memory_.emplace_back(padded * element * size_t(row.components) + 64);
        planes_.push_back(memory_.back().data());
    }
    for (int r = 0; r < texture_rows; ++r) {
        const size_t planes = scene.textures ? size_t(scene.textures->planes[r]) : 0;
        memory_.emplace_back(padded * size_t(kernels.real_bytes) * planes + 64);
        texture_planes_.push_back(memory_.back().data());
    }
    view_.texture_planes = texture_planes_.data();
    view_.capacity = int(padded);
    view_.planes = planes_.data();
    records_ = RecordViews(view_);
}

void StageTracer::run(const std::function<void(Stage, int, Planes)>& after_stage)
{
    const auto run_row = [&](Stage stage, int bounce) {
        run_stage(stage, bounce);
        after_stage(stage, bounce, planes());
    };
    run_row(STAGE_generate_paths, 0);
    for (int bounce = 0; is_any_alive(); ++bounce) {
        for_stages_of_bounce(scene_.effects, bounce, [&](Stage stage) { run_row(stage, bounce); });
    }
}

void StageTracer::run_stage(Stage stage, int bounce)
{
    records_.run(stage, scene_.effects, view_, paths_,
                 [&](Stage launched, const PathView& view) { run_stage(launched, view, bounce); });
}

void StageTracer::run_stage(Stage stage, const PathView& view, int bounce)
{
    if (const StageLoop loop = kernels_.loop(stage, scene_.effects))
        loop(scene_, view, 0, paths_);
    else if (stage == STAGE_intersect)
        embree_->intersect(scene_, view, paths_, bounce == 0);
    else if (stage == STAGE_occlusion)
        embree_->occlusion(scene_, view, paths_);
    else if (stage == STAGE_trace_texture_rays)
        trace_texture_rays(*embree_, scene_, view, paths_);
    else if (stage == STAGE_evaluate_textures)
        scene_.textures->evaluate(scene_, view, 0, paths_);
}

StageTracer::Planes StageTracer::planes() const
{
    Planes all;
    for (int r = 0; r < path_row_count; ++r) {
        std::vector<double> values;
        for (int c = 0; c < path_rows[r].components; ++c) {
            const size_t first = size_t(c) * size_t(view_.capacity);
            const auto* plane = static_cast<const unsigned char*>(planes_[size_t(r)]);
            std::vector<double> component =
                !path_rows[r].is_real      ? widen<int>(plane + first * 4, size_t(paths_))
                : kernels_.real_bytes == 8 ? widen<double>(plane + first * 8, size_t(paths_))
                                           : widen<float>(plane + first * 4, size_t(paths_));
            values.insert(values.end(), component.begin(), component.end());
        }
        all.push_back(std::move(values));
    }
    return all;
}

std::vector<double> StageTracer::texture_results(Stage stage) const
{
    std::vector<double> values;
    const int row = texture_row_of(stage);
    if (row < 0 || !scene_.textures) return values;
    const int count = scene_.textures->planes[row];
    const auto* planes = static_cast<const unsigned char*>(texture_planes_[size_t(row)]);
    for (int p = 0; p < count; ++p) {
        const size_t first = size_t(p) * size_t(view_.capacity);
        const std::vector<double> plane = kernels_.real_bytes == 8
                                              ? widen<double>(planes + first * 8, size_t(paths_))
                                              : widen<float>(planes + first * 4, size_t(paths_));
        values.insert(values.end(), plane.begin(), plane.end());
    }
    return values;
}

bool StageTracer::is_any_alive() const
{
    const int* depth = static_cast<const int*>(planes_[row_depth]);
    return std::any_of(depth, depth + paths_, [](int d) { return d >= 0; });
}

}  // namespace diptych
