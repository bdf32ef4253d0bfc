#include "backends/opencl_backend.hpp"

#include "backends/bvh_build.hpp"
#include "backends/kernel_sources.hpp"
#include "backends/opencl_memory.hpp"
#include "backends/opencl_programs.hpp"
#include "common/as_cpp/texture_lookups.hpp"
#include "common/as_cpp/texture_rows.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace diptych {
namespace {

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

class OpenclBackend final : public Backend {
public:
    OpenclBackend(const BackendOptions& options, const DeviceInfo& device);

    std::string description() const override;
    Plan plan(const SceneData& scene) const override;
    void upload(SceneData& scene) override;
    void update_materials(const SceneData& scene) override;
    void update_textures(const SceneData& scene) override;
    void render(const Dispatch& dispatch, Results& results) override;
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override;
    Statistics statistics() const override { return statistics_; }

private:
    struct Running {
        Stage stage;
        int paths;
        opencl::Event event;
    };

    void build_kernels(const SceneData& scene);
    void make_kernel(Stage stage);
    void bind_buffers(StageKernel& stage);
    void begin(const Dispatch& dispatch);
    // Paths to work on: those of a list, or the first `count` of all.
    struct Selection {
        int count = 0;
        const opencl::Buffer* list = nullptr;
    };

    void run(Stage stage, int count, bool is_compacted);
    void launch_over(Stage stage, int lookup, const Selection& paths);
    void show_records(StageKernel& kernel, Stage stage, int lookup);
    int compact(int count, bool is_compacted, bool keeps_order);
    int select(const opencl::Buffer& marks, const Selection& from, const opencl::Buffer* to);
    int groups_of(int paths) const;
    void launch(const opencl::Kernel& kernel, Stage stage, int paths, int groups);
    void collect_times();
    void download(Results& results);
    StageState state_after(Stage stage, int bounce);

    BackendOptions options_;
    DeviceInfo device_;
    opencl::Context context_;
    opencl::Queue queue_;
    ProgramCache cache_;
    int dispatches_ = 0;

    unsigned effects_ = 0;
    std::vector<opencl::Buffer> scene_;
    DispatchMemory memory_;
    std::vector<PlaneRow> texture_result_rows_;
    std::array<int, 5> texture_planes_{};  // of each row
    ProgramSet programs_;
    std::array<StageKernel, STAGE_COUNT> kernels_;
    opencl::Kernel compact_count_;
    opencl::Kernel compact_scan_;
    opencl::Kernel compact_write_;

    int paths_ = 0;  // of the dispatch that runs
    int results_ = 0;
    std::vector<Running> running_;
    Statistics statistics_;
};

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
    LOOKUP
};
int argument(Header header) { return first_header + header; }

