#include "kernels_cpu/chunk.hpp"

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

// Compaction costs about as much as a stage on a tenth of the paths; without it, dead ones would
// run through all stages of the next bounces, those that have only missed through three of this
// one.
bool is_worth_compacting(int live, int count) { return live <= count - count / 16; }
bool is_worth_parting(int met, int count) { return met <= count - count / 4; }

void add_range(std::vector<PathRange>& ranges, int first, int count)
{
    if (!ranges.empty() && ranges.back().first + ranges.back().count == first)
        ranges.back().count += count;
    else if (count > 0)
        ranges.push_back({first, count});
}

// Closes ranks: `front` of `count` paths, in ascending order, then the others that `from` lists.
template<class Value>
void gather_plane(Value* plane, const int* from, int front, int count)
{
    Value back[chunk_paths];
    for (int k = front; k < count; ++k) back[k] = plane[from[k]];
    for (int k = 0; k < front; ++k) plane[k] = plane[from[k]];
    std::copy(back + front, back + count, plane + front);
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
      retired_planes_(path_row_count), slots_(chunk_paths), order_(chunk_paths)
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

void Chunk::run(const PathView& results, int first_item, int items)
{
    const int shift = results.pixel_shift;
    const size_t first_result = size_t(first_item) << shift;
    const int at_once = std::min(results.samples, chunk_paths >> shift);
    std::vector<void*> result_planes;
    int row = 0;
#define OFFSET_RESULT(type, name)                                              \
    result_planes.push_back(static_cast<char*>(results.result_planes[row++]) + \
                            first_result * (#type[0] == 'f' ? kernels_.real_bytes : sizeof(int)));
    RESULT_BUFFERS(OFFSET_RESULT)
#undef OFFSET_RESULT
    std::vector<void*> texture_result_planes;
    row = 0;
#define OFFSET_RESULT(type, name)                                                              \
    texture_result_planes.push_back(static_cast<char*>(results.texture_result_planes[row++]) + \
                                    first_result *                                             \
                                        (#type[0] == 'f' ? kernels_.real_bytes : sizeof(int)));
    TEXTURE_RESULT_BUFFERS(OFFSET_RESULT)
#undef OFFSET_RESULT
    const WorkItem* first_part = static_cast<const WorkItem*>(results.items) + first_item;
    std::vector<WorkItem> parts(first_part, first_part + items);
    for (int first = 0; first < results.samples; first += at_once) {
        view_.results = results.results;
        view_.samples = at_once;
        view_.pixel_shift = shift;
        view_.items = parts.data();
        view_.result_planes = result_planes.data();
        view_.texture_result_planes = texture_result_planes.data();
        const int count = (items * at_once) << shift;
        trace_paths(count);
        view_.planes = retired_planes_.data();
        for (view_.turn = 0; view_.turn < at_once; ++view_.turn) {
            run_stage(STAGE_accumulate, items << shift);
            if (scene_.effects & EFFECT_TEXTURE_AOV)
                run_stage(STAGE_accumulate_aovs, items << shift);
        }
        view_.planes = planes_.data();
        for (WorkItem& part : parts) part.first_sample += at_once;
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
        for_stages_of_bounce(scene_.effects, bounce_, [&](Stage stage) {
            run_stage(stage, live);
            if (stage == STAGE_intersect) find_surfaces(live);
        });
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
    const StageLoop loop = kernels_.loop(stage, scene_.effects);
    if (const StageLoop missed = kernels_.missed(stage)) {
        for (const PathRange& range : surfaces_) loop(scene_, view, range.first, range.count);
        for (const PathRange& range : misses_) missed(scene_, view, range.first, range.count);
    } else if (loop)
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

// Where many rays have met nothing, the stages of surfaces leave them out: those of the camera by
// groups, since neighbours in the picture miss together and have to stay in their slots; later ones
// go behind the others.
void Chunk::find_surfaces(int count)
{
    const auto start = std::chrono::steady_clock::now();
    const int* hit = static_cast<const int*>(planes_[row_hit_triangle]);
    const auto has_missed = [](int triangle) { return triangle < 0; };
    const int met = count - int(std::count_if(hit, hit + count, has_missed));
    surfaces_.clear();
    misses_.clear();
    if (!is_worth_parting(met, count)) {
        add_range(surfaces_, 0, count);
    } else if (bounce_ == 0) {
        for (int first = 0; first < count; first += packet) {
            const int size = std::min(packet, count - first);
            const bool is_empty = std::all_of(hit + first, hit + first + size, has_missed);
            add_range(is_empty ? misses_ : surfaces_, first, size);
        }
    } else {
        int front = 0, back = met;
        for (int i = 0; i < count; ++i) order_[has_missed(hit[i]) ? back++ : front++] = i;
        gather_carried(met, count);
        gather(path_rows[row_hit_triangle], met, count);
        gather(path_rows[row_hit_instance], met, count);
        add_range(surfaces_, 0, met);
        add_range(misses_, met, count - met);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    stage_seconds[STAGE_compact] += elapsed.count();
}

// By order_.
void Chunk::gather(const PathRow& row, int front, int count)
{
    void* planes = planes_[size_t(&row - path_rows)];
    for (int c = 0; c < row.components; ++c) {
        if (row.is_real && kernels_.real_bytes == 8)
            gather_plane(static_cast<double*>(planes) + c * capacity, order_.data(), front, count);
        else
            gather_plane(static_cast<std::uint32_t*>(planes) + c * capacity, order_.data(), front,
                         count);
    }
}

void Chunk::gather_carried(int front, int count)
{
    for (const PathRow& row : path_rows)
        if (row.life == Life::carried) gather(row, front, count);
    gather_plane(slots_.data(), order_.data(), front, count);
}

// Ended paths hand in their radiance; when enough have ended, the others close ranks in order.
int Chunk::compact(int count)
{
    const auto start = std::chrono::steady_clock::now();
    const int* depth = static_cast<const int*>(planes_[row_depth]);
    int live = 0;
    for (int i = 0; i < count; ++i) {
        order_[live] = i;
        live += depth[i] >= 0 ? 1 : 0;
    }
    alive_ = live;
    int remaining = count;
    if (live == 0) {
        retire(count);
        remaining = 0;
    } else if (is_worth_compacting(live, count)) {
        retire(count);
        gather_carried(live, live);
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
