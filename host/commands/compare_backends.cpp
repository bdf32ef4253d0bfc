#include "host/commands/compare_backends.hpp"

#include "host/commands/render_report.hpp"
#include "host/image/whole_file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <stdexcept>
#include <tuple>
#include <unistd.h>

namespace diptych {
namespace {

constexpr size_t pixels_at_once = 16;
constexpr size_t most_traced_pixels = 1024;

// Two pictures on disk for as long as the metrics read them.
class PicturePair {
public:
    PicturePair(const image::Picture& a, const image::Picture& b)
    {
        std::string name = (std::filesystem::temp_directory_path() / "diptych-XXXXXX").string();
        if (!mkdtemp(name.data()))
            throw std::runtime_error(name + ": " + std::strerror(errno) +
                                     "; set TMPDIR to a folder that can be written");
        folder_ = name;
        image::write_picture(first(), a);
        image::write_picture(second(), b);
    }
    ~PicturePair()
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    PicturePair(const PicturePair&) = delete;
    PicturePair& operator=(const PicturePair&) = delete;

    std::string first() const { return (folder_ / "a.exr").string(); }
    std::string second() const { return (folder_ / "b.exr").string(); }

private:
    std::filesystem::path folder_;
};

std::pair<std::string, std::string> parse_backends(const std::string& text)
{
    const size_t comma = text.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == text.size() ||
        text.find(',', comma + 1) != std::string::npos)
        throw std::runtime_error("--backends " + text + ": give two names, as cpu,opencl");
    return {text.substr(0, comma), text.substr(comma + 1)};
}

DeviceFlags flags_of(const CompareBackendsCommand& command, const std::string& backend)
{
    DeviceFlags flags = command.device;
    flags.backend = backend;
    if (backend != "twin") flags.options.debug_kernels = false;
    return flags;
}

std::unique_ptr<Backend> backend_of(const CompareBackendsCommand& command, const std::string& name,
                                    SceneData& scene)
{
    std::unique_ptr<Backend> backend =
        make_backend(name, options_from_flags(flags_of(command, name)));
    if (!command.is_quiet) fmt::print(stderr, "{}: {}\n", name, backend->description());
    backend->upload(scene);
    return backend;
}

// The scene's, and of what the backends run, each once.
std::vector<std::string> notices_of(const SceneData& scene, const CompareBackendsCommand& command,
                                    const std::vector<std::string>& backends)
{
    std::vector<std::string> notices = scene.notices;
    for (const std::string& backend : backends)
        for (std::string& line : generated_notices(scene, flags_of(command, backend)))
            if (std::ranges::find(notices, line) == notices.end())
                notices.push_back(std::move(line));
    return notices;
}

image::Picture picture_from(Backend& backend, const SceneData& scene,
                            const CompareBackendsCommand& command)
{
    RenderOptions options;
    options.samples = command.scene.samples;
    ProgressBar bar;
    if (!command.is_quiet) options.progress = [&](const Progress& now) { bar.show(now); };
    image::Picture picture = render(backend, scene, options).film.picture();
    if (!command.is_quiet) bar.finish();
    return picture;
}

bool is_layer_within(const image::Layer& a, const image::Layer& b, size_t pixel, const Bound& bound)
{
    const size_t n = a.channels.size();
    for (size_t k = pixel * n; !a.ids.empty() && k < (pixel + 1) * n; ++k)
        if (a.ids[k] != b.ids[k]) return false;
    double scale = 0;
    for (size_t k = pixel * n; !a.pixels.empty() && k < (pixel + 1) * n; ++k)
        scale = std::max({scale, std::abs(double(a.pixels[k])), std::abs(double(b.pixels[k]))});
    for (size_t k = pixel * n; !a.pixels.empty() && k < (pixel + 1) * n; ++k) {
        const double x = a.pixels[k], y = b.pixels[k];
        if (ulps_between(x, y) > bound.ulps && !(std::abs(x - y) <= bound.relative * scale))
            return false;
    }
    return true;
}

// The same samples on both sides differ only where a path parted: the mean difference of the
// pictures is then zero within its standard error, taken over the pixels.
struct MeanDifference {
    double mean = 0;
    double standard_error = 0;
    double brightness = 0;

    bool is_zero() const
    {
        return std::abs(mean) <= std::max(4 * standard_error, 1e-4 * brightness);
    }
};

MeanDifference mean_difference(const image::Picture& a, const image::Picture& b)
{
    const std::vector<float>& x = image::beauty_of(a).pixels;
    const std::vector<float>& y = image::beauty_of(b).pixels;
    const double n = double(x.size() / 4);
    double sum = 0, squares = 0, brightness = 0;
    for (size_t k = 0; k < x.size(); k += 4) {
        double d = 0;
        for (size_t c = 0; c < 3; ++c) {
            d += (double(y[k + c]) - double(x[k + c])) / 3;
            brightness += double(x[k + c]) / 3 / n;
        }
        sum += d;
        squares += d * d;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n), brightness};
}

