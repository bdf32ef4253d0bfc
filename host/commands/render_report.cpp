#include "host/commands/render_report.hpp"

#include "backends/sha256.hpp"
#include "common/as_cpp/path_rows.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace diptych {
namespace {

using nlohmann::json;

std::string megabytes(size_t bytes) { return fmt::format("{:.1f} MiB", double(bytes) / 1048576.0); }

std::vector<std::string> effect_names(unsigned effects)
{
    std::vector<std::string> names;
#define ADD_NAME(name, bit, words) \
    if (effects & EFFECT_##name) names.push_back(#name);
    EFFECTS_LIST(ADD_NAME)
    return names;
}

std::string layer_hash(const image::Layer& layer)
{
    Sha256 hash;
    hash.add(layer.pixels.data(), layer.pixels.size() * sizeof(float));
    hash.add(layer.ids.data(), layer.ids.size() * sizeof(uint32_t));
    return hash.finish();
}

std::string duration(double seconds)
{
    const int whole = int(std::ceil(seconds));
    return whole < 60 ? fmt::format("{} s", whole)
                      : fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

// Null where there is none.
json json_of(const std::optional<double>& value) { return value ? json(*value) : json(); }

// The first plane of the state with a value that is not finite, of path p.
const char* faulty_buffer(const StageState& state, size_t p)
{
    for (int r = 0; r < path_row_count; ++r) {
        const std::vector<double>& plane = state.planes[size_t(r)];
        const size_t stride = plane.size() / size_t(path_rows[r].components);
        for (size_t c = 0; c < size_t(path_rows[r].components); ++c)
            if (!plane.empty() && !std::isfinite(plane[c * stride + p])) return path_rows[r].name;
    }
    return nullptr;
}

// The scene's, and what the render leaves out.
std::vector<std::string> notices_of(const SceneData& scene, const RenderOptions& options)
{
    std::vector<std::string> notices = scene.notices;
    if (options.samples < standard_error_samples && !is_adaptive(options))
        notices.push_back(
            fmt::format("fewer than {} samples: no standard-error layer", standard_error_samples));
    else if (scene.settings[0].sequence_quanta > 0)
        notices.push_back("--one-sequence: no standard-error layer");
    return notices;
}

}  // namespace

void print_plan(const SceneData& scene, const Backend& backend, const Plan& plan,
                const RenderOptions& options)
{
    const int samples = options.samples;
    const Settings& settings = scene.settings[0];
    for (const std::string& line : notices_of(scene, options))
        fmt::print(stderr, "notice: {}\n", line);
    const std::string count = !is_adaptive(options)
                                  ? std::to_string(samples)
                                  : fmt::format("{} to {}", std::min(64, samples), samples);
    fmt::print(stderr, "{}\n", backend.description());
    fmt::print(stderr, "{} x {}, {} samples, {} triangles, {} lights, effects: {}\n",
               settings.width, settings.height, count, scene.triangles.size(), settings.light_count,
               fmt::join(effect_names(scene.effects), " "));
    fmt::print(
        stderr,
        "memory: geometry {}, textures {}, structure about {}, paths {} ({} at once), film {} "
        "in blocks; on the host film {}, picture {}\n",
        megabytes(plan.scene_bytes), megabytes(plan.texture_bytes), megabytes(plan.structure_bytes),
        megabytes(plan.path_bytes), plan.items * QUANTUM << (2 * BLOCK_SHIFT),
        megabytes(plan.film_bytes), megabytes(film_bytes(scene, options)),
        megabytes(picture_bytes(scene, options)));
}

ProgressBar::ProgressBar() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(const Progress& progress)
{
    const double since = progress.seconds - last_shown_;
    const bool is_due =
        is_terminal_ ? since > 0.1 : progress.fraction - last_fraction_ >= 0.1 || since > 30;
    const bool is_end = progress.fraction >= 1 && last_fraction_ < 1;
    if (!is_due && !is_end) return;
    last_shown_ = progress.seconds;
    last_fraction_ = progress.fraction;
    const std::string error =
        progress.error > 0 ? fmt::format("error {:.3g} JND  ", progress.error) : "";
    const std::string text =
        fmt::format("{:3} %  {} samples  {}{:.2f} Mrays/s  {} left", int(progress.fraction * 100),
                    progress.samples, error, double(progress.rays) / progress.seconds * 1e-6,
                    duration(progress.seconds_left));
    if (is_terminal_) {
        const int filled = int(progress.fraction * 30);
        fmt::print(stderr, "\r[{:<30}] {}   ", std::string(size_t(filled), '='), text);
    } else {
        fmt::print(stderr, "{}\n", text);
    }
    std::fflush(stderr);
}

void ProgressBar::finish()
{
    if (is_terminal_) fmt::print(stderr, "\n");
}

std::optional<FaultPlace> find_fault(Backend& backend, const Faults& faults, int samples)
{
    if (faults.count == 0) return std::nullopt;
    const int rest = samples - faults.first_sample;
    const WorkItem item{faults.x, faults.y, faults.first_sample, 0};
    const int at_once = rest >= QUANTUM ? QUANTUM : 1 << (31 - __builtin_clz(unsigned(rest)));
    std::optional<FaultPlace> place;
    int bounce = 0;
    backend.trace({{&item, 1}, at_once, 0}, [&](const StageState& state) {
        bounce = state.bounce;
        for (size_t p = 0; !place && p < size_t(state.paths); ++p)
            if (const char* buffer = faulty_buffer(state, p))
                place = FaultPlace{faults.x,
                                   faults.y,
                                   faults.first_sample + int(p),
                                   state.bounce,
                                   stage_names[state.stage],
                                   buffer};
    });
    if (!place)  // each sample is finite, their sum is not
        place = FaultPlace{faults.x, faults.y,     faults.first_sample,
                           bounce,   "accumulate", "sum_radiance"};
    return place;
}

double slots_busy(const Statistics& statistics)
{
    const double slots = double(std::max(1ull, statistics.slot_steps));
    return double(statistics.busy_steps) / slots;
}

std::string scene_hash(const SceneData& scene)
{
    Sha256 hash;
#define ADD_BUFFER(type, name) hash.add(scene.name.data(), scene.name.size() * sizeof(type));
    SCENE_BUFFERS(ADD_BUFFER)
    return hash.finish();
}

std::string json_report(const RenderCommand& command, const SceneData& scene,
                        const RenderOptions& options, const Backend& backend,
                        const RenderResult& result, const image::Picture& picture,
                        const std::optional<FaultPlace>& fault, const TextureFaultReport& textures,
                        const std::optional<ErrorSummary>& error,
                        const std::optional<Audit>& audited, const CheckpointWriter* checkpoint)
{
    const Statistics& statistics = result.statistics;
    json layers = json::object();
    for (const image::Layer& layer : picture.layers)
        layers[layer.name.empty() ? "beauty" : layer.name] = layer_hash(layer);
    json report = {
        {"program", "diptych " DIPTYCH_VERSION},
        {"scene", command.scene.scene.empty() ? "demo" : command.scene.scene},
        {"backend", command.device.backend},
        {"device", backend.description()},
        {"width", picture.width},
        {"height", picture.height},
        {"samples", result.most_samples},
        {"complete", result.is_complete},
        {"render", result.seconds},
        {"setup", statistics.setup_seconds},
        {"stage_seconds", statistics.stage_seconds},
        {"rays", statistics.rays},
        {"shadow_rays", statistics.shadow_rays},
        {"undecided_rays", statistics.undecided_rays},
        {"paths", statistics.paths},
        {"memory",
         {{"geometry", result.plan.scene_bytes},
          {"textures", result.plan.texture_bytes},
          {"structure", result.plan.structure_bytes},
          {"paths", result.plan.path_bytes},
          {"film_blocks", result.plan.film_bytes},
          {"planned", result.plan.bytes()},
          {"allocated", statistics.allocated_bytes},
          {"film", Film::bytes(result.film.data().window, result.film.data().batches,
                               result.film.data().aovs.size())},
          {"picture", picture_bytes(scene, options)}}},
        {"dispatch_paths", result.plan.items * QUANTUM << (2 * BLOCK_SHIFT)},
        {"effects", effect_names(scene.effects)},
        {"degenerate_triangles", scene.degenerate_triangles},
        {"notices", notices_of(scene, options)},
        {"slots_busy", slots_busy(statistics)},
        {"scheduling_seconds", result.scheduling_seconds},
        {"dropped_samples", result.film.faults().count},
        {"sha256", layers},
    };
    for (const DeviceShare& share : statistics.shares)
        report["devices"].push_back(
            {{"device", share.device},
             {"samples", share.paths},
             {"share", double(share.paths) / double(std::max(1ull, statistics.paths))},
             {"dropped", share.is_dropped}});
    if (error)
        report["error"] = {{"target", target_of(result, options)},
                           {"rms", error->rms},
                           {"block_p95", error->block_p95},
                           {"share_within", error->share_within},
                           {"share_unknown", error->share_unknown},
                           {"blocks", error->blocks},
                           {"unfinished_blocks", result.unfinished_blocks},
                           {"rounds", result.schedule.round}};
    if (audited && audited->blocks > 0)
        report["audit"] = {{"blocks", audited->blocks},
                           {"rms", audited->rms},
                           {"rms_low", audited->rms_low},
                           {"rms_high", audited->rms_high},
                           {"share_within", audited->share_within},
                           {"share_covered", json_of(audited->share_covered)},
                           {"share_false", json_of(audited->share_false)},
                           {"seconds", audited->seconds}};
    if (scene.effects & EFFECT_PROCEDURAL) report["textures"] = texture_fault_json(textures);
    if (fault)
        report["first_dropped"] = {{"x", fault->x},           {"y", fault->y},
                                   {"sample", fault->sample}, {"bounce", fault->bounce},
                                   {"stage", fault->stage},   {"buffer", fault->buffer}};
    if (checkpoint)
        report["checkpoint"] = {{"written", checkpoint->written()},
                                {"waited", checkpoint->seconds_spent()}};
    return report.dump();
}

void add_metadata(image::Picture& picture, const RenderCommand& command, const SceneData& scene,
                  const Backend& backend, const RenderResult& result)
{
    picture.metadata["program"] = "diptych " DIPTYCH_VERSION;
    picture.metadata["scene_sha256"] = scene_hash(scene);
    picture.metadata["backend"] = command.device.backend;
    picture.metadata["samples"] = std::to_string(result.most_samples);
    if (command.is_reproducible) return;
    picture.metadata["device"] = backend.description();
    picture.metadata["seconds"] = fmt::format("{:.3f}", result.seconds);
    picture.metadata["command_line"] = command.command_line;
}

}  // namespace diptych
