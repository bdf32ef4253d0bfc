#include "backends/opencl_stages.hpp"

#include "backends/kernel_sources.hpp"
#include "common/as_cpp/texture_lookups.hpp"

#include <algorithm>

namespace diptych {
namespace {

// Arguments behind the buffers, in the order of kernels_cl/arguments.h.
const int first_header = [] {
    int rows = 0;
#define COUNT_ROW(...) ++rows;
    SCENE_BUFFERS(COUNT_ROW)
    PATH_BUFFERS(COUNT_ROW)
    RESULT_BUFFERS(COUNT_ROW)
    TEXTURE_BUFFERS(COUNT_ROW)
    TEXTURE_RESULT_BUFFERS(COUNT_ROW)
#undef COUNT_ROW
    return rows;
}();
enum Header {
    ITEMS,
    LIVE,
    CAPACITY,
    RESULTS,
    SAMPLES,
    PIXEL_SHIFT,
    FIRST,
    COUNT,
    IS_COMPACTED,
    LOOKUP,
    NEXT_ENTRY
};
int argument(Header header) { return first_header + header; }

}  // namespace

// Every kernel of a stage's program that is launched by itself; those of the compaction are not.
void OpenclStages::make_kernel(Stage stage)
{
    const opencl::Program& program = *programs_.programs[stage];
    kernels_[stage].kernel = opencl::Kernel(program, std::string(stage_names[stage]) + "_entry");
    kernels_[stage].seconds_per_path = 0;
}

void OpenclStages::build(const opencl::Context& context, const SceneData& scene,
                         ProgramCache& cache)
{
    effects_ = scene.effects;
    programs_ = build_programs(context, device_, options_, scene, cache);
    for (int k = 0; k < STAGE_COUNT; ++k)
        if (programs_.programs[k] && k != STAGE_compact) make_kernel(Stage(k));
    kernels_[STAGE_compact].seconds_per_path = 0;
    const opencl::Program& compaction = *programs_.programs[STAGE_compact];
    compact_count_ = opencl::Kernel(compaction, "compact_count");
    compact_scan_ = opencl::Kernel(compaction, "compact_scan");
    compact_write_ = opencl::Kernel(compaction, "compact_write");
}

void OpenclStages::bind_buffers(StageKernel& stage)
{
    int index = 0;
    for (const auto* buffers : {&scene_->rows, &memory_->path_planes, &memory_->result_planes,
                                &memory_->texture_planes, &memory_->texture_result_planes})
        for (const opencl::Buffer& buffer : *buffers) stage.kernel.set(index++, buffer);
    stage.kernel.set(argument(ITEMS), memory_->items);
    stage.kernel.set(argument(LIVE), memory_->live[0]);
    stage.kernel.set(argument(LOOKUP), LOOKUP_SURFACE);
    stage.lookup = LOOKUP_SURFACE;
    index = argument(NEXT_ENTRY);
    for (const opencl::Buffer& page : scene_->pages)  // where there is none, any buffer does
        stage.kernel.set(++index, page.bytes() > 0 ? page : scene_->rows[0]);
}

void OpenclStages::build_textures(const opencl::Context& context, const SceneData& scene,
                                  ProgramCache& cache)
{
    programs_.programs[STAGE_evaluate_textures] =
        build_texture_program(context, device_, options_, scene, cache);
    make_kernel(STAGE_evaluate_textures);
}

void OpenclStages::bind(const SceneMemory& scene, const DispatchMemory& memory)
{
    scene_ = &scene;
    memory_ = &memory;
    for (int k = 0; k < STAGE_COUNT; ++k)
        if (is_launched(k)) bind_buffers(kernels_[size_t(k)]);
}

void OpenclStages::begin(const Dispatch& dispatch, int capacity, int next_entry)
{
    for (int k = 0; k < STAGE_COUNT; ++k) {
        if (!is_launched(k)) continue;
        opencl::Kernel& kernel = kernels_[size_t(k)].kernel;
        kernel.set(argument(CAPACITY), capacity);
        kernel.set(argument(RESULTS), memory_->results);
        kernel.set(argument(SAMPLES), dispatch.samples);
        kernel.set(argument(PIXEL_SHIFT), dispatch.pixel_shift);
        kernel.set(argument(NEXT_ENTRY), next_entry);
    }
}

void OpenclStages::begin_entries(const Selection& slots, int first_entry)
{
    opencl::Kernel& kernel = kernels_[STAGE_generate_paths].kernel;
    kernel.set(argument(NEXT_ENTRY), first_entry);
    launch_over(STAGE_generate_paths, LOOKUP_SURFACE, slots);
    kernel.set(argument(NEXT_ENTRY), follow_up);
}

// Binds the planes of the records in the place of the path's own, or these again.
void OpenclStages::show_records(StageKernel& runs, Stage stage, int lookup)
{
    if (runs.lookup == lookup) return;
    runs.lookup = lookup;
    runs.kernel.set(argument(LOOKUP), lookup);
    const int first = int(scene_->rows.size());
    const bool is_own = !is_over_records(stage, lookup);
    const bool is_on_path = LOOKUP_PLACE(lookup) == LOOKUP_ALPHA;
    for (const StandIn& record : is_on_path ? path_records : shadow_records) {
        const std::vector<opencl::Buffer>& planes =
            record.is_texture_row && !is_own ? memory_->texture_planes : memory_->path_planes;
        runs.kernel.set(first + record.row, planes[size_t(is_own ? record.row : record.by)]);
    }
}

// A stage, with the lookups of textures that belong to it.
void OpenclStages::run(Stage stage, const Selection& all)
{
    Selection waiting = all;
    int turn = 0;
    const auto launch = [&](Stage launched, int lookup) {
        const int place = LOOKUP_PLACE(lookup);
        const bool is_rounds = place == LOOKUP_ALPHA || place == LOOKUP_SHADOW;
        launch_over(launched, lookup, is_rounds ? waiting : all);
    };
    const auto count_waiting = [&] {
        const opencl::Buffer& list = memory_->waiting[turn];
        turn = 1 - turn;
        waiting = {select(memory_->texture_planes[row_record_triangle], waiting, &list), &list};
        return waiting.count;
    };
    const int undecided = run_with_lookups(stage, effects_, launch, count_waiting);
    statistics_.undecided_rays += unsigned(undecided);
}

void OpenclStages::launch_over(Stage stage, int lookup, const Selection& paths)
{
    StageKernel& runs = kernels_[stage];
    show_records(runs, stage, lookup);
    runs.kernel.set(argument(LIVE), paths.list ? *paths.list : memory_->live[0]);
    runs.kernel.set(argument(IS_COMPACTED), paths.list ? 1 : 0);
    for (int first = 0; first < paths.count;) {
        const double allowed = 1e-3 * options_.launch_milliseconds;
        const int launched = std::min(paths.count - first, runs.paths_per_launch(allowed));
        runs.kernel.set(argument(FIRST), first);
        runs.kernel.set(argument(COUNT), launched);
        launch(runs.kernel, stage, launched, groups_of(launched));
        if (runs.seconds_per_path <= 0) collect_times();
        first += launched;
    }
    if (stage == STAGE_intersect) statistics_.rays += unsigned(paths.count);
    if (stage == STAGE_occlusion) statistics_.shadow_rays += unsigned(paths.count);
}

int OpenclStages::select(const opencl::Buffer& marks, const Selection& from,
                         const opencl::Buffer* to, bool wants_live)
{
    for (opencl::Kernel* kernel : {&compact_count_, &compact_write_}) {
        kernel->set(0, marks);
        kernel->set(1, from.list ? *from.list : memory_->live[0]);
        kernel->set(2, from.list ? 1 : 0);
        kernel->set(3, from.count);
        kernel->set(4, memory_->sums);
        kernel->set(5, wants_live ? 1 : 0);
    }
    launch(compact_count_, STAGE_compact, from.count, groups_of(from.count));
    compact_scan_.set(0, memory_->sums);
    compact_scan_.set(1, groups_of(from.count));
    compact_scan_.set(2, memory_->total);
    launch(compact_scan_, STAGE_compact, from.count, 1);
    if (to) {
        compact_write_.set(6, *to);
        launch(compact_write_, STAGE_compact, from.count, groups_of(from.count));
    }
    int selected = 0;
    queue_.read(memory_->total, sizeof selected, &selected);
    collect_times();
    return selected;
}

int OpenclStages::groups_of(int paths) const
{
    return (paths + device_.group_size - 1) / device_.group_size;
}

void OpenclStages::launch(const opencl::Kernel& kernel, Stage stage, int paths, int groups)
{
    opencl::Event event = queue_.launch(kernel, size_t(groups), size_t(device_.group_size));
    running_.push_back({stage, paths, std::move(event)});
}

void OpenclStages::collect_times()
{
    queue_.finish();
    for (const Running& launch : running_) {
        const double seconds = launch.event.seconds();
        statistics_.stage_seconds[stage_names[launch.stage]] += seconds;
        kernels_[launch.stage].measured(seconds, launch.paths);
    }
    running_.clear();
}

}  // namespace diptych
