// GI-19: ending a block by its own samples takes no light from it.
#include "tests/host/render/spikes.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

constexpr unsigned seeds = 16;

template<class Rule>
double bias_of(const spikes::Pixel& pixel, const Rule& rule)
{
    double mean = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) mean += rule(pixel, seed).mean / seeds;
    return mean / pixel.mean() - 1;
}

double our_bias(const spikes::Pixel& pixel)
{
    return bias_of(pixel,
                   [](const auto& p, unsigned seed) { return spikes::render_to_error(p, seed); });
}

// The largest bias allowed is 0.3 %; 16 seeds know it to about 0.1 %.
TEST(StopBias, BlocksLoseNothingToRareSpikes) { EXPECT_LT(std::abs(our_bias({})), 0.003); }

TEST(StopBias, BlocksLoseNothingToFrequentOnes)
{
    EXPECT_LT(std::abs(our_bias({0.15f, 6, 0.005})), 0.003);
    EXPECT_LT(std::abs(our_bias({0.15f, 0.6f, 0.05})), 0.003);
}

// What the test is able to see.
TEST(StopBias, TheRuleByPixelsLosesATenth)
{
    EXPECT_LT(bias_of({}, spikes::render_by_pixels), -0.05);
}

TEST(StopBias, UnbiasedRendersLoseNothing)
{
    const double bias = bias_of({}, [](const auto& pixel, unsigned seed) {
        return spikes::render_to_error(pixel, seed, true);
    });
    EXPECT_LT(std::abs(bias), 0.003);
}

}  // namespace
