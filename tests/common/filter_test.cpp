// Offsets that pixel filters draw follow the filters' weights.
#include "platform.h"

#include "common/filter.h"
#include "tests/common/statistics.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

constexpr double pi = 3.14159265358979323846;

// The four-term Blackman-Harris window on [-1, 1], integrated from -1 to x and divided by its
// whole.
double window_below(double x)
{
    const double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;
    return 0.5 + (a0 * x + a1 * std::sin(pi * x) / pi + a2 * std::sin(2 * pi * x) / (2 * pi) +
                  a3 * std::sin(3 * pi * x) / (3 * pi)) /
                     (2 * a0);
}

TEST(Filter, BlackmanHarrisOffsetsFollowTheWindow)
{
    constexpr int bins = 40, draws = 100000;
    std::vector<double> expected(bins), counts(bins);
    for (int k = 0; k < bins; ++k)
        expected[size_t(k)] =
            draws * (window_below(2.0 * (k + 1) / bins - 1) - window_below(2.0 * k / bins - 1));
    std::mt19937 random(3);
    for (int k = 0; k < draws; ++k) {
        const float u = float(random() >> 8) * 0x1p-24f;
        const double x = blackman_harris_sample(u) / BLACKMAN_HARRIS_RADIUS;
        ++counts[size_t(std::min(bins - 1, int((x + 1) / 2 * bins)))];
    }
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

TEST(Filter, BlackmanHarrisInvertsItsDistribution)
{
    double worst = 0;
    for (int k = 1; k < 10000; ++k) {
        const double u = k / 10000.0;
        const double x = blackman_harris_sample(float(u)) / BLACKMAN_HARRIS_RADIUS;
        worst = std::max(worst, std::abs(window_below(x) - u));
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 1e-3);
}

TEST(Filter, BoxCoversThePixel)
{
    EXPECT_EQ(filter_sample(FILTER_BOX, make_float2(0, 0.25f)).x, -0.5f);
    EXPECT_EQ(filter_sample(FILTER_BOX, make_float2(0, 0.25f)).y, -0.25f);
    EXPECT_LT(filter_sample(FILTER_BOX, make_float2(0.9999999f, 0)).x, 0.5f);
}

}  // namespace
