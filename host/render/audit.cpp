#include "host/render/audit.hpp"

#include "common/random.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace diptych {
namespace {

constexpr size_t one_in = 16;
constexpr size_t least_blocks = 8;
constexpr int times_the_samples = 4;

std::vector<size_t> chosen_blocks(size_t count)
{
    const size_t wanted = std::min(count, std::max(count / one_in, least_blocks));
    std::vector<size_t> chosen(count);
    std::iota(chosen.begin(), chosen.end(), size_t(0));
    std::sort(chosen.begin(), chosen.end(),
              [](size_t a, size_t b) { return hash_uint(uint(a)) < hash_uint(uint(b)); });
    chosen.resize(wanted);
    return chosen;
}

Film render_block(Backend& backend, const BlockGrid& grid, Pixel corner, int samples, size_t most)
{
    const int side = 1 << grid.shift;
    const Window window{corner.x, corner.y, std::min(side, grid.width - corner.x),
                        std::min(side, grid.height - corner.y)};
    Film film(grid.width, grid.height, window, batch_count);
    const std::vector<Quantum> plan = quanta_of(samples);
    std::vector<WorkItem> items;
    Results results;
    for (size_t q = 0; q < plan.size(); ++q) {
        items.push_back({corner.x, corner.y, plan[q].first_sample, 0});
        const bool is_last = q + 1 == plan.size() || plan[q + 1].samples != plan[q].samples;
        if (!is_last && items.size() < most) continue;
        const Dispatch dispatch{items, plan[q].samples, grid.pixel_shift()};
        backend.render(dispatch, results);
        film.add(dispatch, results);
        items.clear();
    }
    return film;
}

// Sums over the pixels of one block or of all.
struct Tally {
    double square = 0;  // of the error, the new samples' own noise taken off
    double pixels = 0;
    double within = 0;
    double predicted = 0;
    double covered = 0;
};

Tally compare_block(const Film& film, const Film& again, const image::Viewer& viewer, double bar)
{
    Tally tally;
    const Window& window = again.data().window;
    for (int y = window.y; y < window.y + window.height; ++y)
        for (int x = window.x; x < window.x + window.width; ++x) {
            const double error = double(
                image::visible_difference(film.radiance(x, y), again.radiance(x, y), viewer));
            const double noise = double(pixel_error(again, x, y, viewer));
            const bool is_within = error <= bar;
            const bool is_predicted = double(pixel_bound(film, x, y, viewer)) <= bar;
            tally.square += error * error - noise * noise;
            tally.pixels += 1;
            tally.within += is_within;
            tally.predicted += is_predicted;
            tally.covered += is_predicted && is_within;
        }
    return tally;
}

void add_interval(Audit& audit, const std::vector<Tally>& tallies)
{
    double sum = 0, square = 0;
    for (const Tally& tally : tallies) {
        const double mean = tally.square / tally.pixels;
        sum += mean;
        square += mean * mean;
    }
    const double n = double(tallies.size());
    const double mean = sum / n;
    const double variance = n > 1 ? std::max(square / n - mean * mean, 0.0) / (n - 1) : 0;
    const double half = 1.96 * std::sqrt(variance);
    audit.rms = std::sqrt(std::max(mean, 0.0));
    audit.rms_low = std::sqrt(std::max(mean - half, 0.0));
    audit.rms_high = std::sqrt(std::max(mean + half, 0.0));
}

}  // namespace

Audit audit(Backend& backend, SceneData& scene, const RenderOptions& options,
            const RenderResult& result, double bar,
            const std::function<void(int done, int of, bool is_end)>& tell)
{
    const auto start = std::chrono::steady_clock::now();
    const BlockGrid grid = grid_of(scene.settings.at(0), options);
    const std::vector<Quantum> plan = plan_of(options);
    const unsigned seed = scene.settings[0].seed;
    scene.settings[0].seed = hash_uint(seed + 0x51ed270bu);
    backend.upload(scene);
    const size_t most = size_t(std::max(1, result.plan.most_items));

    Audit audit;
    Tally all;
    int calm = 0, wrong = 0;
    std::vector<Tally> tallies;
    const std::vector<size_t> chosen = chosen_blocks(grid.corners.size());
    audit.chosen = int(chosen.size());
    for (const size_t b : chosen) {
        if (tell) tell(int(tallies.size()), audit.chosen, false);
        const int quanta = result.schedule.blocks[b].quanta;
        if (quanta == 0 || (options.stop && options.stop->load())) continue;
        const Quantum& last = plan[size_t(quanta) - 1];
        const int samples = std::max(last.first_sample + last.samples, 4 * QUANTUM);
        const Film again =
            render_block(backend, grid, grid.corners[b], times_the_samples * samples, most);
        const Tally tally = compare_block(result.film, again, options.viewer, bar);
        tallies.push_back(tally);
        const BlockError predicted =
            block_error(result.film, options.viewer, grid.corners[b], grid.shift);
        const bool is_calm = predicted.rms <= int(bar * error_unit);
        calm += is_calm;
        wrong += is_calm && tally.square > bar * bar * tally.pixels;
        all.pixels += tally.pixels;
        all.within += tally.within;
        all.predicted += tally.predicted;
        all.covered += tally.covered;
    }
    scene.settings[0].seed = seed;
    backend.upload(scene);
    audit.blocks = int(tallies.size());
    if (tell) tell(audit.blocks, audit.chosen, true);
    if (!tallies.empty()) add_interval(audit, tallies);
    if (all.pixels > 0) audit.share_within = all.within / all.pixels;
    if (calm > 0) audit.share_false = double(wrong) / calm;
    if (all.predicted > 0) audit.share_covered = all.covered / all.predicted;
    audit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return audit;
}

}  // namespace diptych
