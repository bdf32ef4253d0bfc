#include "backends/opencl_backend.hpp"

#include "backends/bvh_build.hpp"
#include "backends/kernel_sources.hpp"
#include "backends/opencl_memory.hpp"
#include "backends/opencl_stages.hpp"
#include "common/as_cpp/path_rows.hpp"
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

using Selection = OpenclStages::Selection;

class OpenclBackend final : public Backend {
public:
    OpenclBackend(const BackendOptions& options, const DeviceInfo& device);

    std::string description() const override;
    Plan plan(const SceneData& scene) const override;
    void upload(SceneData& scene) override;
    void update_materials(const SceneData& scene) override;
    void update_textures(const SceneData& scene) override;
    void render(const Dispatch& dispatch, Results& results) override
    {
        advance(dispatch, {}, results);
    }
    int advance(const Dispatch& dispatch, const Pace& pace, Results& results) override;
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override;
    Statistics statistics() const override { return statistics_; }

private:
    void begin(const Dispatch& dispatch, int capacity, int next_entry);

    // What is under way between dispatches: the items that have begun and are not done, and their
    // sums so far.
    struct Flight {
        std::vector<WorkItem> items;
        int samples = 0;
        int pixel_shift = 0;
        Results sums;
    };
    bool goes_on(const Flight& flight, const Dispatch& dispatch) const;
    void run_bounce();
    void add_slots(int slots);
    void begin_entries(const Selection& slots, int first_entry);
    Selection live() const { return {live_, is_compacted_ ? &memory_.live[0] : nullptr}; }
    void refill(int end);
    int settle(const Dispatch& dispatch, bool is_left, Results& results);
    std::vector<int> slots_of(int row);
    int first_in_flight();
    StageState state_after(Stage stage, int bounce, int paths);

    BackendOptions options_;
    DeviceInfo device_;
    opencl::Context context_;
    opencl::Queue queue_;
    ProgramCache cache_;
    int dispatches_ = 0;

    SceneMemory scene_;
    DispatchMemory memory_;
    std::array<int, texture_rows> texture_planes_{};  // of each row
    OpenclStages stages_;
    unsigned effects_ = 0;
    Settings picture_{};

    int slots_ = 0;  // of the dispatch that runs
    int live_ = 0;   // of these: listed in live[0], or the first ones
    bool is_compacted_ = false;
    int begun_ = 0;  // result entries
    Flight flight_;  // of the last dispatch
    Statistics statistics_;
};

constexpr int sample_none = -1;     // as in kernels_cl/arguments.h
constexpr int entries_a_slot = 32;  // of a list: fewer leave its slots idle at the end too long
constexpr int steps_to_refill = 2;  // the device waits for the host then; an entry lives for dozens
constexpr int steps_to_leave = 8;   // for the host's next list; leaving copies sums out and back
constexpr int least_slots_of_cpu = 1 << 13;
constexpr int least_slots_a_unit = 1 << 11;

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
      cache_(ProgramCache::default_folder()), stages_(options_, device_, queue_, statistics_)
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
    flight_ = {};
    if (scene.bvh_nodes.empty()) build_bvh(scene);
    scene_ = upload_scene(context_, queue_, device_, scene);
    effects_ = scene.effects;
    picture_ = scene.settings[0];
    stages_.build(context_, scene, cache_);
    texture_planes_ = texture_planes(scene);
    memory_ = DispatchMemory(context_, scene, plan(scene), device_.group_size);
    stages_.bind(scene_, memory_);
    statistics_.allocated_bytes = bytes_of(scene_.rows) + bytes_of(scene_.pages) + memory_.bytes();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    statistics_.setup_seconds = elapsed.count();
}

void OpenclBackend::update_materials(const SceneData& scene)
{
    flight_ = {};
    const opencl::Buffer& buffer = scene_.rows[size_t(scene_row("materials"))];
    const size_t bytes = scene.materials.size() * sizeof scene.materials[0];
    if (bytes != buffer.bytes())
        throw std::runtime_error("opencl: the materials have changed in number; upload the scene");
    queue_.write(buffer, bytes, scene.materials.data());
    queue_.finish();
}

void OpenclBackend::update_textures(const SceneData& scene)
{
    if (!is_active(STAGE_evaluate_textures, effects_)) return;
    flight_ = {};
    stages_.build_textures(context_, scene, cache_);
    stages_.bind(scene_, memory_);
}

