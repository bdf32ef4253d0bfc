#include "host/commands/selftest_command.hpp"

#include "host/commands/selftest_scenes.hpp"
#include "host/render/render.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#ifdef DIPTYCH_WITH_OPENCL
#include "backends/opencl_devices.hpp"
#endif

namespace diptych {
namespace {

constexpr int selftest_samples = 4;

constexpr unsigned needs_of[] = {
#define STAGE_NEEDS(name, body, when, needs) needs,
    STAGES(STAGE_NEEDS)
#undef STAGE_NEEDS
};

// Sums of the dispatch's pixels, the work of compact, accumulate and accumulate_aovs. Pixels with a
// path that parted are left out.
void compare_results(const Results& a, const Results& b, const Dispatch& dispatch,
                     const TraceComparison& traces, const Bound& bound,
                     std::array<StageTally, STAGE_COUNT>& tallies)
{
    std::vector<char> has_parted(size_t(dispatch.results()), 0);
    for (int p = 0; p < dispatch.paths(); ++p)
        if (traces.has_parted[size_t(p)]) has_parted[size_t(result_of_path(dispatch, p))] = 1;
    std::vector<char> is_off(has_parted.size(), 0);
    const auto compare = [&](const auto& x, const auto& y, StageTally& tally) {
        for (size_t k = 0; k < x.size(); ++k) {
            const size_t r = k % has_parted.size();
            if (has_parted[r]) continue;
            const double u = double(x[k]), v = double(y[k]);
            const double ulps = ulps_between(u, v);
            ++tally.values;
            tally.largest_ulps = std::max(tally.largest_ulps, ulps);
            const double scale = std::max({std::abs(u), std::abs(v), 1e-3});
            if (ulps > bound.ulps && !(std::abs(u - v) <= bound.relative * scale)) is_off[r] = 1;
        }
    };
    const auto count = [&](StageTally& tally) {
        tally.paths += dispatch.results();
        tally.parted += int(std::count(is_off.begin(), is_off.end(), 1));
        std::ranges::fill(is_off, 0);
    };
    if (!a.sum_aov.empty()) {
        compare(a.sum_aov, b.sum_aov, tallies[STAGE_accumulate_aovs]);
        count(tallies[STAGE_accumulate_aovs]);
    }
#define COMPARE_RESULT(type, name) compare(a.name, b.name, tallies[STAGE_accumulate]);
    RESULT_BUFFERS(COMPARE_RESULT)
#undef COMPARE_RESULT
    compare(a.texture_faults, b.texture_faults, tallies[STAGE_accumulate]);
    count(tallies[STAGE_accumulate]);
}

std::string text_of(const SelftestScene& scene, const Dispatch& dispatch, const Divergence& first)
{
    const WorkItem& item = dispatch.items[size_t(first.path / (dispatch.samples << 8))];
    return fmt::format(
        "{}: {} parts first at bounce {}, path {} of the block at {},{}: {}{} is {:.9g}, twin has "
        "{:.9g}",
        scene.name, stage_names[first.stage], first.bounce, first.path % (dispatch.samples << 8),
        item.x, item.y, first.buffer,
        first.component < 0 ? "" : fmt::format(".{}", "xyz"[first.component]), first.a, first.b);
}

void add(StageTally& sum, const StageTally& tally)
{
    sum.values += tally.values;
    sum.largest_ulps = std::max(sum.largest_ulps, tally.largest_ulps);
    sum.paths += tally.paths;
    sum.parted += tally.parted;
}

void print(const SelftestResult& result)
{
    fmt::print("{:<18}{:>12}{:>12}{:>10}{:>18}\n", "stage", "values", "paths", "parted",
               "largest (ulp)");
    for (const StageVerdict& row : result.stages)
        fmt::print("{:<18}{:>12}{:>12}{:>10}{:>18.9g}  {}\n", row.stage, row.tally.values,
                   row.tally.paths, row.tally.parted, row.tally.largest_ulps,
                   row.is_ok ? "ok" : "FAILED");
    for (const std::string& line : result.details) fmt::print("{}\n", line);
}

}  // namespace

Allowance allowance_for(const std::string& backend, const BackendOptions& options)
{
    if (backend == "double")
        return {{0, 1e-3}, 0.02, "double precision; paths part where float rounds to another side"};
    if (backend == "cpu")
        return {{0, 0}, 0.001, "the same arithmetic; Embree may see another triangle at an edge"};
    if (options.fast_math) return {{0, 1e-3}, 0.02, "fast math rounds as it likes"};
#ifdef DIPTYCH_WITH_OPENCL
    if (backend == "opencl" && !pick_opencl_device(options.device).is_exact)
        return {{0, 1e-4}, 0.01, "this device's division and square root are not exact"};
#endif
    return {{0, 0}, 0, "the same bits"};
}

SelftestResult run_selftest(Backend& device, Backend& twin, const Allowance& allowance)
{
    std::array<StageTally, STAGE_COUNT> tallies{};
    SelftestResult result;
    for (SelftestScene& scene : selftest_scenes()) {
        try {
            twin.upload(scene.scene);
        } catch (const std::runtime_error& error) {
            if ((scene.scene.effects & EFFECT_PROCEDURAL) == 0) throw;
            result.details.push_back(fmt::format("{}: left out: {}", scene.name, error.what()));
            continue;
        }
        device.upload(scene.scene);
        const Settings& settings = scene.scene.settings[0];
        for (const Pixel& block : blocks_of(settings.width, settings.height)) {
            const WorkItem item{block.x, block.y, 0, 0};
            const Dispatch dispatch{{&item, 1}, selftest_samples};
            const TraceComparison traces =
                compare_traces(device, twin, scene.scene.effects, dispatch, allowance.bound);
            for (int s = 0; s < STAGE_COUNT; ++s) add(tallies[size_t(s)], traces.stages[size_t(s)]);
            if (traces.first && result.details.size() < 5)
                result.details.push_back(text_of(scene, dispatch, *traces.first));
            Results a, b;
            device.render(dispatch, a);
            twin.render(dispatch, b);
            compare_results(a, b, dispatch, traces, allowance.bound, tallies);
        }
    }
    for (int s = 0; s < STAGE_COUNT; ++s) {
        if (s == STAGE_compact) continue;       // seen in what accumulate makes of the paths
        if (s == STAGE_decide_alpha) continue;  // seen in where intersect and occlusion end
        const StageTally& tally = tallies[size_t(s)];
        const bool is_of_textures = (needs_of[s] & USER_TEXTURE_EFFECTS) != 0;
        if (is_of_textures && tally.paths == 0) continue;  // twin has no compiler here
        const bool is_ok = tally.paths > 0 && tally.values > 0 &&
                           double(tally.parted) <= allowance.parted_share * double(tally.paths);
        result.is_ok = result.is_ok && is_ok;
        result.stages.push_back(
            {s == STAGE_accumulate ? "compact+accumulate" : stage_names[s], tally, is_ok});
    }
    return result;
}

CLI::App* add_selftest_command(CLI::App& app, SelftestCommand& command)
{
    CLI::App* selftest =
        app.add_subcommand("selftest", "Compare every stage of a device with twin: run this first "
                                       "on a new GPU");
    selftest->footer(
        "Five built-in scenes that together call for every effect are traced stage by stage on "
        "the device\nand as C++ on this processor (twin), from the same sources. A row a stage: "
        "numbers compared, paths that\nentered it, paths that left it with a number beyond what "
        "the device may differ by, and the largest\ndifference in units in the last place. A path "
        "is let go where it parts, so that only the stage that\nparted it is blamed.\n"
        "Exit code: 0 every stage is ok, 1 one is not, 2 error.");
    command.device.backend = "opencl";
    add_device_flags(*selftest, command.device);
    return selftest;
}

int run_selftest_command(const SelftestCommand& command)
{
    const auto start = std::chrono::steady_clock::now();
    const std::string& name = command.device.backend;
    if (name == "twin")
        throw std::runtime_error("--backend twin: it is what the others are compared with; choose "
                                 "opencl, cpu or double");
    const BackendOptions options = options_from_flags(command.device);
    const std::unique_ptr<Backend> device = make_backend(name, options);
    const std::unique_ptr<Backend> twin = make_backend("twin", BackendOptions{});
    const Allowance allowance = allowance_for(name, options);
    fmt::print("{}\nagainst twin; allowed: {}, parted {:g} %: {}\n\n", device->description(),
               allowance.bound.text(), allowance.parted_share * 100, allowance.reason);
    const SelftestResult result = run_selftest(*device, *twin, allowance);
    print(result);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    fmt::print("\n{} in {:.1f} s\n", result.is_ok ? "every stage is ok" : "FAILED",
               elapsed.count());
    return result.is_ok ? 0 : 1;
}

}  // namespace diptych
