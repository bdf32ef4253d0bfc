#include "tests/host/render/spikes.hpp"

#include "common/random.h"
#include "host/render/render.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spikes {
namespace {

using namespace diptych;

constexpr int width = 64, height = 48;
constexpr int most_samples = 4096;     // by the rule by pixels, as where it was first measured
constexpr int enough_samples = 65536;  // so many that the error alone ends a block
constexpr double target = 1;           // JND

// How many of n samples are spikes: an inverted binomial distribution.
int spikes_of(double p, int n, uint key)
{
    double u = (double(hash_uint(key)) + 0.5) / 4294967296.0;
    double share = std::pow(1 - p, n);
    int k = 0;
    for (; u > share && k < n; ++k) {
        u -= share;
        share *= p / (1 - p) * (n - k) / (k + 1);
    }
    return k;
}

uint key_of(unsigned seed, int x, int y, int sample)
{
    return hash_pair(hash_pair(seed, uint(y * width + x)), uint(sample));
}

class SpikeBackend final : public Backend {
public:
    SpikeBackend(const Pixel& pixel, unsigned seed) : pixel_(pixel), seed_(seed) {}

    std::string description() const override { return "spikes"; }
    Plan plan(const SceneData&) const override
    {
        Plan plan;
        plan.items = plan.most_items = 64;
        return plan;
    }
    void upload(SceneData&) override {}
    void update_materials(const SceneData&) override {}
    void update_textures(const SceneData&) override {}
    void trace(const Dispatch&, const std::function<void(const StageState&)>&) override {}
    Statistics statistics() const override { return {}; }

    void render(const Dispatch& dispatch, Results& results) override
    {
        const size_t n = size_t(dispatch.results());
        results.sum_radiance.assign(3 * n, 0);
        results.sum_alpha.assign(n, float(dispatch.samples));
        results.sum_albedo.assign(3 * n, 0.5f * float(dispatch.samples));
        results.sum_normal.assign(3 * n, 0);
        results.sum_distance.assign(n, 0);
        results.object_id.assign(n, 0);
        results.material_id.assign(n, 0);
        results.fault.assign(n, 0);
        for (size_t r = 0; r < n; ++r) {
            const WorkItem& item = dispatch.items[r >> dispatch.pixel_shift];
            const uint in_item = uint(r) & ((1u << dispatch.pixel_shift) - 1);
            const int x = item.x + compact_bits(in_item), y = item.y + compact_bits(in_item >> 1);
            const int count =
                spikes_of(pixel_.p, dispatch.samples, key_of(seed_, x, y, item.first_sample));
            const float sum = float(dispatch.samples) * pixel_.base + float(count) * pixel_.spike;
            for (size_t c = 0; c < 3; ++c) results.sum_radiance[c * n + r] = sum;
        }
    }

private:
    Pixel pixel_;
    unsigned seed_;
};

}  // namespace

Outcome render_to_error(const Pixel& pixel, unsigned seed, bool is_unbiased)
{
    SpikeBackend backend(pixel, seed);
    SceneData scene;
    scene.settings.resize(1);
    scene.settings[0].width = width;
    scene.settings[0].height = height;
    RenderOptions options;
    options.error = target;
    options.samples = enough_samples;
    options.is_unbiased = is_unbiased;
    const image::Picture picture = render(backend, scene, options).film.picture();
    const image::Layer& beauty = image::beauty_of(picture);
    const image::Layer* counts = image::find_layer(picture, "sample_count");
    Outcome outcome;
    for (size_t p = 0; p < counts->ids.size(); ++p) {
        outcome.mean += double(beauty.pixels[4 * p]) / double(counts->ids.size());
        outcome.samples += double(counts->ids[p]) / double(counts->ids.size());
    }
    return outcome;
}

Outcome render_by_pixels(const Pixel& pixel, unsigned seed)
{
    const int pixels = width * height, half = QUANTUM / 2;
    std::vector<double> sums[2] = {std::vector<double>(pixels), std::vector<double>(pixels)};
    std::vector<int> samples(pixels);
    std::vector<char> is_active(pixels, 1), is_bad(pixels);
    for (int first = 0; first < most_samples; first += QUANTUM) {
        for (int p = 0; p < pixels; ++p) {
            if (!is_active[p]) continue;
            for (int h = 0; h < 2; ++h)
                sums[h][p] += half * double(pixel.base) +
                              double(pixel.spike) *
                                  spikes_of(pixel.p, half,
                                            key_of(seed, p % width, p / width, first + h * half));
            samples[p] += QUANTUM;
        }
        if (first + QUANTUM < 64) continue;
        for (int p = 0; p < pixels; ++p) {
            const double mean = (sums[0][p] + sums[1][p]) / samples[p];
            const double part = sums[0][p] / (samples[p] / 2);
            const double bright = 3 * mean;
            const double error =
                3 * std::abs(mean - part) / (1e-4 + (bright < 1 ? std::sqrt(bright) : bright));
            is_bad[p] = is_active[p] && error >= 0.05;
        }
        for (int p = 0; p < pixels; ++p) {
            bool is_near_bad = false;
            for (int y = std::max(p / width - 1, 0); y <= std::min(p / width + 1, height - 1); ++y)
                for (int x = std::max(p % width - 1, 0); x <= std::min(p % width + 1, width - 1);
                     ++x)
                    is_near_bad = is_near_bad || is_bad[y * width + x];
            is_active[p] = is_active[p] && is_near_bad;
        }
    }
    Outcome outcome;
    for (int p = 0; p < pixels; ++p) {
        outcome.mean += (sums[0][p] + sums[1][p]) / samples[p] / pixels;
        outcome.samples += double(samples[p]) / pixels;
    }
    return outcome;
}

}  // namespace spikes
