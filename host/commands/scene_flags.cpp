#include "host/commands/scene_flags.hpp"

#include "backends/device_list.hpp"
#include "backends/textures/texture_source.hpp"
#include "common/textures/procedural.h"
#include "host/render/film.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace diptych {
namespace {

constexpr int largest_side = 65535;
constexpr int most_samples = 1 << 24;
constexpr double most_bytes = 512.0 * (1ull << 40);

[[noreturn]] void refuse(const std::string& flag, const std::string& text,
                         const std::string& remedy)
{
    throw std::runtime_error(fmt::format("{} {}: {}", flag, text, remedy));
}

template<class Number>
bool parse_number(std::string_view text, Number& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

void parse_vector(const std::string& flag, const std::string& text, float (&out)[3])
{
    std::string_view rest = text;
    for (int k = 0; k < 3; ++k) {
        const size_t comma = k < 2 ? rest.find(',') : rest.size();
        if (comma == std::string_view::npos || !parse_number(rest.substr(0, comma), out[k]) ||
            !std::isfinite(out[k]))
            refuse(flag, text, "not a point; give three finite numbers, as 1,2.5,-3");
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
}

int parse_bounces(const std::string& text)
{
    if (text == "none") return BOUNCES_UNLIMITED;
    int bounces = 0;
    if (!parse_number(text, bounces) || bounces < 0 || bounces > 1000000)
        refuse("--bounces", text, "not a number of scattering events; give 0 to 1000000, or none");
    return bounces;
}

int parse_filter(const std::string& text)
{
    if (text == "box") return FILTER_BOX;
    if (text == "blackman-harris") return FILTER_BLACKMAN_HARRIS;
    refuse("--filter", text, "no such filter; use blackman-harris or box");
}

LoadOptions load_options_from(const SceneFlags& flags)
{
    LoadOptions load = flags.load;
    std::tie(load.width, load.height) = parse_size(flags.size);
    if (flags.eye.empty() != flags.target.empty())
        throw std::runtime_error("--eye and --target: one is missing; give both or none");
    if (!flags.eye.empty() && !load.camera.empty())
        refuse("--camera", load.camera, "--eye is another view; leave one of them out");
    if (!flags.eye.empty()) {
        load.has_view = true;
        parse_vector("--eye", flags.eye, load.eye);
        parse_vector("--target", flags.target, load.target);
        parse_vector("--up", flags.up, load.up);
        if (load.up[0] == 0 && load.up[1] == 0 && load.up[2] == 0)
            refuse("--up", flags.up, "no direction; give one, as 0,1,0");
        if (load.eye[0] == load.target[0] && load.eye[1] == load.target[1] &&
            load.eye[2] == load.target[2])
            refuse("--target", flags.target, "the same point as --eye; move one of them");
    }
    if (!(flags.fov_degrees > 0 && flags.fov_degrees < 180))
        refuse("--fov", fmt::format("{}", flags.fov_degrees),
               "not a field of view; give degrees between 0 and 180");
    if (flags.eye.empty() && flags.is_lens_given)
        throw std::runtime_error("--up and --fov: belong to --eye and --target; give these, or "
                                 "leave them out");
    load.fov = float(flags.fov_degrees * std::numbers::pi / 180);
    load.environment_rotation = float(flags.environment_rotation_degrees * std::numbers::pi / 180);
    if (!(load.environment_scale >= 0 && std::isfinite(load.environment_scale)))
        refuse("--env-scale", fmt::format("{}", load.environment_scale),
               "not a factor; give a finite one, 0 or more");
    if (!(std::abs(flags.environment_rotation_degrees) <= 1e6))
        refuse("--env-rotation", fmt::format("{}", flags.environment_rotation_degrees),
               "out of range; give degrees from -1000000 to 1000000");
    return load;
}

// Unlit surfaces show their vertices' colours too, which a texture's value must do without.
void leave_solo(SceneData& scene)
{
    if ((scene.effects & EFFECT_VERTEX_COLOR) == 0) return;
    if ((scene.textures.attributes & ATTRIBUTE_VertexColor) == 0)
        scene.effects &= ~unsigned(EFFECT_VERTEX_COLOR);
    else
        scene.notices.push_back("--solo: values are multiplied by the vertex colours that the "
                                "texture reads");
}

}  // namespace

void refuse_empty(CLI::Option* option)
{
    option->check(CLI::Validator(
        [](const std::string& text) {
            return text.empty() ? std::string("is empty; give it a value or leave it out")
                                : std::string();
        },
        ""));
}

std::pair<int, int> parse_size(const std::string& text)
{
    int width = 0, height = 0;
    const size_t x = text.find('x');
    if (x == std::string::npos || !parse_number(std::string_view(text).substr(0, x), width) ||
        !parse_number(std::string_view(text).substr(x + 1), height))
        refuse("--size", text, "not a size; give width and height in pixels, as 640x480");
    if (width < 1 || height < 1 || width > largest_side || height > largest_side ||
        std::int64_t(width) * height > (std::int64_t(1) << 28))
        refuse("--size", text,
               fmt::format("out of range; sides from 1 to {}, at most 2^28 pixels", largest_side));
    return {width, height};
}

size_t parse_bytes(const std::string& flag, const std::string& text)
{
    double value = 0;
    std::string_view number = text;
    double unit = 1;
    if (!number.empty()) {
        const size_t k = std::string_view("KMGT").find(number.back());
        if (k != std::string_view::npos) {
            unit = std::ldexp(1.0, 10 * int(k + 1));
            number.remove_suffix(1);
        }
    }
    if (!parse_number(number, value) || !(value > 0))
        refuse(flag, text, "not an amount of memory; give bytes, or 512M, 2G");
    if (value * unit > most_bytes)
        refuse(flag, text,
               fmt::format("more than any machine has; give at most {:.0f}T, as 512M, 2G",
                           most_bytes / std::ldexp(1.0, 40)));
    return size_t(value * unit);
}

void add_scene_flags(CLI::App& app, SceneFlags& flags)
{
    app.add_option("SCENE", flags.scene,
                   "glTF 2.0 file (.gltf or .glb); without it, the demo scene");
    refuse_empty(app.get_option("SCENE"));
    add_view_flags(app, flags);
}

void add_view_flags(CLI::App& app, SceneFlags& flags)
{
    app.add_option("--size", flags.size, "Picture size, WxH in pixels")->capture_default_str();
    app.add_option("--samples", flags.samples, "Samples a pixel")->capture_default_str();
    app.add_flag("--one-sequence", flags.is_one_sequence,
                 "Take all samples of a pixel from one sequence: less noise, no standard error");
    app.add_option("--seed", flags.seed,
                   "Another seed is another, independent noise: 0 to 4294967295")
        ->capture_default_str()
        ->check(CLI::Range(std::int64_t(0), std::int64_t(4294967295)));
    app.add_option("--bounces", flags.bounces,
                   "Scattering events of a path: 0 shows emission alone, none has no limit")
        ->capture_default_str();
    app.add_option("--filter", flags.filter, "Pixel filter: blackman-harris or box")
        ->capture_default_str();
    app.add_option("--camera", flags.load.camera, "Camera of the scene, by name or number");
    app.add_option("--scene", flags.load.scene_index,
                   "Scene of the file, by number, where it holds several; its default one when not "
                   "given")
        ->check(CLI::Range(0, 1 << 30));
    app.add_option("--eye", flags.eye, "Look from this point, x,y,z (with --target)");
    app.add_option("--target", flags.target, "Look at this point, x,y,z");
    const auto note_lens = [&flags](const std::string&) { flags.is_lens_given = true; };
    app.add_option("--up", flags.up, "Upward direction for --eye, x,y,z")
        ->capture_default_str()
        ->each(note_lens);
    app.add_option("--fov", flags.fov_degrees, "Vertical field of view for --eye, degrees")
        ->capture_default_str()
        ->each(note_lens);
    app.add_option(
        "--env", flags.load.environment,
        "Environment: a latitude-longitude HDR or EXR file, or none. Without the flag, a "
        "neutral sky lights a scene that has no light");
    app.add_option("--env-rotation", flags.environment_rotation_degrees,
                   "Turns the environment about +Y, degrees")
        ->capture_default_str();
    app.add_option("--env-scale", flags.load.environment_scale, "Multiplies its radiance")
        ->capture_default_str();
    app.add_option("--texture", flags.load.textures,
                   "Let a function of a C file, or a texture of the library, give what a material "
                   "reads: MATERIAL.SLOT=FILE.c[:FUNCTION]; slots: baseColor, metallicRoughness, "
                   "normal, emissive, specular, specularColor; * is every material")
        ->allow_extra_args(false);
    app.add_option("--set", flags.load.texture_values,
                   "A value for an argument of a procedural texture: NODE.ARGUMENT=JSON")
        ->allow_extra_args(false);
    app.add_option("--solo", flags.load.solo,
                   "Show the colour that this texture node gives, as it is, and nothing else");
    app.add_flag("--allow-outside", flags.load.allow_outside,
                 "Let the scene name files outside its own folder");
    for (const char* name : {"--camera", "--env", "--solo"}) refuse_empty(app.get_option(name));
}

void add_device_flags(CLI::App& app, DeviceFlags& flags)
{
    app.add_option("--backend", flags.backend,
                   "cpu (Embree, vectorised), opencl, twin (what OpenCL runs, as C++) or double")
        ->capture_default_str()
        ->each([&flags](const std::string&) { flags.is_backend_given = true; });
    add_device_options(app, flags);
}

void add_device_options(CLI::App& app, DeviceFlags& flags)
{
    app.add_option("--device", flags.options.device,
                   "OpenCL device, by number or part of its name (see diptych devices). For render "
                   "and watch also a list that shares the work, as 0,1,cpu; 0/2 is device 0 "
                   "divided into 2 parts");
    app.add_option("--threads", flags.options.threads, "Threads; 0: as many as the machine has")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    app.add_option("--memory", flags.memory,
                   "Memory for path state on the device, as 512M; sets how many paths fly at once. "
                   "Of several devices each may take so much")
        ->capture_default_str();
    app.add_option("--launch-ms", flags.options.launch_milliseconds,
                   "OpenCL: keep each kernel launch below this many milliseconds")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 100000.0));
    app.add_flag(
        "--fast-math", flags.options.fast_math,
        "OpenCL: allow contraction and native functions; pictures no longer match to the bit");
    app.add_flag("--debug-kernels", flags.options.debug_kernels,
                 "Run twin from kernels built for a debugger; the same picture, slowly");
    app.add_flag("--debug-textures", flags.options.debug_textures,
                 "Compile procedural textures for a debugger; the same picture, slowly");
    app.add_option("--generated-dir", flags.options.generated_dir,
                   "Also write the code that is generated for procedural textures to this folder");
    app.add_option("--use-generated", flags.options.use_generated,
                   "Run the edited copy of that code in this folder instead");
    for (const char* name : {"--device", "--generated-dir", "--use-generated"})
        refuse_empty(app.get_option(name));
}

