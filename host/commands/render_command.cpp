#include "host/commands/render_command.hpp"

#include "common/as_cpp/texture_lookups.hpp"
#include "host/commands/picture_flags.hpp"
#include "host/commands/progress_pictures.hpp"
#include "host/commands/render_report.hpp"
#include "host/commands/texture_capture.hpp"
#include "host/image/whole_file.hpp"
#include "host/render/host_memory.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

std::atomic<bool> is_interrupted{false};

extern "C" void on_interrupt(int) { is_interrupted = true; }

void print_pixel(std::FILE* out, const Film& film, const Pixel& pixel)
{
    const std::array<float, 3> value = film.radiance(pixel.x, pixel.y);
    fmt::print(out, "pixel {},{}: {:.9g} {:.9g} {:.9g}\n", pixel.x, pixel.y, value[0], value[1],
               value[2]);
}

// Of two outputs with one name the second would replace the first.
void expect_all_different(const RenderCommand& command)
{
    std::vector<std::string> names = command.outputs;
    names.insert(names.end(), {command.json, command.checkpoint.file, command.capture});
    std::set<std::filesystem::path> seen;
    for (const std::string& name : names)
        if (!name.empty() && name != "-" &&
            !seen.insert(std::filesystem::absolute(image::file_behind(name)).lexically_normal())
                 .second)
            throw std::runtime_error(name + ": is named for two outputs; give each its own file");
}

// Before anything is allocated. Files are encoded in memory, one after the other: layers about as
// large as they are.
void check_film_fits(const RenderCommand& command, const SceneData& scene,
                     const RenderOptions& options)
{
    const Settings& settings = scene.settings[0];
    const size_t picture = picture_bytes(scene, options);
    const bool has_layers = std::ranges::any_of(command.outputs, image::holds_layers);
    const size_t needed = film_bytes(scene, options) + picture * (has_layers ? 2 : 1);
    const size_t there = host_memory_left();
    if (needed > there)
        throw std::runtime_error(fmt::format(
            "--size: the film of {} x {} pixels and the picture made of it need {} MiB, there are "
            "{} MiB; render a smaller picture, or --one-sequence without --error",
            settings.width, settings.height, needed >> 20, there >> 20));
}

// On a terminal one line that counts, else one at the beginning.
void tell_audit_progress(int done, int of, bool is_end)
{
    if (isatty(STDERR_FILENO) != 0)
        fmt::print(stderr, "\raudit: {} of {} blocks rendered again{}", done, of,
                   is_end ? "\n" : "");
    else if (done == 0 && !is_end)
        fmt::print(stderr, "audit: {} blocks are rendered again\n", of);
}

// What a prediction was worth; where nothing was predicted there is no share of it.
std::string covered_text(const Audit& audit)
{
    return audit.share_covered
               ? fmt::format("{:.1f} % of those predicted to be", 100 * *audit.share_covered)
               : "none was predicted to be";
}

std::string false_text(const Audit& audit)
{
    return audit.share_false ? fmt::format("of the blocks predicted below it {:.1f} % above",
                                           100 * *audit.share_false)
                             : "no block was predicted below it";
}

void print_audit(const Audit& audit, double bar)
{
    if (audit.blocks < audit.chosen)
        fmt::print(stderr, "audit: broken off after {} of {} blocks\n", audit.blocks, audit.chosen);
    if (audit.blocks == 0) return;
    fmt::print(stderr,
               "audit: {} blocks rendered again by other samples in {:.1f} s: RMS error {:.3g} JND "
               "({:.3g} to {:.3g}); {:.1f} % of the pixels within {:.3g} JND; {}; {}\n",
               audit.blocks, audit.seconds, audit.rms, audit.rms_low, audit.rms_high,
               100 * audit.share_within, bar, covered_text(audit), false_text(audit));
}

