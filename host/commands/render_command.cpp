#include "host/commands/render_command.hpp"

#include "host/commands/render_report.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <iostream>
#include <stdexcept>

namespace diptych {
namespace {

std::atomic<bool> is_interrupted{false};

extern "C" void on_interrupt(int) { is_interrupted = true; }

// Asked to stop twice, the program does so at once.
void watch_for_interrupts()
{
    struct sigaction action = {};
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESETHAND;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

image::View parse_view(const std::string& text)
{
    if (text == "standard") return image::View::Standard;
    if (text == "neutral") return image::View::Neutral;
    if (text == "filmic") return image::View::Filmic;
    throw std::runtime_error("--view " + text + ": no such view; use standard, neutral or filmic");
}

void print_pixel(const Film& film, const Pixel& pixel)
{
    const std::array<float, 3> value = film.radiance(pixel.x, pixel.y);
    fmt::print("pixel {},{}: {:.9g} {:.9g} {:.9g}\n", pixel.x, pixel.y, value[0], value[1],
               value[2]);
}

void print_summary(const RenderCommand& command, const RenderResult& result)
{
    const Statistics& statistics = result.statistics;
    const double rays = double(statistics.rays + statistics.shadow_rays);
    fmt::print(stderr, "{:.2f} s, {:.2f} million samples/s, {:.2f} million rays/s\n",
               result.seconds, double(statistics.paths) / result.seconds * 1e-6,
               rays / result.seconds * 1e-6);
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

}  // namespace

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

CLI::App* add_render_command(CLI::App& app, RenderCommand& command)
{
    CLI::App* render = app.add_subcommand("render", "Render a scene to pictures");
    add_scene_flags(*render, command.scene);
    render
        ->add_option("-o,--output", command.outputs,
                     "Picture to write: .exr holds every layer, .png .jpg .tif the view. May be "
                     "given more than once. Default: diptych.png")
        ->allow_extra_args(false);
    add_device_flags(*render, command.device);
    render->add_option(
        "--pixel", command.pixel,
        "Run the paths of one pixel only, X,Y from the upper left, and print its value");
    render->add_option("--exposure", command.write.exposure, "Stops, for display pictures")
        ->capture_default_str();
    render
        ->add_option("--view", command.view,
                     "How radiance becomes display colours: standard, neutral or filmic")
        ->capture_default_str();
    render->add_flag("--half", command.write.half, "EXR: colours and normals in half precision");
    render->add_flag("--16bit", command.write.sixteen_bit, "PNG and TIFF: 16 bits a channel");
    render->add_flag("--quiet", command.is_quiet, "Print errors only");
    render->add_flag("--strict", command.is_strict,
                     "Make a sample that is not finite an error instead of dropping it");
    render->add_flag("--reproducible", command.is_reproducible,
                     "Leave times, device and command line out of the pictures");
    render->add_option("--json", command.json,
                       "Write a report: times by stage, rays, memory, effects, SHA-256 of every "
                       "layer. - is standard output");
    render->footer(
        "SIGINT and SIGTERM end the pass under way; the pictures then hold the samples so far. A "
        "second one ends\nthe program at once.\n"
        "Exit codes: 0 done, 2 error (one line on standard error; no picture), 130 interrupted "
        "(pictures written).");
    return render;
}

int run_render_command(const RenderCommand& command)
{
    image::WriteOptions write = command.write;
    write.view = parse_view(command.view);
    if (!(std::abs(write.exposure) <= 100))
        throw std::runtime_error(fmt::format(
            "--exposure {}: out of range; give stops from -100 to 100", write.exposure));
    RenderCommand run = command;
    if (run.outputs.empty() && run.pixel.empty()) run.outputs.push_back("diptych.png");
    for (const std::string& path : run.outputs) image::check_writable(path);
    if (!run.json.empty() && run.json != "-") image::check_file_writable(run.json);

    watch_for_interrupts();
    RenderOptions options;
    options.samples = run.scene.samples;
    options.pixel = parse_pixel(run.pixel, run.scene.size);
    options.stop = &is_interrupted;
    const std::unique_ptr<Backend> backend =
        make_backend(run.device.backend, options_from_flags(run.device));
    SceneData scene = load_from_flags(run.scene);
    if (!run.is_quiet) print_plan(scene, *backend, backend->plan(scene), options);
    backend->upload(scene);

    ProgressBar bar;
    if (!run.is_quiet) options.progress = [&](const Progress& progress) { bar.show(progress); };
    const RenderResult result = render(*backend, scene, options);
    if (!run.is_quiet) bar.finish();
    if (result.statistics.paths == 0)
        fmt::print(stderr, "notice: interrupted before the first samples; pictures are black\n");

    const Faults& faults = result.film.faults();
    const std::optional<FaultPlace> place = find_fault(*backend, faults, options.samples);
    if (faults.count > 0 && run.is_strict)
        throw std::runtime_error(fault_text(faults, place) +
                                 "; render without --strict to drop them");
    if (faults.count > 0) fmt::print(stderr, "notice: {}\n", fault_text(faults, place));

    image::Picture picture;
    if (!run.outputs.empty() || !run.json.empty()) picture = result.film.picture();
    if (!run.outputs.empty()) add_metadata(picture, run, scene, *backend, result);
    for (const std::string& path : run.outputs) image::write_picture(path, picture, write);
    if (options.pixel) print_pixel(result.film, *options.pixel);
    if (!run.is_quiet) print_summary(run, result);
    if (!run.json.empty()) {
        const std::string report = json_report(run, scene, *backend, result, picture, place) + "\n";
        if (run.json == "-")
            std::cout << report << std::flush;
        else
            image::write_file_whole(run.json, report);
    }
    return result.is_complete ? 0 : 130;
}

}  // namespace diptych
