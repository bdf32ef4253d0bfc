#include "host/commands/texture_capture.hpp"

#include "backends/sha256.hpp"
#include "common/textures/procedural.h"
#include "host/commands/texture_fault_report.hpp"
#include "host/image/whole_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace diptych {
namespace {

using nlohmann::json;

constexpr const char* format_name = "diptych texture capture";
constexpr int format_version = 1;
constexpr size_t most_hits = 4096;

// Everything that textures can see, but what a capture brings itself and the trees, which only some
// backends have.
std::string textures_hash(const SceneData& scene)
{
    Sha256 hash;
#define ADD_BUFFER(type, name)                                                                 \
    if (std::string_view(#name) != "settings" && !std::string_view(#name).starts_with("bvh_")) \
        hash.add(scene.name.data(), scene.name.size() * sizeof(type));
    SCENE_BUFFERS(ADD_BUFFER)
#undef ADD_BUFFER
    for (const TextureFunction& function : scene.textures.functions) {
        std::istringstream text(function.cpp);
        for (std::string line; std::getline(text, line);)  // files' names say how they were found
            if (!line.starts_with("#line")) hash.add(line + "\n");
    }
    return hash.finish();
}

std::string sha256_of(const std::string& text)
{
    Sha256 hash;
    hash.add(text);
    return hash.finish();
}

json numbers(const float4& v) { return {v.x, v.y, v.z, v.w}; }

float4 vector_of(const json& v)
{
    const auto x = v.get<std::array<float, 4>>();
    return make_float4(x[0], x[1], x[2], x[3]);
}

json json_of(const TextureCapture& capture)
{
    json hits = json::array();
    for (const CapturedHit& captured : capture.hits) {
        json results = json::array();
        for (const CapturedResult& result : captured.results)
            results.push_back({{"node", result.node}, {"value", result.value}});
        const TextureHit& hit = captured.hit;
        hits.push_back({{"pixel", hit.pixel},
                        {"sample", hit.sample},
                        {"depth", hit.depth},
                        {"triangle", hit.triangle},
                        {"instance", hit.instance},
                        {"origin", hit.origin},
                        {"direction", hit.direction},
                        {"results", results}});
    }
    const Settings& s = capture.settings;
    const LoadOptions& load = capture.scene.load;
    return {{"scene", capture.scene.scene},
            {"textures", load.textures},
            {"values", load.texture_values},
            {"solo", load.solo},
            {"aovs", load.aovs},
            {"allow_outside", load.allow_outside},
            {"scene_sha256", capture.scene_sha256},
            {"backend", capture.backend},
            {"device", capture.device},
            {"settings",
             {{"width", s.width},
              {"height", s.height},
              {"seed", s.seed},
              {"samples", s.samples},
              {"camera_kind", s.camera_kind},
              {"camera_origin", numbers(s.camera_origin)},
              {"camera_right", numbers(s.camera_right)},
              {"camera_up", numbers(s.camera_up)},
              {"camera_forward", numbers(s.camera_forward)}}},
            {"hits", hits}};
}

TextureCapture capture_of(const json& file)
{
    TextureCapture capture;
    capture.scene.scene = file.at("scene").get<std::string>();
    capture.scene.load.textures = file.at("textures").get<std::vector<std::string>>();
    capture.scene.load.texture_values = file.at("values").get<std::vector<std::string>>();
    capture.scene.load.solo = file.at("solo").get<std::string>();
    capture.scene.load.aovs = file.value("aovs", std::vector<std::string>());
    capture.scene.load.allow_outside = file.at("allow_outside").get<bool>();
    capture.scene_sha256 = file.at("scene_sha256").get<std::string>();
    capture.backend = file.at("backend").get<std::string>();
    capture.device = file.at("device").get<std::string>();
    const json& settings = file.at("settings");
    Settings& s = capture.settings;
    s.width = settings.at("width").get<int>();
    s.height = settings.at("height").get<int>();
    s.seed = settings.at("seed").get<uint>();
    s.samples = settings.at("samples").get<int>();
    s.camera_kind = settings.at("camera_kind").get<int>();
    s.camera_origin = vector_of(settings.at("camera_origin"));
    s.camera_right = vector_of(settings.at("camera_right"));
    s.camera_up = vector_of(settings.at("camera_up"));
    s.camera_forward = vector_of(settings.at("camera_forward"));
    for (const json& one : file.at("hits")) {
        CapturedHit captured;
        TextureHit& hit = captured.hit;
        hit.pixel = one.at("pixel").get<int>();
        hit.sample = one.at("sample").get<int>();
        hit.depth = one.at("depth").get<int>();
        hit.triangle = one.at("triangle").get<int>();
        hit.instance = one.at("instance").get<int>();
        hit.origin = one.at("origin").get<std::array<double, 3>>();
        hit.direction = one.at("direction").get<std::array<double, 3>>();
        for (const json& result : one.at("results"))
            captured.results.push_back({result.at("node").get<std::string>(),
                                        result.at("value").get<std::array<double, 4>>()});
        capture.hits.push_back(std::move(captured));
    }
    return capture;
}

// Of the hit of path p: what the stage gave for each node that the material reads.
std::vector<CapturedResult> results_of(const SceneData& scene, const StageState& state,
                                       const TexturedPath& path)
{
    const auto* words = reinterpret_cast<const uint*>(scene.materials.data());
    const int material = scene.triangles.at(size_t(path.hit.triangle)).material;
    const int program = scene.materials.at(size_t(material)).texture_program[PROGRAM_SURFACE];
    std::vector<CapturedResult> results;
    for (int k = 0; k < int(words[program]); ++k) {
        const int step = program + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS;
        const auto attachment = std::ranges::find(scene.textures.attachments, int(words[step + 1]),
                                                  &TextureAttachment::first_word);
        for (int output = 0; output < SLOT_COUNT; ++output) {
            if ((words[step + 3] >> output & 1u) == 0) continue;
            CapturedResult result{attachment->node, {}};
            for (size_t c = 0; c < 4; ++c)
                result.value[c] = state.texture_results.at(
                    (size_t(4 * output) + c) * size_t(state.paths) + size_t(path.path));
            results.push_back(result);
            break;  // other results of the step are the same
        }
    }
    return results;
}

// What the device handed on.
double replaced(double x) { return std::abs(x) <= FLOAT_MAX ? x : 0; }

}  // namespace

TextureCapture capture_textures(Backend& backend, const SceneData& scene, const SceneFlags& flags,
                                const std::string& name, const Pixel& pixel)
{
    TextureCapture capture;
    capture.scene.scene =
        flags.scene.empty() ? "" : std::filesystem::absolute(flags.scene).string();
    capture.scene.load.textures = flags.load.textures;
    capture.scene.load.texture_values = flags.load.texture_values;
    capture.scene.load.solo = flags.load.solo;
    capture.scene.load.aovs = flags.load.aovs;
    capture.scene.load.allow_outside = flags.load.allow_outside;
    capture.scene_sha256 = textures_hash(scene);
    capture.backend = name;
    capture.device = backend.description();
    capture.settings = scene.settings.at(0);
    for (const Quantum& quantum : quanta_of(flags.samples)) {
        if (capture.hits.size() >= most_hits) break;
        const WorkItem item{pixel.x, pixel.y, quantum.first_sample, 0};
        std::vector<TexturedPath> paths;
        backend.trace({{&item, 1}, quantum.samples, 0}, [&](const StageState& state) {
            if (state.stage == STAGE_intersect) paths = textured_hits(scene, state);
            if (state.stage != STAGE_evaluate_textures) return;
            for (const TexturedPath& path : paths)
                if (capture.hits.size() < most_hits)
                    capture.hits.push_back({path.hit, results_of(scene, state, path)});
        });
    }
    if (capture.hits.empty())
        throw std::runtime_error(fmt::format("--capture: no path of pixel {},{} meets a procedural "
                                             "texture; choose another",
                                             pixel.x, pixel.y));
    return capture;
}

void write_capture(const std::string& path, const TextureCapture& capture)
{
    const std::string content = json_of(capture).dump();
    const json file = {{"format", format_name},
                       {"version", format_version},
                       {"sha256", sha256_of(content)},
                       {"content", content}};
    image::write_text(path, file.dump() + "\n");
}

TextureCapture read_capture(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + ": cannot be read; name a file of render --capture");
    const json file = json::parse(in, nullptr, false);
    const auto text = [&](const char* name) {
        return file.is_object() && file.contains(name) && file[name].is_string()
                   ? file[name].get<std::string>()
                   : std::string();
    };
    if (file.is_discarded())
        throw std::runtime_error(path + ": cut short, or no capture; capture it again");
    if (text("format") != format_name)
        throw std::runtime_error(path + ": no capture; name a file of render --capture");
    if (file.value("version", json()) != format_version)
        throw std::runtime_error(fmt::format("{}: of another version of captures than {}; capture "
                                             "it again",
                                             path, format_version));
    if (sha256_of(text("content")) != text("sha256"))
        throw std::runtime_error(path + ": damaged; capture it again");
    try {
        TextureCapture capture = capture_of(json::parse(text("content")));
        const bool has_results = std::ranges::all_of(
            capture.hits, [](const CapturedHit& hit) { return !hit.results.empty(); });
        if (capture.hits.empty() || !has_results) throw std::runtime_error("no hits");
        return capture;
    } catch (const std::exception&) {
        throw std::runtime_error(path + ": its content is not that of a capture; capture it again");
    }
}

SceneData load_for_replay(const TextureCapture& capture, SceneFlags flags, const std::string& path)
{
    if (flags.scene.empty()) flags.scene = capture.scene.scene;
    LoadOptions& load = flags.load;
    if (load.textures.empty()) load.textures = capture.scene.load.textures;
    if (load.texture_values.empty()) load.texture_values = capture.scene.load.texture_values;
    if (load.solo.empty()) load.solo = capture.scene.load.solo;
    load.aovs = capture.scene.load.aovs;
    load.allow_outside = load.allow_outside || capture.scene.load.allow_outside;
    SceneData scene = load_from_flags(flags);
    if (textures_hash(scene) != capture.scene_sha256)
        throw std::runtime_error(fmt::format("{}: {} or its textures are not what was captured; "
                                             "undo their change, or capture again",
                                             path, flags.scene));
    Settings& s = scene.settings.at(0);
    const Settings& from = capture.settings;
    s.width = std::max(1, from.width);
    s.height = std::max(1, from.height);
    s.seed = from.seed;
    s.samples = from.samples;
    s.camera_kind = from.camera_kind;
    s.camera_origin = from.camera_origin;
    s.camera_right = from.camera_right;
    s.camera_up = from.camera_up;
    s.camera_forward = from.camera_forward;
    scene.effects &= ~unsigned(EFFECT_ORTHOGRAPHIC);
    if (s.camera_kind == CAMERA_ORTHOGRAPHIC) scene.effects |= EFFECT_ORTHOGRAPHIC;
    for (const CapturedHit& captured : capture.hits) {
        const TextureHit& hit = captured.hit;
        const bool is_inside = hit.triangle >= 0 && size_t(hit.triangle) < scene.triangles.size() &&
                               hit.instance >= 0 && size_t(hit.instance) < scene.instances.size();
        if (!is_inside || scene.materials[size_t(scene.triangles[size_t(hit.triangle)].material)]
                                  .texture_program[PROGRAM_SURFACE] == 0)
            throw std::runtime_error(path + ": names a hit that the scene does not have; capture "
                                            "it again");
    }
    return scene;
}

int print_replay(const TextureCapture& capture, SceneData& scene, const std::string& path,
                 const GeneratedFolders& generated)
{
    TextureReplay replay(scene, capture.backend == "double", TextureReplay::Build::debug,
                         generated);
    const int pixel = capture.hits[0].hit.pixel;
    fmt::print("{}: pixel {},{} on {} ({}), {} hits\n", path, pixel & 0xffff, unsigned(pixel) >> 16,
               capture.backend, capture.device, capture.hits.size());
    int same = 0, all = 0;
    for (const CapturedHit& captured : capture.hits) {
        for (const TextureStepValue& step : replay.run(captured.hit)) {
            const TextureAttachment& attachment =
                scene.textures.attachments.at(size_t(step.attachment));
            const TextureFunction& function =
                scene.textures.functions.at(size_t(attachment.function));
            fmt::print("sample {} bounce {}: {}: {}({}) gave {}", captured.hit.sample,
                       captured.hit.depth, attachment.node, function.entry,
                       arguments_text(function, step),
                       text_of_numbers({step.value.begin(), step.value.end()}, false));
            const auto on_device =
                std::ranges::find(captured.results, attachment.node, &CapturedResult::node);
            if (step.outputs == 0 || on_device == captured.results.end()) {
                fmt::print("\n");
                continue;
            }
            ++all;
            const bool is_same =
                std::ranges::equal(step.value, on_device->value, [](double host, double device) {
                    return replaced(host) == device;
                });
            same += is_same ? 1 : 0;
            if (is_same)
                fmt::print(": the device's bits\n");
            else
                fmt::print(
                    ": the device has {}\n",
                    text_of_numbers({on_device->value.begin(), on_device->value.end()}, false));
        }
    }
    fmt::print("{} of {} results have the device's bits\n", same, all);
    return same == all ? 0 : 1;
}

}  // namespace diptych