void print_summary(const RenderCommand& command, const RenderResult& result)
{
    const Statistics& statistics = result.statistics;
    const double rays = double(statistics.rays + statistics.shadow_rays);
    fmt::print(stderr, "{:.2f} s, {:.2f} million samples/s, {:.2f} million rays/s\n",
               result.seconds, double(statistics.paths) / result.seconds * 1e-6,
               rays / result.seconds * 1e-6);
    fmt::print(stderr, "slots {:.1f} % busy, scheduling and merging {:.1f} % of the time\n",
               100 * slots_busy(statistics), 100 * result.scheduling_seconds / result.seconds);
    for (const DeviceShare& share : statistics.shares)
        fmt::print(stderr, "{:5.1f} % of the samples: {}{}\n",
                   100 * double(share.paths) / double(std::max(1ull, statistics.paths)),
                   share.device, share.is_dropped ? "; dropped" : "");
    if (statistics.undecided_rays > 0)
        fmt::print(
            stderr,
            "notice: {} rays met more than {} surfaces whose alpha a texture gives; the next "
            "was taken for solid\n",
            statistics.undecided_rays, most_alpha_layers);
    for (const std::string& path : command.outputs) fmt::print(stderr, "wrote {}\n", path);
}

std::string fault_text(const Faults& faults, const std::optional<FaultPlace>& place)
{
    std::string text = fmt::format("{} samples were not finite and were dropped", faults.count);
    if (place)
        text += fmt::format(", the first at pixel {},{} sample {}: {} became so at bounce {} in {}",
                            place->x, place->y, place->sample, place->buffer, place->bounce,
                            place->stage);
    return text;
}

// Where the backend has failed on the way.
void keep_what_is_done(const RenderCommand& command, const SceneData& scene, const Backend& backend,
                       const RenderOptions& options, const RenderResult& result,
                       const image::WriteOptions& write)
{
    const auto has_samples = [](const BlockState& block) { return block.quanta > 0; };
    if (std::ranges::none_of(result.schedule.blocks, has_samples)) return;
    if (!command.outputs.empty()) {
        image::Picture picture = picture_of(result.film, options.viewer);
        add_metadata(picture, command, scene, backend, result);
        image::write_pictures(command.outputs, picture, write);
    }
    std::vector<std::string> files = command.outputs;
    if (!command.checkpoint.file.empty()) files.push_back(command.checkpoint.file);
    if (!files.empty())
        fmt::print(stderr, "notice: the render has failed; what was done before is in {}\n",
                   fmt::join(files, ", "));
}

// The error is known from batches of samples, of a whole picture.
void expect_error_is_known(const RenderCommand& command, const RenderOptions& options)
{
    if (!command.is_audited) return;
    if (options.pixel)
        throw std::runtime_error("--audit: the error of one pixel is not known; leave out --pixel");
    if (command.scene.is_one_sequence)
        throw std::runtime_error("--audit: one sequence does not know its error; leave out "
                                 "--one-sequence");
    if (options.samples < standard_error_samples)
        throw std::runtime_error(fmt::format(
            "--audit: of {} samples a pixel the error is not known; {} are needed: give --samples "
            "{} or more{}",
            options.samples, standard_error_samples, standard_error_samples,
            is_adaptive(options) ? "" : ", or --error or --time"));
}

// A slice or a pixel is not one to look at, unless a file is named for it.
bool wants_picture(const RenderCommand& command)
{
    return command.pixel.empty() &&
           (command.checkpoint.range.empty() || command.checkpoint.file.empty());
}

}  // namespace

// Asked to stop twice, the program does so at once.
const std::atomic<bool>& watch_for_interrupts()
{
    struct sigaction action = {};
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESETHAND;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error to tell
    return is_interrupted;
}

std::optional<Pixel> parse_pixel(const std::string& text, const std::string& size)
{
    if (text.empty()) return std::nullopt;
    const auto [width, height] = parse_size(size);
    Pixel pixel{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%d,%d%c", &pixel.x, &pixel.y, &rest) != 2)
        throw std::runtime_error("--pixel " + text + ": not a pixel; give X,Y from the upper left");
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= width || pixel.y >= height)
        throw std::runtime_error(fmt::format(
            "--pixel {}: outside the picture; it has {} x {} pixels", text, width, height));
    return pixel;
}