// capacity: the distance between planes of a path's row.
void OpenclBackend::begin(const Dispatch& dispatch, int capacity, int next_entry)
{
    if (++dispatches_ == device_.fails_at)
        throw std::runtime_error("opencl: fails, as DIPTYCH_FAIL_AT asks");
    if (capacity > memory_.paths || dispatch.results() > memory_.results ||
        dispatch.items.size_bytes() > memory_.items.bytes())
        throw std::runtime_error("opencl: a dispatch of " + std::to_string(dispatch.items.size()) +
                                 " items exceeds the plan's " +
                                 std::to_string(memory_.results >> (2 * BLOCK_SHIFT)));
    queue_.write(memory_.items, dispatch.items.size_bytes(), dispatch.items.data());
    stages_.begin(dispatch, capacity, next_entry);
    memory_.clear_texture_results(queue_);
}

bool OpenclBackend::goes_on(const Flight& flight, const Dispatch& dispatch) const
{
    return !flight.items.empty() &&
           begins_with(dispatch, flight.items, flight.samples, flight.pixel_shift);
}

int OpenclBackend::advance(const Dispatch& dispatch, const Pace& pace, Results& results)
{
    const Flight flight = std::exchange(flight_, {});
    begin(dispatch, memory_.paths, OpenclStages::follow_up);
    int end = dispatch.results();
    const int least = device_.is_cpu ? least_slots_of_cpu : least_slots_a_unit * device_.units;
    const size_t entries = (dispatch.items.size() + pace.following) << dispatch.pixel_shift;
    const size_t wanted = std::max(size_t(least), entries / entries_a_slot);
    const int slots = int(std::min({wanted, size_t(end), size_t(memory_.paths)}));
    if (goes_on(flight, dispatch)) {
        memory_.write_results(queue_, flight.sums, begun_);
        add_slots(slots);
        refill(end);
    } else {
        slots_ = live_ = slots;
        begun_ = 0;
        is_compacted_ = false;
        begin_entries({slots_, nullptr}, 0);
    }
    bool is_left = false;
    for (int step = 1; live_ > 0 && !is_left; ++step) {
        run_bounce();
        const Wish wish = pace.wish ? pace.wish() : Wish::go_on;
        const int whole = (1 << dispatch.pixel_shift) - 1;
        if (wish == Wish::finish) end = std::min(end, (begun_ + whole) & ~whole);
        if (begun_ == end || step % steps_to_refill == 0) refill(end);
        const bool is_list_short = pace.following > 0 && wish == Wish::go_on && begun_ == end &&
                                   live_ < slots_ - slots_ / 8 && step % steps_to_leave == 0;
        is_left = live_ > 0 && (wish == Wish::leave || is_list_short);
    }
    const int done = settle(dispatch, is_left, results);
    stages_.collect_times();
    return done;
}

// Up to `slots`, free ones: the list has become longer than it was when the others were chosen.
void OpenclBackend::add_slots(int slots)
{
    if (slots <= slots_) return;
    const std::vector<int> free(size_t(slots - slots_), sample_none);
    for (const int row : {row_depth, row_sample})
        queue_.write(memory_.path_planes[size_t(row)], free.size() * sizeof free[0], free.data(),
                     size_t(slots_) * sizeof free[0]);
    slots_ = slots;
}

void OpenclBackend::begin_entries(const Selection& slots, int first_entry)
{
    stages_.begin_entries(slots, first_entry);
    begun_ += slots.count;
}

// All paths to their next surface; those that have ended are summed up, and go on with their
// pixel's next sample.
void OpenclBackend::run_bounce()
{
    statistics_.slot_steps += unsigned(slots_);
    statistics_.busy_steps += unsigned(live_);
    const auto run_all = [&](auto is_due) {
        for (int k = 0; k < STAGE_COUNT; ++k)
            if (k != STAGE_compact && is_due(stage_when(Stage(k))) && is_active(Stage(k), effects_))
                stages_.run(Stage(k), live());
    };
    run_all([](When when) { return is_of_bounce(when) || when == When::first_bounce; });
    run_all([](When when) { return when == When::at_end; });
    stages_.run(STAGE_generate_paths, live());
}