void check_scene_flags(const SceneFlags& flags, bool is_adaptive)
{
    const LoadOptions load = load_options_from(flags);
    if (flags.samples < 1 || flags.samples > most_samples)
        refuse("--samples", std::to_string(flags.samples),
               fmt::format("out of range; give 1 to {}", most_samples));
    parse_bounces(flags.bounces);
    parse_filter(flags.filter);
    if (flags.scene.empty() && !(load.textures.empty() && load.texture_values.empty() &&
                                 load.solo.empty() && load.aovs.empty()))
        throw std::runtime_error(
            "--texture, --set, --solo, --aov: only for a scene's file; name one");
    if (flags.scene.empty() && !(load.camera.empty() && load.scene_index < 0))
        throw std::runtime_error("--camera, --scene: only for a scene's file; name one");
    if (flags.is_one_sequence && is_adaptive)
        throw std::runtime_error(
            "--one-sequence: --error and --time need the standard error, which "
            "one sequence does not know; leave it out");
}

SceneData load_from_flags(const SceneFlags& flags, bool is_adaptive)
{
    check_scene_flags(flags, is_adaptive);
    LoadOptions load = load_options_from(flags);
    if (!load.solo.empty()) load.environment = "none";
    SceneData scene = flags.scene.empty() ? demo_scene(load) : load_scene(flags.scene, load);
    if (!load.solo.empty()) leave_solo(scene);
    Settings& settings = scene.settings.at(0);
    settings.seed = flags.seed;
    settings.max_bounces = load.solo.empty() ? parse_bounces(flags.bounces) : 0;
    settings.filter = parse_filter(flags.filter);
    settings.samples = flags.samples;
    settings.sequence_quanta =
        is_adaptive ? 0 : sequence_quanta_of(flags.samples, !flags.is_one_sequence);
    settings.width = load.width;
    settings.height = load.height;
    return scene;
}