void add_output_flags(CLI::App& app, RenderCommand& command)
{
    app.add_option("-o,--output", command.outputs,
                   "Picture to write: .exr holds every layer, .png .jpg .tif the view. May be "
                   "given more than once. Default: diptych.png")
        ->allow_extra_args(false);
    add_picture_flags(app, command.view, command.write);
    app.add_flag("--quiet", command.is_quiet, "Print errors only");
    app.add_flag("--reproducible", command.is_reproducible,
                 "Leave times, device and command line out of the pictures");
}

CLI::App* add_render_command(CLI::App& app, RenderCommand& command)
{
    CLI::App* render = app.add_subcommand("render", "Render a scene to pictures");
    add_scene_flags(*render, command.scene);
    add_output_flags(*render, command);
    add_device_flags(*render, command.device);
    add_error_flags(*render, command.error);
    render->add_flag("--audit", command.is_audited,
                     "Render some blocks again by independent samples and print the error found");
    render->add_option("--refresh", command.refresh,
                       "Write the pictures in progress so often, as 10s or 2m");
    render->add_option("--preview", command.preview,
                       "Show the picture in progress in a running viewer: tev or tev:HOST:PORT");
    render->add_option(
        "--pixel", command.pixel,
        "Run the paths of one pixel only, X,Y from the upper left, and print its value");
    render->add_option("--capture", command.capture,
                       "Keep the pixel's hits on procedural textures, with what the device made of "
                       "them, for diptych debug --replay");
    render
        ->add_option(
            "--aov", command.scene.load.aovs,
            "Also write what this texture node gives where the camera sees a surface, raw, "
            "as layer aov.NODE of the .exr. May be given more than once")
        ->allow_extra_args(false);
    add_checkpoint_flags(*render, command.checkpoint);
    render->add_flag(
        "--strict", command.is_strict,
        "Make a sample or a texture's result that is not finite an error instead of going on");
    render->add_option("--json", command.json,
                       "Write a report: times by stage, rays, memory, effects, SHA-256 of every "
                       "layer. - is standard output");
    for (const char* name : {"--output", "--json", "--checkpoint", "--pixel", "--capture"})
        refuse_empty(render->get_option(name));
    render->footer(
        "SIGINT and SIGTERM end the pass under way; the pictures then hold the samples so far. A "
        "second one ends\nthe program at once.\n"
        "Exit codes: 0 done, 2 error (one line on standard error; no picture), 130 interrupted "
        "(pictures written).");
    return render;
}

