#include "host/commands/texture_cost.hpp"

#include "backends/textures/scratch_folder.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "host/commands/texture_preview.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

constexpr int side = 64;  // of the picture whose camera rays are timed and compared
constexpr int repetitions = 5;
constexpr const char* reference = "twin";

// A texture that is constant: what remains is the stage around it.
TextureFile constant_texture(const ScratchFolder& folder)
{
    const std::string path = folder / "constant.c";
    std::ofstream(path) << "float constant_texture() { return 0.5f; }\n";
    return {path, "constant.c", ""};
}

SceneData scene_of(const TextureFile& file, const std::vector<std::string>& values)
{
    SceneData scene = square_scene(file, {values, "baseColor", side, side});
    scene.settings.at(0).max_bounces = 0;
    scene.settings.at(0).filter = FILTER_BOX;
    return scene;
}

std::vector<WorkItem> items_of_picture()
{
    std::vector<WorkItem> items;
    for (const Pixel& block : blocks_of(side, side)) items.push_back({block.x, block.y, 0, 0});
    return items;
}

struct StageTimes {
    double evaluation = 0;
    double rays = 0;
};

// Nanoseconds a path, the least of some repetitions. The scene is uploaded.
StageTimes stage_times(Backend& backend, const SceneData& scene)
{
    std::vector<WorkItem> items = items_of_picture();
    items.resize(std::min(items.size(), size_t(std::max(1, backend.plan(scene).most_items))));
    const Dispatch dispatch{items};
    Results results;
    const auto seconds = [&](const char* stage) {
        const Statistics statistics = backend.statistics();
        const auto at = statistics.stage_seconds.find(stage);
        return at == statistics.stage_seconds.end() ? 0.0 : at->second;
    };
    StageTimes least;
    for (int k = 0; k <= repetitions; ++k) {
        const double evaluation = seconds("evaluate_textures");
        const double rays = seconds("trace_texture_rays");
        backend.render(dispatch, results);
        const StageTimes now{(seconds("evaluate_textures") - evaluation) * 1e9 / dispatch.paths(),
                             (seconds("trace_texture_rays") - rays) * 1e9 / dispatch.paths()};
        if (k == 1 || (k > 1 && now.evaluation < least.evaluation))
            least.evaluation = now.evaluation;
        if (k == 1 || (k > 1 && now.rays < least.rays)) least.rays = now.rays;
    }
    return least;
}

// What the texture gives along the camera rays of a small picture, as base colour: three numbers
// an evaluation. As many at once as the backend takes.
std::vector<float> values_of(Backend& backend, const SceneData& scene)
{
    const std::vector<WorkItem> items = items_of_picture();
    const size_t at_once = size_t(std::max(1, backend.plan(scene).items));
    std::vector<float> values;
    for (size_t first = 0; first < items.size(); first += at_once) {
        const size_t count = std::min(at_once, items.size() - first);
        bool is_first = true;
        backend.trace({std::span(items).subspan(first, count), 1}, [&](const StageState& state) {
            if (state.stage != STAGE_evaluate_surface || !is_first) return;
            is_first = false;
            const std::vector<double>& planes = state.planes[row_base_color];
            const size_t stride = planes.size() / 3;
            for (size_t i = 0; i < stride; ++i)
                for (size_t c = 0; c < 3; ++c) values.push_back(float(planes[c * stride + i]));
        });
    }
    return values;
}

void compare_values(TextureTiming& timing, const std::vector<float>& values,
                    const std::vector<float>& wanted)
{
    timing.compared = std::min(values.size(), wanted.size()) / 3;
    for (size_t i = 0; i < timing.compared; ++i) {
        bool differs = false;
        for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
            differs |= std::memcmp(&values[k], &wanted[k], sizeof(float)) != 0;
            const double difference = std::abs(double(values[k]) - double(wanted[k]));
            timing.largest_difference = std::max(timing.largest_difference, difference);
        }
        timing.differing += differs ? 1 : 0;
    }
}

TextureTiming time_on(const std::string& name, const TextureFile& file,
                      const std::vector<std::string>& values, const TextureFile& constant,
                      const BackendOptions& options, const std::vector<float>& wanted)
{
    TextureTiming timing;
    timing.backend = name;
    BackendOptions alone = options;
    if (name != "opencl" && alone.threads == 0) alone.threads = 1;
    SceneData scene = scene_of(file, values);
    SceneData empty = scene_of(constant, {});
    try {
        const std::unique_ptr<Backend> backend = make_backend(name, alone);
        timing.device = backend->description();
        backend->upload(scene);
        const StageTimes times = stage_times(*backend, scene);
        timing.nanoseconds = times.evaluation;
        timing.ray_nanoseconds = times.rays;
        compare_values(timing, values_of(*backend, scene), wanted);
        backend->upload(empty);
        timing.stage_nanoseconds = stage_times(*backend, empty).evaluation;
    } catch (const std::runtime_error& error) {
        timing.failure = first_line(error.what());
    }
    return timing;
}