// Free slots take the next result entries before `end`; those that get none are left out.
void OpenclBackend::refill(int end)
{
    const opencl::Buffer& depth = memory_.path_planes[row_depth];
    if (begun_ == end) {
        live_ = stages_.select(depth, live(), &memory_.live[1]);
        std::swap(memory_.live[0], memory_.live[1]);
        is_compacted_ = true;
        return;
    }
    const Selection all{slots_, nullptr};
    const int free = stages_.select(depth, all, &memory_.live[1], false);
    const int taken = std::min(free, end - begun_);
    if (taken > 0) begin_entries({taken, &memory_.live[1]}, begun_);
    is_compacted_ = taken < free;
    live_ = is_compacted_ ? stages_.select(depth, all, &memory_.live[0]) : slots_;
}

std::vector<int> OpenclBackend::slots_of(int row)
{
    std::vector<int> plane(static_cast<size_t>(slots_));
    queue_.read(memory_.path_planes[size_t(row)], plane.size() * sizeof plane[0], plane.data());
    return plane;
}

// The result entry before which all are done.
int OpenclBackend::first_in_flight()
{
    const std::vector<int> sample = slots_of(row_sample), entry = slots_of(row_entry);
    int first = begun_;
    for (size_t slot = 0; slot < sample.size(); ++slot)
        if (sample[slot] != sample_none) first = std::min(first, entry[slot]);
    return first;
}

// Hands over the items that are done, and keeps the others for the next dispatch where it is left.
int OpenclBackend::settle(const Dispatch& dispatch, bool is_left, Results& results)
{
    const int shift = dispatch.pixel_shift;
    const int done = (is_left ? first_in_flight() : begun_) >> shift;
    const int moved = done << shift;
    memory_.read_results(queue_, results, 0, moved);
    statistics_.paths += paths_in_picture(dispatch, done, picture_);
    if (!is_left) return done;
    const size_t end = size_t(begun_ + (1 << shift) - 1) >> shift;
    Flight flight{{dispatch.items.begin() + done, dispatch.items.begin() + std::ptrdiff_t(end)},
                  dispatch.samples,
                  shift,
                  {}};
    memory_.read_results(queue_, flight.sums, moved, begun_ - moved);
    std::vector<int> entry = slots_of(row_entry);
    for (int& e : entry) e = std::max(e - moved, 0);
    queue_.write(memory_.path_planes[row_entry], entry.size() * sizeof entry[0], entry.data());
    begun_ -= moved;
    flight_ = std::move(flight);
    return done;
}

StageState OpenclBackend::state_after(Stage stage, int bounce, int paths)
{
    StageState state{stage, bounce, paths, {}};
    std::vector<std::uint32_t> words;
    for (size_t r = 0; r < size_t(path_row_count); ++r) {
        words.resize(size_t(path_rows[r].components) * size_t(paths));
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
        std::vector<float> results(planes * size_t(paths));
        queue_.read(memory_.texture_planes[size_t(row)], results.size() * sizeof results[0],
                    results.data());
        state.texture_results.assign(results.begin(), results.end());
    }
    return state;
}

void OpenclBackend::trace(const Dispatch& dispatch,
                          const std::function<void(const StageState&)>& after_stage)
{
    flight_ = {};
    const int paths = dispatch.paths();
    begin(dispatch, paths, OpenclStages::every_path);
    for (const opencl::Buffer& plane : memory_.path_planes)
        queue_.fill(plane, plane.bytes(), sentinel);
    for (const opencl::Buffer& plane : memory_.texture_planes) queue_.fill(plane, plane.bytes(), 0);
    int live = paths;
    for (int bounce = 0; live > 0; ++bounce)
        for (int k = 0; k < STAGE_COUNT && live > 0; ++k) {
            const Stage stage = Stage(k);
            const When when = stage_when(stage);
            const bool is_first = when == When::once || when == When::first_bounce;
            const bool is_due = is_of_bounce(when) || (is_first && bounce == 0);
            if (!is_due || !is_active(stage, effects_)) continue;
            if (stage == STAGE_compact) {
                live = stages_.select(memory_.path_planes[row_depth], {paths, nullptr}, nullptr);
                continue;
            }
            stages_.run(stage, {paths, nullptr});
            stages_.collect_times();
            after_stage(state_after(stage, bounce, paths));
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
