#include "host/commands/study_measurement.hpp"

#include "backends/textures/texture_arms.hpp"
#include "host/render/film.hpp"
#include "host/render/scheduler.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>

namespace diptych {
namespace {

constexpr size_t most_items = 64;  // in a dispatch: some tenths of a second
constexpr size_t memory_of_row = 96u << 20;

struct Running {
    SceneData scene;
    std::unique_ptr<Backend> backend;
    std::unique_ptr<Film> film;
    RowTimes times;
};

double seconds_of(const Statistics& statistics, const char* stage)
{
    const auto at = statistics.stage_seconds.find(stage);
    return at == statistics.stage_seconds.end() ? 0.0 : at->second;
}

double all_seconds(const Statistics& statistics)
{
    double sum = 0;
    for (const auto& [name, seconds] : statistics.stage_seconds) sum += seconds;
    return sum;
}

size_t count_differences(const Results& a, const Results& b)
{
    size_t count = 0;
#define COMPARE_ROW(type, name)                \
    for (size_t k = 0; k < a.name.size(); ++k) \
        count += std::memcmp(&a.name[k], &b.name[k], sizeof a.name[k]) != 0 ? 1 : 0;
    RESULT_BUFFERS(COMPARE_ROW)
#undef COMPARE_ROW
    return count;
}

// One dispatch of one row: adds its time, the least of the repetitions so far, to `least`.
struct Timed {
    double seconds = 1e30;
    double stages = 0, rays = 0, textures = 0;
};

void render_timed(Running& row, const Dispatch& dispatch, Results& results, Timed& least)
{
    const Statistics before = row.backend->statistics();
    const auto start = std::chrono::steady_clock::now();
    row.backend->render(dispatch, results);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    const Statistics after = row.backend->statistics();
    if (taken.count() >= least.seconds) return;
    least.seconds = taken.count();
    least.stages = all_seconds(after) - all_seconds(before);
    least.rays = seconds_of(after, "trace_texture_rays") - seconds_of(before, "trace_texture_rays");
    least.textures =
        seconds_of(after, "evaluate_textures") - seconds_of(before, "evaluate_textures");
}

// All rows on one dispatch, beginning with another one each time.
void run_dispatch(std::vector<Running>& running, const std::vector<StudyRow>& rows,
                  const Dispatch& dispatch, int repetitions, size_t& turn)
{
    std::vector<Results> results(running.size());
    std::vector<Timed> least(running.size());
    for (int repetition = 0; repetition < repetitions; ++repetition, ++turn)
        for (size_t k = 0; k < running.size(); ++k) {
            const size_t r = (k + turn) % running.size();
            render_timed(running[r], dispatch, results[r], least[r]);
        }
    for (size_t r = 0; r < running.size(); ++r) {
        RowTimes& times = running[r].times;
        times.seconds += least[r].seconds;
        times.stage_seconds += least[r].stages;
        times.ray_seconds += least[r].rays;
        times.texture_seconds += least[r].textures;
        running[r].film->add(dispatch, results[r]);
        const size_t first =
            size_t(std::ranges::find(rows, rows[r].material, &StudyRow::material) - rows.begin());
        times.differing += count_differences(results[first], results[r]);
    }
}

}  // namespace

BackendTimes measure_rows(const std::string& name, const BackendOptions& options,
                          const StudyScenes& scenes, const StudyOptions& study,
                          const std::vector<StudyRow>& rows, int repetitions)
{
    BackendOptions small = options;
    small.memory_bytes = memory_of_row;
    std::vector<Running> running(rows.size());
    size_t at_once = most_items;
    for (size_t r = 0; r < rows.size(); ++r) {
        running[r].scene = scenes.scene(rows[r].material);
        make_texture_arm(running[r].scene, rows[r].arm);
        running[r].backend = make_backend(name, small);
        running[r].backend->upload(running[r].scene);
        running[r].times.setup_seconds = running[r].backend->statistics().setup_seconds;
        running[r].film = std::make_unique<Film>(
            study.side, study.side, Window{0, 0, study.side, study.side},
            batches_of(study.samples, running[r].scene.settings[0].sequence_quanta));
        at_once = std::min(
            at_once, size_t(std::max(1, running[r].backend->plan(running[r].scene).most_items)));
    }
    const std::vector<Pixel> blocks = blocks_of(study.side, study.side);
    const auto items_from = [&](size_t first, int sample) {
        std::vector<WorkItem> items;
        for (size_t k = first; k < std::min(first + at_once, blocks.size()); ++k)
            items.push_back({blocks[k].x, blocks[k].y, sample, 0});
        return items;
    };
    for (Running& row : running) {  // what is only done once is not timed
        const std::vector<WorkItem> items = items_from(0, 0);
        Results results;
        row.backend->render({items, 1}, results);
    }
    size_t turn = 0;
    for (const Quantum& quantum : quanta_of(study.samples))
        for (size_t first = 0; first < blocks.size(); first += at_once) {
            const std::vector<WorkItem> items = items_from(first, quantum.first_sample);
            run_dispatch(running, rows, {items, quantum.samples}, repetitions, turn);
        }
    BackendTimes times;
    times.description = running.front().backend->description();
    times.samples = double(study.side) * study.side * study.samples;
    for (const Running& row : running) {
        times.rows.push_back(row.times);
        times.pictures.push_back(row.film->picture());
    }
    return times;
}

}  // namespace diptych