// What was found, for text and JSON.
struct Findings {
    std::string a, b;  // names of the backends
    std::vector<std::string> notices;
    Bound bound;
    size_t pixels = 0;
    std::vector<Pixel> differing;
    std::optional<PixelDivergence> divergence;
    MeanDifference difference;
    image::CompareResult metrics;
    bool is_within = true;
    std::string verdict;
};

void judge(Findings& found, const CompareBackendsCommand& command)
{
    const auto is_exact = [](const std::string& name) {
        return name == "twin" || name == "opencl";
    };
    const bool expects_bound = !command.bound.empty() || (is_exact(found.a) && is_exact(found.b) &&
                                                          !command.device.options.fast_math);
    if (!command.compare.limits.empty()) {
        found.is_within = found.metrics.within;
        found.verdict = found.is_within ? "within the given limits" : "outside a given limit";
        if (command.bound.empty()) return;
    }
    if (expects_bound) {
        const bool is_same = found.differing.empty();
        found.is_within = found.is_within && is_same;
        if (!is_same || found.verdict.empty())
            found.verdict = is_same ? "the same within the bound" : "DIFFERENT beyond the bound";
        return;
    }
    found.is_within = found.difference.is_zero();
    found.verdict = fmt::format("mean difference {:.3g}, standard error {:.3g}: {}",
                                found.difference.mean, found.difference.standard_error,
                                found.is_within ? "statistically equal" : "BIASED");
}

std::string text_of(const Findings& found)
{
    std::string text;
    for (const image::Measurement& m : found.metrics.measurements) {
        text += fmt::format("{:<12} {:.6g}", m.metric, m.value);
        if (m.limited) text += fmt::format("   {} {:.6g}", m.within ? "within" : "ABOVE", m.limit);
        text += '\n';
    }
    text += fmt::format("{} of {} pixels differ (bound: {})\n", found.differing.size(),
                        found.pixels, found.bound.text());
    if (found.divergence) {
        const auto& [where, x, y, sample] = *found.divergence;
        const std::string part =
            where.component < 0 ? "" : fmt::format(".{}", "xyz"[where.component]);
        text += fmt::format(
            "first divergence: stage {}, bounce {}, pixel {},{}, sample {}: {}{} is {:.9g} in {}, "
            "{:.9g} in {}\n",
            stage_names[where.stage], where.bounce, x, y, sample, where.buffer, part, where.a,
            found.a, where.b, found.b);
    } else if (!found.differing.empty()) {
        text += fmt::format("first divergence: stage accumulate, pixel {},{}: the states of its "
                            "paths agree within the bound, their sums do not\n",
                            found.differing[0].x, found.differing[0].y);
    }
    return text + found.verdict + "\n";
}

std::string json_of(const Findings& found, const CompareBackendsCommand& command)
{
    nlohmann::json report = nlohmann::json::parse(found.metrics.json);
    report["scene"] = command.compare.reference.empty() ? "demo" : command.compare.reference;
    report["reference"] = found.a;
    report["test"] = found.b;
    report["bound"] = found.bound.text();
    report["differing_pixels"] = found.differing.size();
    report["mean_difference"] = found.difference.mean;
    report["mean_difference_standard_error"] = found.difference.standard_error;
    report["notices"] = found.notices;
    report["verdict"] = found.verdict;
    report["within"] = found.is_within;
    if (found.divergence) {
        const auto& [where, x, y, sample] = *found.divergence;
        report["divergence"] = {{"stage", stage_names[where.stage]},
                                {"bounce", where.bounce},
                                {"x", x},
                                {"y", y},
                                {"sample", sample},
                                {"buffer", where.buffer},
                                {"component", where.component},
                                {"values", {where.a, where.b}}};
    }
    return report.dump(1);
}

}  // namespace

std::vector<Pixel> differing_pixels(const image::Picture& a, const image::Picture& b,
                                    const Bound& bound)
{
    std::vector<Pixel> pixels;
    const int size = 1 << BLOCK_SHIFT;
    for (const Pixel& block : blocks_of(a.width, a.height))
        for (int y = block.y; y < std::min(block.y + size, a.height); ++y)
            for (int x = block.x; x < std::min(block.x + size, a.width); ++x)
                for (const image::Layer& layer : a.layers) {
                    const image::Layer* other = image::find_layer(b, layer.name);
                    if (!other || layer.name == "standard_error") continue;
                    if (is_layer_within(layer, *other, size_t(y) * size_t(a.width) + size_t(x),
                                        bound))
                        continue;
                    pixels.push_back({x, y});
                    break;
                }
    return pixels;
}

