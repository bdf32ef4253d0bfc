#include "kernels_cpu/chunk.hpp"

#include "common/as_cpp/path_rows.hpp"
#include "kernels_cpu/bounce_stages.hpp"
#include "kernels_cpu/texture_rays.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace diptych {
namespace {

// Planes a power of two apart would fall into the same few cache sets.
constexpr int padding = 16;
constexpr int capacity = chunk_paths + padding;
constexpr int packet = 16;  // paths that Embree takes at once, at most

// Compaction costs about as much as a stage on a tenth of the paths.
bool is_worth_compacting(int live, int count) { return live <= count - count / 8; }

template<class Value>
void gather_plane(Value* plane, const int* live, int count)
{
    for (int k = 0; k < count; ++k) plane[k] = plane[live[k]];
}

template<class Value>
void scatter_radiance(Value* out, const Value* in, const int* slots, const int* depth, int count)
{
    for (int i = 0; i < count; ++i) {
        if (depth[i] >= 0) continue;
        for (int c = 0; c < 3; ++c) out[c * capacity + slots[i]] = in[c * capacity + i];
    }
}

}  // namespace

Chunk::Chunk(const KernelSet& kernels, const EmbreeScene* embree, const SceneView& scene)
    : kernels_(kernels), embree_(embree), scene_(scene), planes_(path_row_count),
      retired_planes_(path_row_count), slots_(chunk_paths), live_(chunk_paths)
{
    size_t bytes = 64;
    const auto row_bytes = [&](const PathRow& row) {
        return size_t(row.components) * capacity * (row.is_real ? kernels.real_bytes : 4);
    };
    const auto texture_bytes = [&](int row) {
        return scene.textures ? size_t(scene.textures->planes[row]) * capacity * kernels.real_bytes
                              : 0;
    };
    for (const PathRow& row : path_rows) bytes += row_bytes(row);
    for (int r = 0; r < texture_rows; ++r) bytes += texture_bytes(r);
    bytes += row_bytes(path_rows[row_radiance]);
    memory_.resize(bytes);
    auto* next = memory_.data() + (64 - reinterpret_cast<std::uintptr_t>(memory_.data()) % 64);
    for (int r = 0; r < path_row_count; ++r) {
        planes_[r] = next;
        next += row_bytes(path_rows[r]);
    }
    retired_planes_ = planes_;
    retired_planes_[row_radiance] = next;
    next += row_bytes(path_rows[row_radiance]);
    for (int r = 0; r < texture_rows; ++r) {
        texture_planes_.push_back(next);
        next += texture_bytes(r);
    }
    view_.capacity = capacity;
    view_.planes = planes_.data();
    view_.texture_planes = texture_planes_.data();
    records_ = RecordViews(view_);
}