int run_render_command(const RenderCommand& command)
{
    RenderCommand run = command;
    run.device = with_device_list(run.device);
    if (run.outputs.empty() && wants_picture(run)) run.outputs.push_back("diptych.png");
    const image::WriteOptions write = picture_options(run.view, run.write, run.outputs);
    for (const std::string& path : run.outputs) image::check_writable(path);
    expect_all_different(run);
    const bool has_layers = std::ranges::any_of(run.outputs, image::holds_layers);
    if (!run.scene.load.aovs.empty() && !has_layers && run.json.empty() &&
        run.checkpoint.file.empty())
        throw std::runtime_error("--aov: pictures with layers are .exr files; name one with -o");
    if (!run.json.empty() && run.json != "-") image::check_text_writable(run.json);
    if (!run.capture.empty()) {
        if (run.pixel.empty())
            throw std::runtime_error("--capture " + run.capture +
                                     ": of which pixel? add --pixel X,Y");
        if (run.device.takes_list)
            throw std::runtime_error("--capture: what one device made of a texture; name one "
                                     "with --device");
        image::check_text_writable(run.capture);
    }

    watch_for_interrupts();
    RenderOptions options;
    options.pixel = parse_pixel(run.pixel, run.scene.size);
    options.viewer = {write.exposure, write.view};
    set_targets(run.error, run.scene.samples, options);
    set_range(run.checkpoint.range, options);
    expect_error_is_known(run, options);
    ProgressPictures pictures(run, options, write);
    options.stop = &is_interrupted;
    if (options.pixel && !run.checkpoint.file.empty())
        throw std::runtime_error("--checkpoint: not for a single pixel; leave out --pixel");
    RenderCheckpoint checkpoint(run.checkpoint);
    const std::unique_ptr<Backend> backend =
        make_backend(run.device.backend, options_from_flags(run.device));
    SceneData scene = load_from_flags(run.scene, is_adaptive(options));
    std::ranges::move(generated_notices(scene, run.device), std::back_inserter(scene.notices));
    check_film_fits(run, scene, options);
    if (!run.is_quiet) print_plan(scene, *backend, backend->plan(scene), options);
    std::optional<RenderState> start =
        checkpoint.begin(scene, options, run.device.backend, *backend, run.is_quiet);
    backend->upload(scene);
    options.observe = [&](const RenderState& state) {
        checkpoint.observe(state);
        pictures.look_at(state.film);
    };

    pictures.begin(scene.settings[0]);
    ProgressBar bar;
    if (!run.is_quiet) options.progress = [&](const Progress& progress) { bar.show(progress); };
    std::string failure;
    options.failure = &failure;
    const RenderResult result = render(*backend, scene, options, std::move(start));
    if (!run.is_quiet) bar.finish();
    const std::string lost = checkpoint.finish(result.film, result.schedule);
    if (!failure.empty()) {
        keep_what_is_done(run, scene, *backend, options, result, write);
        throw std::runtime_error(failure);
    }
    if (!result.is_complete && result.statistics.paths == 0 && checkpoint.earlier_seconds() == 0)
        fmt::print(stderr, "notice: interrupted before the first samples; pictures are black\n");

    const Faults& faults = result.film.faults();
    const std::optional<FaultPlace> place = find_fault(*backend, faults, options.samples);
    if (faults.count > 0 && run.is_strict)
        throw std::runtime_error(fault_text(faults, place) +
                                 "; render without --strict to drop them");
    if (faults.count > 0) fmt::print(stderr, "notice: {}\n", fault_text(faults, place));

    const TextureFaultReport textures =
        find_texture_faults(*backend, run.device.backend, scene, result.film.texture_faults());
    for (int kind = 0; kind < TEXTURE_FAULT_COUNT; ++kind) {
        if (textures.faults.of_kind[size_t(kind)].count == 0) continue;
        const std::string text = texture_fault_text(textures, kind);
        if (kind == TEXTURE_FAULT_NOT_FINITE && run.is_strict)
            throw std::runtime_error(text + "; render without --strict to go on with 0");
        fmt::print(stderr, "notice: {}\n", text);
    }

    image::Picture picture;
    if (!run.outputs.empty() || !run.json.empty())
        picture = picture_of(result.film, options.viewer);
    if (!run.outputs.empty()) add_metadata(picture, run, scene, *backend, result);
    image::write_pictures(run.outputs, picture, write);
    pictures.finish(result.film);  // after the files, which wait for no viewer
    if (options.pixel)             // beside a report that programs read
        print_pixel(run.json == "-" ? stderr : stdout, result.film, *options.pixel);
    if (!run.capture.empty()) {
        const TextureCapture capture =
            capture_textures(*backend, scene, run.scene, run.device.backend, *options.pixel);
        write_capture(run.capture, capture);
        if (!run.is_quiet)
            fmt::print(stderr, "captured {} hits in {}\n", capture.hits.size(), run.capture);
    }
    const double aim = options.error > 0 ? options.error : 1;
    std::optional<ErrorSummary> error;
    if (result.film.has_standard_error() && !options.pixel)
        error = summarise_error(result.film, error_grid(scene.settings[0]), options.viewer, aim);
    if (!run.is_quiet) print_summary(run, result);
    if (!run.is_quiet && error) fmt::print(stderr, "{}\n", ending_text(result, options, *error));
    std::optional<Audit> audited;
    if (run.is_audited) {
        audited = audit(*backend, scene, options, result, aim,
                        run.is_quiet ? nullptr : tell_audit_progress);
        print_audit(*audited, aim);
    }
    if (!run.json.empty()) {
        const std::string report =
            json_report(run, scene, options, *backend, result, picture, place, textures, error,
                        audited, checkpoint.writer()) +
            "\n";
        if (run.json == "-")
            std::cout << report << std::flush;
        else
            image::write_text(run.json, report);
    }
    if (!lost.empty()) throw std::runtime_error(lost);
    const bool is_audit_cut = audited && audited->blocks < audited->chosen;
    return result.is_complete && !is_audit_cut ? 0 : 130;
}

}  // namespace diptych