std::optional<PixelDivergence> find_divergence(Backend& a, Backend& b, const SceneData& scene,
                                               int samples, const std::vector<Pixel>& pixels,
                                               const Bound& bound)
{
    const size_t room = size_t(std::min(a.plan(scene).items, b.plan(scene).items));
    const size_t at_once = std::clamp<size_t>(room, 1, pixels_at_once);
    const size_t end = std::min(pixels.size(), most_traced_pixels);
    std::optional<PixelDivergence> earliest;
    const auto order = [](const PixelDivergence& d) {
        return std::tuple(d.divergence.bounce, d.divergence.stage);
    };
    for (size_t first = 0; first < end && !earliest; first += at_once)
        for (const Quantum& quantum : quanta_of(samples)) {
            std::vector<WorkItem> items;
            for (size_t k = first; k < std::min(first + at_once, end); ++k)
                items.push_back({pixels[k].x, pixels[k].y, quantum.first_sample, 0});
            const Dispatch dispatch{items, quantum.samples, 0};
            const TraceComparison traces = compare_traces(a, b, scene.effects, dispatch, bound);
            if (!traces.first) continue;
            const int path = traces.first->path;
            const WorkItem& item = items[size_t(path / quantum.samples)];
            const PixelDivergence found{*traces.first, item.x, item.y,
                                        item.first_sample + path % quantum.samples};
            if (!earliest || order(found) < order(*earliest)) earliest = found;
        }
    return earliest;
}

Bound default_bound(const std::string& a, const std::string& b, bool fast_math)
{
    return (a == "double") != (b == "double") || fast_math ? Bound{0, 1e-3} : Bound{0, 0};
}

void add_compare_backends_flags(CLI::App& compare, CompareBackendsCommand& command)
{
    const std::vector<CLI::Option*> before = compare.get_options();
    compare.add_option("--bound", command.bound,
                       "With --backends: how far numbers may lie apart, as 4ulp or 0.001 "
                       "(relative). Default: 0ulp; 0.001 against double and with --fast-math");
    compare.add_flag("--quiet", command.is_quiet, "With --backends: print no progress");
    add_view_flags(compare, command.scene);
    add_device_options(compare, command.device);
    CLI::Option* backends = compare.get_option("--backends");
    for (CLI::Option* option : compare.get_options([&](const CLI::Option* candidate) {
             return std::find(before.begin(), before.end(), candidate) == before.end();
         })) {
        option->needs(backends);
        option->group("With --backends");
    }
    compare.footer(
        compare.get_footer() +
        "\n\nWith --backends A,B the scene (without one, the demo scene) is rendered with the same "
        "samples on both.\nWhere a pixel differs beyond --bound, its paths are traced again stage "
        "by stage, and the first stage,\nbounce and pixel whose state parts is named, with both "
        "values. Exit code 0 or 1 by the given limits\nand the given bound; without any: twin and "
        "opencl must give the same bits, and the mean difference of\nother pairs must be zero "
        "within 4 of its standard errors.");
}

int run_compare_backends(const CompareBackendsCommand& command, std::ostream& out)
{
    if (!command.compare.test.empty())
        throw std::runtime_error(command.compare.test +
                                 ": a second file beside --backends; give one scene, or leave "
                                 "--backends out to compare two pictures");
    Findings found;
    std::tie(found.a, found.b) = parse_backends(command.compare.backends);
    found.bound = command.bound.empty()
                      ? default_bound(found.a, found.b, command.device.options.fast_math)
                      : parse_bound(command.bound);
    SceneFlags flags = command.scene;
    flags.scene = command.compare.reference;
    SceneData scene = load_from_flags(flags);
    found.notices = notices_of(scene, command, {found.a, found.b});
    if (!command.is_quiet)
        for (const std::string& line : found.notices) fmt::print(stderr, "notice: {}\n", line);
    const std::unique_ptr<Backend> a = backend_of(command, found.a, scene);
    const std::unique_ptr<Backend> b = backend_of(command, found.b, scene);
    const image::Picture first = picture_from(*a, scene, command);
    const image::Picture second = picture_from(*b, scene, command);
    {
        const PicturePair files(first, second);
        image::CompareOptions options = command.compare;
        options.reference = files.first();
        options.test = files.second();
        found.metrics = image::compare_pictures(options);
    }
    found.pixels = size_t(first.width) * size_t(first.height);
    found.differing = differing_pixels(first, second, found.bound);
    found.difference = mean_difference(first, second);
    found.divergence = find_divergence(*a, *b, scene, flags.samples, found.differing, found.bound);
    judge(found, command);
    const bool only_json = command.compare.json && command.compare.json_file.empty();
    out << (only_json ? json_of(found, command) + "\n" : text_of(found));
    if (command.compare.json && !only_json)
        image::write_text(command.compare.json_file, json_of(found, command) + "\n");
    return found.is_within ? 0 : 1;
}

}  // namespace diptych
