// The metrics at values that can be worked out by hand.
#include "host/image/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

using namespace diptych::image;

static Colors colors(int width, int height, std::vector<float> values,
                     std::vector<float> error = {})
{
    return {width, height, Encoding::Linear, std::move(values), std::move(error)};
}

TEST(PixelDifferences, AreTheirFormulas)
{
    const Colors r = colors(2, 1, {1, 1, 1, 3, 3, 3}), t = colors(2, 1, {1, 1, 1, 3, 2, 3});
    const PixelDifferences d = pixel_differences(r, t);
    EXPECT_NEAR(d.rmse, std::sqrt(1.0 / 6), 1e-12);
    EXPECT_NEAR(d.relmse, 1.0 / 6 / (9 + 0.01 * 4), 1e-12);  // mean(r) = 2
    EXPECT_NEAR(d.mean, 1.0 / 6, 1e-12);
    EXPECT_EQ(d.max, 1);
    EXPECT_EQ(d.max_x, 1);
    EXPECT_EQ(d.max_y, 0);
}

TEST(PixelDifferences, OfEqualAndBlackPicturesAreZero)
{
    const Colors black = colors(2, 2, std::vector<float>(12, 0));
    const PixelDifferences d = pixel_differences(black, black);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.relmse, 0);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(yee_share(black, black), 0);
}

TEST(BiasOf, HasAnIntervalOnlyWithStandardErrors)
{
    const Colors r = colors(2, 1, {1, 1, 1, 1, 1, 1}), t = colors(2, 1, {1.5f, 1, 1, 1.5f, 1, 1});
    const Bias plain = bias_of(r, t);
    EXPECT_NEAR(plain.mean, 0.5 / 3, 1e-7);
    EXPECT_NEAR(plain.channels[0], 0.5, 1e-7);
    EXPECT_FALSE(plain.half_width);
    const Colors measured = colors(2, 1, t.values, std::vector<float>(6, 0.3f));
    // Two independent pixels of deviation 0.3: the mean has 0.3 / sqrt(2).
    EXPECT_NEAR(*bias_of(r, measured).half_width, 1.959964 * 0.3 / std::sqrt(2), 1e-6);
    EXPECT_NEAR(*bias_of(measured, measured).half_width, 1.959964 * 0.3, 1e-6);
}

// Noise whose deviation is known: the true difference, 0, lies within the interval about 95 times
// in 100.
TEST(BiasOf, CoversTheTruthNineteenTimesInTwenty)
{
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0, 0.2f);
    int covered = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Colors r = colors(10, 10, std::vector<float>(300, 1)), t = r;
        for (int i = 0; i < 100; ++i) {
            const float e = normal(random);
            for (int c = 0; c < 3; ++c) t.values[3 * i + c] += e;  // channels fully correlated
        }
        t.standard_error.assign(300, 0.2f);
        const Bias bias = bias_of(r, t);
        covered += std::abs(bias.mean) <= *bias.half_width;
    }
    EXPECT_GE(covered, 367);  // 380 expected, deviation 4.4
    EXPECT_LE(covered, 393);
}

TEST(ColorsOf, NamesTheFirstBadPixelAndTheLayersThereAre)
{
    Picture picture;
    picture.width = 3;
    picture.height = 2;
    std::vector<float> pixels(24, 1);
    pixels[4 * 5 + 1] = NAN;
    picture.layers = {beauty_layer(pixels), depth_layer(std::vector<float>(6, INFINITY))};
    try {
        colors_of(picture, "", "a.exr");
        FAIL() << "a NaN went through";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("a.exr: pixel 2,1 is not a number"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_THROW(colors_of(picture, "depth", "a.exr"), std::runtime_error);
    try {
        colors_of(picture, "albedo", "a.exr");
        FAIL() << "a layer that is not there";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("depth"), std::string::npos);
    }
}

TEST(Yee, TellsHuesApartAndNotATrifle)
{
    std::vector<float> grey(3 * 64 * 64, 0.5f), red = grey, trifle = grey;
    for (size_t i = 0; i < red.size(); i += 3) red[i] = 0.8f;
    for (float& v : trifle) v += 1e-4f;
    EXPECT_EQ(yee_share(colors(64, 64, grey), colors(64, 64, red)), 1);
    EXPECT_EQ(yee_share(colors(64, 64, grey), colors(64, 64, trifle)), 0);
    EXPECT_EQ(yee_share(colors(1, 1, {1, 1, 1}), colors(1, 1, {1, 1, 1})), 0);
}
