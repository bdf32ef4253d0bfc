#include "host/image/compare.hpp"

#include "host/image/heat_map.hpp"
#include "host/image/image.hpp"
#include "host/image/metrics.hpp"
#include "host/image/whole_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <stdexcept>

namespace diptych::image {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

std::string known_metrics()
{
    std::string names;
    for (const char* name : METRICS) names += std::string(name) + ", ";
    return names + PREDICTION_METRIC;
}

// "flip" alone is its mean, as everyone says it.
std::string metric_name(const std::string& given)
{
    const std::string name = given == "flip" ? "flip.mean" : given;
    if (std::find(std::begin(METRICS), std::end(METRICS), name) == std::end(METRICS) &&
        name != PREDICTION_METRIC)
        fail(fmt::format("--metric {}: no such metric; there are {}", given, known_metrics()));
    return name;
}

// What was asked for, before anything is measured.
std::vector<Measurement> requested(const CompareOptions& options)
{
    if (!options.limits.empty() && options.limits.size() != options.metrics.size())
        fail(fmt::format("{} --metric and {} --max given; give one --max for each --metric",
                         options.metrics.size(), options.limits.size()));
    std::vector<Measurement> wanted;
    for (size_t k = 0; k < options.metrics.size(); ++k) {
        wanted.push_back({metric_name(options.metrics[k]), 0, !options.limits.empty(), 0, true});
        if (!options.limits.empty()) wanted.back().limit = options.limits[k];
        if (wanted.back().limited && !(wanted.back().limit >= 0))
            fail(fmt::format("--max {}: a limit is 0 or more", options.limits[k]));
    }
    if (options.metrics.empty())
        for (const char* name : METRICS) wanted.push_back({name, 0, false, 0, true});
    return wanted;
}

struct Pair {
    Colors reference;
    Colors test;
};

Pair read_pair(const CompareOptions& options)
{
    if (options.reference.empty() || options.test.empty())
        fail("two pictures are needed: compare REFERENCE TEST");
    Pair pair{colors_of(read_picture(options.reference), options.layer, options.reference),
              colors_of(read_picture(options.test), options.layer, options.test)};
    const Colors &a = pair.reference, &b = pair.test;
    if (a.width != b.width || a.height != b.height)
        fail(fmt::format(
            "{}: {} x {} pixels, but {} has {} x {}; only pictures of one size can be compared",
            options.reference, a.width, a.height, options.test, b.width, b.height));
    if (a.encoding != b.encoding)
        fail(fmt::format("{} is {}, {} is not; convert one of them first",
                         a.encoding == Encoding::Linear ? options.reference : options.test,
                         "scene-linear floating point",
                         a.encoding == Encoding::Linear ? options.test : options.reference));
    return pair;
}

// Each metric is computed when it is first asked for.
class Measuring {
public:
    Measuring(const Pair& pair, const CompareOptions& options) : pair_(pair), options_(options) {}

    const PixelDifferences& differences()
    {
        if (!differences_) differences_ = pixel_differences(pair_.reference, pair_.test);
        return *differences_;
    }

    const Bias& bias()
    {
        if (!bias_) bias_ = bias_of(pair_.reference, pair_.test);
        return *bias_;
    }

    const FlipResult& flip()
    {
        const Colors& a = pair_.reference;
        const auto evaluate = a.encoding == Encoding::Linear ? flip_hdr : flip_ldr;
        if (!flip_)
            flip_ = evaluate(a.values, pair_.test.values, a.width, a.height,
                             options_.pixels_per_degree);
        return *flip_;
    }

    const VisibleDifferences& visible()
    {
        if (!visible_) visible_ = visible_differences(pair_.reference, pair_.test, options_.viewer);
        return *visible_;
    }

    double broken()
    {
        if (!visible().broken)
            fail(fmt::format("{}: no layer predicted_error, and --metric {} needs it; render with "
                             "--error, --time or 128 samples and more",
                             options_.test, PREDICTION_METRIC));
        return *visible().broken;
    }

    double value(const std::string& metric)
    {
        if (metric == "rmse") return differences().rmse;
        if (metric == "relmse") return differences().relmse;
        if (metric == "mean") return differences().mean;
        if (metric == "max") return differences().max;
        if (metric == "bias") return bias().mean;
        if (metric == "flip.mean") return flip().mean;
        if (metric == "flip.median") return flip().median;
        if (metric == "flip.p99") return flip().p99;
        if (metric == "flip.max") return flip().max;
        if (metric == "jnd.rms") return visible().rms;
        if (metric == "jnd.p95") return visible().p95;
        if (metric == "jnd.blocks") return visible().blocks;
        if (metric == PREDICTION_METRIC) return broken();
        return yee_share(pair_.reference, pair_.test);
    }