void Chunk::run(const PathView& results, int first_result, const void* item)
{
    const int shift = results.pixel_shift;
    const int at_once = std::min(results.samples, chunk_paths >> shift);
    std::vector<void*> result_planes;
    int row = 0;
#define OFFSET_RESULT(type, name)                                              \
    result_planes.push_back(static_cast<char*>(results.result_planes[row++]) + \
                            size_t(first_result) *                             \
                                (#type[0] == 'f' ? kernels_.real_bytes : sizeof(int)));
    RESULT_BUFFERS(OFFSET_RESULT)
#undef OFFSET_RESULT
    std::vector<void*> texture_result_planes;
    row = 0;
#define OFFSET_RESULT(type, name)                                                              \
    texture_result_planes.push_back(static_cast<char*>(results.texture_result_planes[row++]) + \
                                    size_t(first_result) *                                     \
                                        (#type[0] == 'f' ? kernels_.real_bytes : sizeof(int)));
    TEXTURE_RESULT_BUFFERS(OFFSET_RESULT)
#undef OFFSET_RESULT
    for (int first = 0; first < results.samples; first += at_once) {
        WorkItem part = *static_cast<const WorkItem*>(item);
        part.first_sample += first;
        view_.results = results.results;
        view_.samples = at_once;
        view_.pixel_shift = shift;
        view_.items = &part;
        view_.result_planes = result_planes.data();
        view_.texture_result_planes = texture_result_planes.data();
        const int count = at_once << shift;
        trace_paths(count);
        view_.planes = retired_planes_.data();
        for (view_.turn = 0; view_.turn < at_once; ++view_.turn) {
            run_stage(STAGE_accumulate, 1 << shift);
            if (scene_.effects & EFFECT_TEXTURE_AOV) run_stage(STAGE_accumulate_aovs, 1 << shift);
        }
        view_.planes = planes_.data();
        paths += std::uint64_t(count);
    }
}

void Chunk::trace_paths(int count)
{
    for (int i = 0; i < count; ++i) slots_[i] = i;
    bounce_ = 0;
    run_stage(STAGE_generate_paths, count);
    alive_ = count;
    for (int live = count; live > 0; ++bounce_) {
        slot_steps += std::uint64_t((live + packet - 1) / packet * packet);
        busy_steps += std::uint64_t(alive_);
        for_stages_of_bounce(scene_.effects, bounce_, [&](Stage stage) { run_stage(stage, live); });
        live = compact(live);
    }
}

void Chunk::run_stage(Stage stage, int count)
{
    const int undecided = records_.run(
        stage, scene_.effects, view_, count,
        [&](Stage launched, const PathView& view) { run_stage(launched, view, count); });
    undecided_rays += std::uint64_t(undecided);
}

void Chunk::run_stage(Stage stage, const PathView& view, int count)
{
    count_rays(stage, view, count);
    const auto start = std::chrono::steady_clock::now();
    if (const StageLoop loop = kernels_.loop(stage, scene_.effects))
        loop(scene_, view, 0, count);
    else if (stage == STAGE_intersect)
        rays += embree_->intersect(scene_, view, count, bounce_ == 0);
    else if (stage == STAGE_occlusion)
        shadow_rays += embree_->occlusion(scene_, view, count);
    else if (stage == STAGE_trace_texture_rays)
        shadow_rays += trace_texture_rays(*embree_, scene_, view, count);
    else if (stage == STAGE_evaluate_textures)
        scene_.textures->evaluate(scene_, view, 0, count);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    stage_seconds[stage] += elapsed.count();
}

// Of the walks of our own; Embree's packets count theirs.
void Chunk::count_rays(Stage stage, const PathView& view, int count)
{
    if (embree_ || view.lookup != LOOKUP_SURFACE) return;
    if (stage == STAGE_intersect) {
        const int* depth = static_cast<const int*>(view.planes[row_depth]);
        rays += std::uint64_t(std::count_if(depth, depth + count, [](int d) { return d >= 0; }));
    }
    if (stage == STAGE_occlusion) {
        const auto count_lit = [&](const auto* light) {
            for (int i = 0; i < count; ++i)
                shadow_rays +=
                    light[i] > 0 || light[capacity + i] > 0 || light[2 * capacity + i] > 0;
        };
        const void* light = view.planes[row_light_contribution];
        if (kernels_.real_bytes == 8)
            count_lit(static_cast<const double*>(light));
        else
            count_lit(static_cast<const float*>(light));
    }
}

// Ended paths hand in their radiance; when enough have ended, the others close ranks in order.
int Chunk::compact(int count)
{
    const auto start = std::chrono::steady_clock::now();
    const int* depth = static_cast<const int*>(planes_[row_depth]);
    int live = 0;
    for (int i = 0; i < count; ++i) {
        live_[live] = i;
        live += depth[i] >= 0 ? 1 : 0;
    }
    alive_ = live;
    int remaining = count;
    if (live == 0) {
        retire(count);
        remaining = 0;
    } else if (is_worth_compacting(live, count)) {
        retire(count);
        for (int r = 0; r < path_row_count; ++r) {
            if (path_rows[r].life != Life::carried) continue;
            for (int c = 0; c < path_rows[r].components; ++c) {
                if (path_rows[r].is_real && kernels_.real_bytes == 8)
                    gather_plane(static_cast<double*>(planes_[r]) + c * capacity, live_.data(),
                                 live);
                else
                    gather_plane(static_cast<std::uint32_t*>(planes_[r]) + c * capacity,
                                 live_.data(), live);
            }
        }
        gather_plane(slots_.data(), live_.data(), live);
        remaining = live;
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    stage_seconds[STAGE_compact] += elapsed.count();
    return remaining;
}

// Dead paths' radiance goes to their slots.
void Chunk::retire(int count)
{
    const int* depth = static_cast<const int*>(planes_[row_depth]);
    const void* in = planes_[row_radiance];
    void* out = retired_planes_[row_radiance];
    if (kernels_.real_bytes == 8)
        scatter_radiance(static_cast<double*>(out), static_cast<const double*>(in), slots_.data(),
                         depth, count);
    else
        scatter_radiance(static_cast<float*>(out), static_cast<const float*>(in), slots_.data(),
                         depth, count);
}

}  // namespace diptych
