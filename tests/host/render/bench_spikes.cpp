// GI-19 as a table: bias and samples of both stopping rules, 64 seeds.
#include "tests/host/render/spikes.hpp"

#include <cmath>
#include <cstdio>

namespace {

void print_row(const char* name, const spikes::Pixel& pixel, bool is_by_pixels)
{
    constexpr int seeds = 64;
    double sum = 0, square = 0, samples = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const spikes::Outcome outcome = is_by_pixels ? spikes::render_by_pixels(pixel, seed)
                                                     : spikes::render_to_error(pixel, seed);
        const double bias = outcome.mean / pixel.mean() - 1;
        sum += bias;
        square += bias * bias;
        samples += outcome.samples / seeds;
    }
    const double mean = sum / seeds;
    const double sigma = std::sqrt((square / seeds - mean * mean) / (seeds - 1));
    std::printf("  %-34s p = %.4f  bias %+6.2f %% +- %.2f  %5.0f samples\n", name, pixel.p,
                100 * mean, 100 * sigma, samples);
}

}  // namespace

int main()
{
    const spikes::Pixel pixels[] = {{0.15f, 0.6f, 0.05}, {0.15f, 6, 0.005}, {0.15f, 60, 0.0005}};
    for (const spikes::Pixel& pixel : pixels) {
        print_row("blocks, --error 1", pixel, false);
        print_row("pixel by pixel, Cycles at 0.01", pixel, true);
    }
    return 0;
}
