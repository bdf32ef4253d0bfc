// GI-19: ending a block by its own samples takes no light from it.
#include "tests/host/render/spikes.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

constexpr unsigned seeds = 16;

// Relative, with the standard error to which the seeds know it.
struct Bias {
    double value;
    double sigma;
};

template<class Rule>
Bias bias_of(const spikes::Pixel& pixel, const Rule& rule)
{
    double sum = 0, square = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const double bias = rule(pixel, seed).mean / pixel.mean() - 1;
        sum += bias;
        square += bias * bias;
    }
    const double variance = (square - sum * sum / seeds) / (seeds - 1);
    return {sum / seeds, std::sqrt(variance / seeds)};
}

// The largest bias allowed is 0.3 %.
void expect_little(const Bias& bias, double largest_sigma)
{
    EXPECT_LT(std::abs(bias.value), 0.003 + 3 * bias.sigma) << bias.sigma;
    EXPECT_LT(bias.sigma, largest_sigma) << "the test tests little";
}

Bias our_bias(const spikes::Pixel& pixel)
{
    return bias_of(pixel,
                   [](const auto& p, unsigned seed) { return spikes::render_to_error(p, seed); });
}

TEST(StopBias, BlocksLoseNothingToRareSpikes) { expect_little(our_bias({}), 0.01); }

TEST(StopBias, BlocksLoseNothingToFrequentOnes)
{
    expect_little(our_bias({0.15f, 6, 0.005}), 0.002);
    expect_little(our_bias({0.15f, 0.6f, 0.05}), 0.002);
}

// What the test is able to see.
TEST(StopBias, TheRuleByPixelsLosesATenth)
{
    EXPECT_LT(bias_of({}, spikes::render_by_pixels).value, -0.05);
}

TEST(StopBias, UnbiasedRendersLoseNothing)
{
    const Bias bias = bias_of({}, [](const auto& pixel, unsigned seed) {
        return spikes::render_to_error(pixel, seed, true);
    });
    expect_little(bias, 0.01);
}

}  // namespace