std::vector<std::string> generated_notices(const SceneData& scene, const DeviceFlags& flags)
{
    const std::string& folder = flags.options.use_generated;
    if (folder.empty()) return {};
    return notices_of_generated(scene, folder, flags.backend);
}

BackendOptions options_from_flags(const DeviceFlags& flags)
{
    BackendOptions options = flags.options;
    if (is_device_list(options.device) && !flags.takes_list)
        refuse("--device", options.device,
               "several devices are for diptych render and watch; name one");
    options.memory_bytes = parse_bytes("--memory", flags.memory);
    std::error_code ignored;
    if (!options.generated_dir.empty() && !options.use_generated.empty() &&
        std::filesystem::weakly_canonical(options.generated_dir, ignored) ==
            std::filesystem::weakly_canonical(options.use_generated, ignored))
        refuse("--generated-dir", options.generated_dir,
               "would overwrite the edited copy that --use-generated runs; name another folder");
    if (options.debug_kernels && flags.backend != "twin")
        throw std::runtime_error("--debug-kernels: only for --backend twin; add that flag");
    return options;
}

DeviceFlags with_device_list(const DeviceFlags& flags)
{
    DeviceFlags listed = flags;
    const std::string& devices = flags.options.device;
    if (!is_device_list(devices)) {
        if (flags.options.fast_math && devices.empty() && flags.backend != "opencl")
            throw std::runtime_error("--fast-math: only for --backend opencl; add that flag");
        if (devices.empty() || flags.backend == "opencl") return listed;
        if (flags.is_backend_given)
            refuse("--device", devices,
                   fmt::format("names an OpenCL device, not one of --backend {}; leave one out",
                               flags.backend));
        listed.backend = "opencl";
        return listed;
    }
    if (flags.is_backend_given && flags.backend != "cpu" && flags.backend != "opencl")
        refuse("--device", devices,
               fmt::format("only for OpenCL devices and cpu; leave out --backend {}, or the list",
                           flags.backend));
    listed.backend = backend_of_devices(parse_device_list(devices));
    listed.takes_list = true;
    return listed;
}

}  // namespace diptych