std::string difference_text(const TextureTiming& timing)
{
    if (!timing.no_reference.empty()) return "not compared: " + timing.no_reference;
    if (timing.backend == reference || timing.compared == 0) return "-";
    if (timing.differing == 0) return "none, bit for bit";
    return fmt::format("{:.2g} ({} of {} differ)", timing.largest_difference, timing.differing,
                       timing.compared);
}

std::vector<std::string> names_from(const std::string& list)
{
    std::vector<std::string> names;
    for (size_t at = 0; at <= list.size() && !list.empty();) {
        const size_t end = std::min(list.find(',', at), list.size());
        names.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    if (names.empty()) names = {"cpu", "twin", "opencl", "double"};
    for (const std::string& name : names)
        if (name != "cpu" && name != "twin" && name != "opencl" && name != "double")
            throw std::runtime_error("--backends " + list + ": " + name +
                                     " is no backend; use cpu, twin, opencl, double");
    return names;
}

}  // namespace

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::vector<TextureTiming> time_texture(const TextureFile& file,
                                        const std::vector<std::string>& values,
                                        const std::vector<std::string>& backends,
                                        const BackendOptions& options)
{
    const ScratchFolder folder;
    const TextureFile constant = constant_texture(folder);
    SceneData scene = scene_of(file, values);
    std::vector<float> wanted;
    std::string no_reference;
    try {
        const std::unique_ptr<Backend> twin = make_backend(reference, options);
        twin->upload(scene);
        wanted = values_of(*twin, scene);
    } catch (const std::runtime_error& error) {  // as on a machine without a compiler
        if (std::ranges::count(backends, "opencl") != std::ssize(backends)) throw;
        no_reference = first_line(error.what());
    }
    std::vector<TextureTiming> timings;
    for (const std::string& name : backends) {
        timings.push_back(time_on(name, file, values, constant, options, wanted));
        timings.back().no_reference = no_reference;
    }
    return timings;
}

std::string cost_card(const TextureFile& file, const std::vector<std::string>& values,
                      const std::string& backends, const BackendOptions& options)
{
    const std::vector<std::string> names = names_from(backends);
    std::string text = fmt::format("{}: nanoseconds an evaluation, with the stage around it; one "
                                   "thread, but the whole OpenCL device\n",
                                   file.name);
    text += fmt::format("{:<8} {:>12} {:>16} {:>16}  {}\n", "backend", "texture", "constant one",
                        "occlusion rays", "largest difference to twin");
    for (const TextureTiming& timing : time_texture(file, values, names, options)) {
        if (!timing.failure.empty()) {
            text += fmt::format("{:<8} not measured: {}\n", timing.backend, timing.failure);
            continue;
        }
        text += fmt::format("{:<8} {:>12.1f} {:>16.1f} {:>16.1f}  {}\n", timing.backend,
                            timing.nanoseconds, timing.stage_nanoseconds, timing.ray_nanoseconds,
                            difference_text(timing));
    }
    SceneData scene = scene_of(file, values);
    std::vector<DeviceCost> costs = device_costs(scene).free;
    if (const auto cost = driver_cost(scene, options)) costs.push_back(*cost);
    size_t width = 8;
    for (const DeviceCost& cost : costs) width = std::max(width, cost.target.size());
    text += fmt::format("\nthe texture stage as compilers for GPUs see it\n{:<{}} {:>12} {:>16} "
                        "{:>16} {:>12}\n",
                        "target", width, "registers", "stack bytes", "spilled bytes", "code bytes");
    for (const DeviceCost& cost : costs) {
        if (!cost.missing.empty())
            text += fmt::format("{:<{}} not measured: {}\n", cost.target, width, cost.missing);
        else
            text += fmt::format("{:<{}} {:>12} {:>16} {:>16} {:>12}\n", cost.target, width,
                                cost.registers, cost.stack_bytes, cost.spill_bytes,
                                cost.code_bytes > 0 ? std::to_string(cost.code_bytes) : "-");
    }
    return text;
}

}  // namespace diptych