    bool has_bias() const { return bias_.has_value(); }
    bool has_flip() const { return flip_.has_value(); }
    bool has_differences() const { return differences_.has_value(); }

private:
    const Pair& pair_;
    const CompareOptions& options_;
    std::optional<PixelDifferences> differences_;
    std::optional<Bias> bias_;
    std::optional<FlipResult> flip_;
    std::optional<VisibleDifferences> visible_;
};

Json flip_details(const FlipResult& flip, double pixels_per_degree)
{
    Json details = {{"mean", flip.mean},
                    {"median", flip.median},
                    {"p99", flip.p99},
                    {"max", flip.max},
                    {"kind", flip.exposures ? "HDR" : "LDR"},
                    {"ppd", pixels_per_degree}};
    if (flip.exposures) {
        details["tonemapper"] = "aces";
        details["exposures"] = {flip.start_exposure, flip.stop_exposure, flip.exposures};
    }
    return details;
}

Json bias_details(const Bias& bias)
{
    Json details = {{"mean", bias.mean}, {"channels", bias.channels}};
    if (!bias.half_width) return details;
    details["interval"] = {bias.mean - *bias.half_width, bias.mean + *bias.half_width};
    details["confidence"] = 0.95;
    details["channel_half_widths"] = bias.channel_half_widths;
    return details;
}

// The metrics by name; beside them what says more about one of them.
Json report_json(const CompareOptions& options, const Pair& pair, const CompareResult& result,
                 Measuring& measuring)
{
    Json report = {{"reference", options.reference},
                   {"test", options.test},
                   {"layer", options.layer},
                   {"width", pair.reference.width},
                   {"height", pair.reference.height}};
    Json limits = Json::array();
    for (const Measurement& m : result.measurements) {
        report[m.metric] = m.value;
        if (m.limited)
            limits.push_back(
                {{"metric", m.metric}, {"value", m.value}, {"max", m.limit}, {"within", m.within}});
    }
    if (measuring.has_flip())
        report["flip"] = flip_details(measuring.flip(), options.pixels_per_degree);
    if (measuring.has_bias()) report["bias_details"] = bias_details(measuring.bias());
    if (measuring.has_differences())
        report["max_pixel"] = {measuring.differences().max_x, measuring.differences().max_y};
    report["limits"] = limits;
    report["within"] = result.within;
    return report;
}

std::string line_of(const Measurement& m, const Json& report)
{
    std::string line = fmt::format("{:<12} {:.6g}", m.metric, m.value);
    if (m.metric == "bias" && report["bias_details"].contains("interval"))
        line += fmt::format("   95 % interval {:.6g} to {:.6g}",
                            report["bias_details"]["interval"][0].get<double>(),
                            report["bias_details"]["interval"][1].get<double>());
    if (m.metric == "max")
        line += fmt::format("   at pixel {},{}", report["max_pixel"][0].get<int>(),
                            report["max_pixel"][1].get<int>());
    if (m.metric == "jnd.blocks") line += "   share of the blocks whose RMS is above 1 JND";
    if (m.metric == PREDICTION_METRIC)
        line += "   share of the pixels predicted within 1 JND that are not";
    if (m.metric == "yee") line += "   share of pixels whose colour differs visibly";
    if (m.metric == "flip.mean" && report["flip"].contains("exposures"))
        line += fmt::format("   {} exposures from {:.3f} to {:.3f} stops",
                            report["flip"]["exposures"][2].get<int>(),
                            report["flip"]["exposures"][0].get<double>(),
                            report["flip"]["exposures"][1].get<double>());
    if (m.limited) line += fmt::format("   {} {:.6g}", m.within ? "within" : "ABOVE", m.limit);
    return line;
}

void print_report(const CompareOptions& options, const CompareResult& result, std::ostream& out)
{
    const Json report = Json::parse(result.json);
    if (options.json && !options.json_file.empty())
        write_text(options.json_file, result.json + "\n");
    if (options.json && options.json_file.empty())
        out << result.json << '\n';
    else
        for (const Measurement& m : result.measurements) out << line_of(m, report) << '\n';
}

}  // namespace

CompareResult compare_pictures(const CompareOptions& options)
{
    CompareResult result{requested(options), {}, true};
    if (!(std::abs(options.viewer.exposure) <= 100))
        fail(fmt::format("--exposure {}: out of range; give stops from -100 to 100",
                         options.viewer.exposure));
    if (!options.heat_map.empty()) check_writable(options.heat_map);
    const Pair pair = read_pair(options);
    Measuring measuring(pair, options);
    if (options.metrics.empty() && !pair.test.predicted_error.empty())
        result.measurements.push_back({PREDICTION_METRIC, 0, false, 0, true});
    for (Measurement& m : result.measurements) {
        m.value = measuring.value(m.metric);
        m.within = !m.limited || std::abs(m.value) <= m.limit;
        result.within &= m.within;
    }
    if (!options.heat_map.empty())
        write_picture(options.heat_map,
                      heat_map(measuring.flip().map, pair.reference.width, pair.reference.height));
    result.json = report_json(options, pair, result, measuring).dump(1);
    return result;
}

int compare_command(const CompareOptions& options, std::ostream& out, std::ostream& err)
{
    if (!options.manifest.empty()) return compare_manifest(options, out, err);
    try {
        const CompareResult result = compare_pictures(options);
        print_report(options, result, out);
        return result.within ? 0 : 1;
    } catch (const std::exception& error) {
        err << "diptych: " << error.what() << '\n';
        return 2;
    }
}

}  // namespace diptych::image