// Place of a row among SCENE_BUFFERS.
int scene_row(const char* wanted)
{
    int row = 0, found = 0;
#define FIND_ROW(type, name)                          \
    if (std::strcmp(#name, wanted) == 0) found = row; \
    ++row;
    SCENE_BUFFERS(FIND_ROW)
#undef FIND_ROW
    return found;
}

constexpr int sentinel = int(0xcdcdcdcd);  // trace(): marks what no stage has written

OpenclBackend::OpenclBackend(const BackendOptions& options, const DeviceInfo& device)
    : options_(options), device_(device), context_(device_.device), queue_(context_.queue()),
      cache_(ProgramCache::default_folder())
{
}

std::string OpenclBackend::description() const
{
    std::string text = "opencl (" + device_.name + device_.part + ", " + device_.platform +
                       ", driver " + device_.driver;
    if (!device_.is_exact) text += "; division and square root are not exact on this device";
    if (options_.fast_math) text += "; fast math";
    if (!cache_.notice().empty()) text += "; " + cache_.notice();
    return text + ")";
}

Plan OpenclBackend::plan(const SceneData& scene) const
{
    return plan_memory(device_, scene, options_.memory_bytes);
}

void OpenclBackend::upload(SceneData& scene)
{
    const auto start = std::chrono::steady_clock::now();
    statistics_ = {};
    memory_ = {};
    if (scene.bvh_nodes.empty()) build_bvh(scene);
    scene_ = upload_scene(context_, queue_, device_, scene);
    build_kernels(scene);
    texture_result_rows_ = texture_result_rows(scene);
    texture_planes_ = texture_planes(scene);
    memory_ = DispatchMemory(context_, scene, plan(scene).items, device_.group_size);
    for (int k = 0; k < STAGE_COUNT; ++k)
        if (programs_.programs[k] && k != STAGE_compact) bind_buffers(kernels_[k]);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    statistics_.setup_seconds = elapsed.count();
}

void OpenclBackend::update_materials(const SceneData& scene)
{
    const opencl::Buffer& buffer = scene_[size_t(scene_row("materials"))];
    const size_t bytes = scene.materials.size() * sizeof scene.materials[0];
    if (bytes != buffer.bytes())
        throw std::runtime_error("opencl: the materials have changed in number; upload the scene");
    queue_.write(buffer, bytes, scene.materials.data());
    queue_.finish();
}

void OpenclBackend::update_textures(const SceneData& scene)
{
    if (!is_active(STAGE_evaluate_textures, effects_)) return;
    programs_.programs[STAGE_evaluate_textures] =
        build_texture_program(context_, device_, options_, scene, cache_);
    make_kernel(STAGE_evaluate_textures);
    bind_buffers(kernels_[STAGE_evaluate_textures]);
}

// Every kernel of a stage's program that is launched by itself; those of the compaction are not.
void OpenclBackend::make_kernel(Stage stage)
{
    const opencl::Program& program = *programs_.programs[stage];
    kernels_[stage].kernel = opencl::Kernel(program, std::string(stage_names[stage]) + "_entry");
    kernels_[stage].seconds_per_path = 0;
}

void OpenclBackend::build_kernels(const SceneData& scene)
{
    effects_ = scene.effects;
    programs_ = build_programs(context_, device_, options_, scene, cache_);
    for (int k = 0; k < STAGE_COUNT; ++k)
        if (programs_.programs[k] && k != STAGE_compact) make_kernel(Stage(k));
    kernels_[STAGE_compact].seconds_per_path = 0;
    const opencl::Program& compaction = *programs_.programs[STAGE_compact];
    compact_count_ = opencl::Kernel(compaction, "compact_count");
    compact_scan_ = opencl::Kernel(compaction, "compact_scan");
    compact_write_ = opencl::Kernel(compaction, "compact_write");
}

void OpenclBackend::bind_buffers(StageKernel& stage)
{
    int index = 0;
    for (const auto* buffers : {&scene_, &memory_.path_planes, &memory_.result_planes,
                                &memory_.texture_planes, &memory_.texture_result_planes})
        for (const opencl::Buffer& buffer : *buffers) stage.kernel.set(index++, buffer);
    stage.kernel.set(argument(ITEMS), memory_.items);
    stage.kernel.set(argument(LIVE), memory_.live[0]);
    stage.kernel.set(argument(LOOKUP), LOOKUP_SURFACE);
    stage.lookup = LOOKUP_SURFACE;
}

void OpenclBackend::begin(const Dispatch& dispatch)
{
    if (++dispatches_ == device_.fails_at)
        throw std::runtime_error("opencl: fails, as DIPTYCH_FAIL_AT asks");
    paths_ = dispatch.paths();
    results_ = dispatch.results();
    if (paths_ > memory_.paths || results_ > memory_.results ||
        dispatch.items.size_bytes() > memory_.items.bytes())
        throw std::runtime_error("opencl: a dispatch of " + std::to_string(dispatch.items.size()) +
                                 " items, " + std::to_string(paths_) +
                                 " paths, exceeds the plan's " + std::to_string(memory_.paths));
    queue_.write(memory_.items, dispatch.items.size_bytes(), dispatch.items.data());
    for (int k = 0; k < STAGE_COUNT; ++k) {
        if (!programs_.programs[k] || k == STAGE_compact) continue;
        opencl::Kernel& kernel = kernels_[k].kernel;
        kernel.set(argument(CAPACITY), paths_);
        kernel.set(argument(RESULTS), results_);
        kernel.set(argument(SAMPLES), dispatch.samples);
        kernel.set(argument(PIXEL_SHIFT), dispatch.pixel_shift);
    }
    // written, not filled: Oclgrind does not notice that fills initialise
    const auto start = [&](const PlaneRow& row, const opencl::Buffer& buffer) {
        const int value = std::strstr(row.name, "_id") ? -1 : 0;
        const std::vector<int> plane(size_t(row.components) * size_t(results_), value);
        if (!plane.empty()) queue_.write(buffer, plane.size() * sizeof plane[0], plane.data());
    };
    for (size_t r = 0; r < result_rows().size(); ++r)
        start(result_rows()[r], memory_.result_planes[r]);
    for (size_t r = 0; r < texture_result_rows_.size(); ++r)
        start(texture_result_rows_[r], memory_.texture_result_planes[r]);
    statistics_.paths += unsigned(paths_);
}

// Binds the planes of the records in the place of the path's own, or these again.
void OpenclBackend::show_records(StageKernel& runs, Stage stage, int lookup)
{
    if (runs.lookup == lookup) return;
    runs.lookup = lookup;
    runs.kernel.set(argument(LOOKUP), lookup);
    const int first = int(scene_.size());
    const bool is_own = !is_over_records(stage, lookup);
    for (const StandIn& record : lookup == LOOKUP_ALPHA ? path_records : shadow_records) {
        const std::vector<opencl::Buffer>& planes =
            record.is_texture_row && !is_own ? memory_.texture_planes : memory_.path_planes;
        runs.kernel.set(first + record.row, planes[size_t(is_own ? record.row : record.by)]);
    }
}

// A stage, with the lookups of textures that belong to it.
void OpenclBackend::run(Stage stage, int count, bool is_compacted)
{
    const Selection all{count, is_compacted ? &memory_.live[0] : nullptr};
    Selection waiting = all;
    int turn = 0;
    const auto launch = [&](Stage launched, int lookup) {
        const bool is_rounds = lookup == LOOKUP_ALPHA || lookup == LOOKUP_SHADOW;
        launch_over(launched, lookup, is_rounds ? waiting : all);
    };
    const auto count_waiting = [&] {
        const opencl::Buffer& list = memory_.waiting[turn];
        turn = 1 - turn;
        waiting = {select(memory_.texture_planes[row_record_triangle], waiting, &list), &list};
        return waiting.count;
    };
    const int undecided = run_with_lookups(stage, effects_, launch, count_waiting);
    statistics_.undecided_rays += unsigned(undecided);
}

void OpenclBackend::launch_over(Stage stage, int lookup, const Selection& paths)
{
    StageKernel& runs = kernels_[stage];
    show_records(runs, stage, lookup);
    runs.kernel.set(argument(LIVE), paths.list ? *paths.list : memory_.live[0]);
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

// The number of live paths; their list becomes live[0], unless the order is to be kept.
int OpenclBackend::compact(int count, bool is_compacted, bool keeps_order)
{
    const Selection from{count, is_compacted ? &memory_.live[0] : nullptr};
    const opencl::Buffer& depth = memory_.path_planes[row_depth];
    const int live = select(depth, from, keeps_order ? nullptr : &memory_.live[1]);
    if (!keeps_order) std::swap(memory_.live[0], memory_.live[1]);
    return live;
}

// How many paths have a mark that is not negative; their list goes to `to`, if there is one.
int OpenclBackend::select(const opencl::Buffer& marks, const Selection& from,
                          const opencl::Buffer* to)
{
    for (opencl::Kernel* kernel : {&compact_count_, &compact_write_}) {
        kernel->set(0, marks);
        kernel->set(1, from.list ? *from.list : memory_.live[0]);
        kernel->set(2, from.list ? 1 : 0);
        kernel->set(3, from.count);
        kernel->set(4, memory_.sums);
    }
    launch(compact_count_, STAGE_compact, from.count, groups_of(from.count));
    compact_scan_.set(0, memory_.sums);
    compact_scan_.set(1, groups_of(from.count));
    compact_scan_.set(2, memory_.total);
    launch(compact_scan_, STAGE_compact, from.count, 1);
    if (to) {
        compact_write_.set(5, *to);
        launch(compact_write_, STAGE_compact, from.count, groups_of(from.count));
    }
    int selected = 0;
    queue_.read(memory_.total, sizeof selected, &selected);
    collect_times();
    return selected;
}

int OpenclBackend::groups_of(int paths) const
{
    return (paths + device_.group_size - 1) / device_.group_size;
}

void OpenclBackend::launch(const opencl::Kernel& kernel, Stage stage, int paths, int groups)
{
    opencl::Event event = queue_.launch(kernel, size_t(groups), size_t(device_.group_size));
    running_.push_back({stage, paths, std::move(event)});
}

void OpenclBackend::collect_times()
{
    queue_.finish();
    for (const Running& launch : running_) {
        const double seconds = launch.event.seconds();
        statistics_.stage_seconds[stage_names[launch.stage]] += seconds;
        kernels_[launch.stage].measured(seconds, launch.paths);
    }
    running_.clear();
}

void OpenclBackend::download(Results& results)
{
    const auto read = [&](auto& to, const PlaneRow& row, const opencl::Buffer& buffer) {
        to.resize(size_t(row.components) * size_t(results_));
        if (!to.empty()) queue_.read(buffer, to.size() * sizeof to[0], to.data());
    };
    size_t row = 0;
#define READ_RESULT(type, name) \
    read(results.name, result_rows()[row], memory_.result_planes[row]), ++row;
    RESULT_BUFFERS(READ_RESULT)
#undef READ_RESULT
    row = 0;
#define READ_RESULT(type, name) \
    read(results.name, texture_result_rows_[row], memory_.texture_result_planes[row]), ++row;
    TEXTURE_RESULT_BUFFERS(READ_RESULT)
#undef READ_RESULT
}

void OpenclBackend::render(const Dispatch& dispatch, Results& results)
{
    begin(dispatch);
    const auto run_all = [&](When when, int count, bool is_compacted) {
        for (int k = 0; k < STAGE_COUNT; ++k)
            if (stage_when(Stage(k)) == when && is_active(Stage(k), effects_))
                run(Stage(k), count, is_compacted);
    };
    run_all(When::once, paths_, false);
    int live = paths_;
    for (int bounce = 0; live > 0; ++bounce)
        for (int k = 0; k < STAGE_COUNT; ++k) {
            const Stage stage = Stage(k);
            const When when = stage_when(stage);
            const bool is_due =
                when == When::each_bounce || (when == When::first_bounce && bounce == 0);
            if (!is_due || !is_active(stage, effects_)) continue;
            if (stage == STAGE_compact)
                live = compact(live, bounce > 0, false);
            else
                run(stage, live, bounce > 0);
        }
    run_all(When::at_end, results_, false);
    download(results);
    collect_times();
}

StageState OpenclBackend::state_after(Stage stage, int bounce)
{
    StageState state{stage, bounce, paths_, {}};
    std::vector<std::uint32_t> words;
    for (size_t r = 0; r < size_t(path_row_count); ++r) {
        words.resize(size_t(path_rows[r].components) * size_t(paths_));
        queue_.read(memory_.path_planes[r], words.size() * sizeof words[0], words.data());
        std::vector<double> plane;
        const bool is_defined = std::any_of(words.begin(), words.end(), [](std::uint32_t word) {
            return word != std::uint32_t(sentinel);
        });
        if (is_defined) {
            plane.reserve(words.size());
            for (const std::uint32_t word : words) {
                float real;
                std::memcpy(&real, &word, sizeof real);
                plane.push_back(path_rows[r].is_real ? double(real) : double(int(word)));
            }
        }
        state.planes.push_back(std::move(plane));
    }
    if (const int row = texture_row_of(stage); row >= 0) {
        const size_t planes = size_t(texture_planes_[size_t(row)]);
        std::vector<float> results(planes * size_t(paths_));
        queue_.read(memory_.texture_planes[size_t(row)], results.size() * sizeof results[0],
                    results.data());
        state.texture_results.assign(results.begin(), results.end());
    }
    return state;
}

void OpenclBackend::trace(const Dispatch& dispatch,
                          const std::function<void(const StageState&)>& after_stage)
{
    begin(dispatch);
    for (const opencl::Buffer& plane : memory_.path_planes)
        queue_.fill(plane, plane.bytes(), sentinel);
    for (const opencl::Buffer& plane : memory_.texture_planes) queue_.fill(plane, plane.bytes(), 0);
    int live = paths_;
    for (int bounce = 0; live > 0; ++bounce)
        for (int k = 0; k < STAGE_COUNT && live > 0; ++k) {
            const Stage stage = Stage(k);
            const When when = stage_when(stage);
            const bool is_first = when == When::once || when == When::first_bounce;
            const bool is_due = when == When::each_bounce || (is_first && bounce == 0);
            if (!is_due || !is_active(stage, effects_)) continue;
            if (stage == STAGE_compact) {
                live = compact(paths_, false, true);
                continue;
            }
            run(stage, paths_, false);
            collect_times();
            after_stage(state_after(stage, bounce));
        }
}

}  // namespace

std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options)
{
    return make_opencl_backend(options, pick_opencl_device(options.device));
}

std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options,
                                             const DeviceInfo& device)
{
    return std::make_unique<OpenclBackend>(options, device);
}

}  // namespace diptych
