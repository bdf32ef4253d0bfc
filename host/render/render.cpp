#include "host/render/render.hpp"

#include "common/random.h"

#include <algorithm>
#include <bit>
#include <chrono>

namespace diptych {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::vector<Quantum> quanta_of(int samples)
{
    std::vector<Quantum> quanta;
    for (int first = 0; first < samples;) {
        const int rest = std::min(samples - first, QUANTUM);
        const int size = int(std::bit_floor(unsigned(rest)));
        quanta.push_back({first, size});
        first += size;
    }
    return quanta;
}

std::vector<Pixel> blocks_of(int width, int height)
{
    const int size = 1 << BLOCK_SHIFT;
    std::vector<Pixel> blocks;
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size) blocks.push_back({x, y});
    std::sort(blocks.begin(), blocks.end(), [](const Pixel& a, const Pixel& b) {
        return morton_code(a.x >> BLOCK_SHIFT, a.y >> BLOCK_SHIFT) <
               morton_code(b.x >> BLOCK_SHIFT, b.y >> BLOCK_SHIFT);
    });
    return blocks;
}

RenderResult render(Backend& backend, const SceneData& scene, const RenderOptions& options)
{
    const Settings& settings = scene.settings[0];
    RenderResult result{
        Film(settings.width, settings.height, options.samples), backend.plan(scene), {}, 0, true};
    const std::vector<Pixel> places = options.pixel ? std::vector<Pixel>{*options.pixel}
                                                    : blocks_of(settings.width, settings.height);
    const size_t at_once = size_t(std::max(1, result.plan.items));

    const auto start = Clock::now();
    const auto should_stop = [&] { return options.stop && options.stop->load(); };
    const std::vector<Quantum> quanta = quanta_of(options.samples);
    double done = 0;
    Results results;
    std::vector<WorkItem> items;
    for (const Quantum& quantum : quanta) {
        for (size_t first = 0; first < places.size() && !should_stop(); first += at_once) {
            const size_t count = std::min(at_once, places.size() - first);
            items.clear();
            for (size_t k = 0; k < count; ++k) {
                const Pixel& place = places[first + k];
                items.push_back({place.x, place.y, quantum.first_sample, 0});
            }
            const Dispatch dispatch{items, quantum.samples, options.pixel ? 0 : 2 * BLOCK_SHIFT};
            backend.render(dispatch, results);
            result.film.add(dispatch, results);
            done += double(quantum.samples) * double(count) / double(places.size());
            if (options.progress) {
                const Statistics statistics = backend.statistics();
                options.progress({done / options.samples, seconds_since(start),
                                  quantum.first_sample + quantum.samples,
                                  statistics.rays + statistics.shadow_rays});
            }
        }
    }
    result.is_complete = !should_stop() || done >= options.samples;
    result.seconds = seconds_since(start);
    result.statistics = backend.statistics();
    return result;
}

}  // namespace diptych
