// The views at values that can be worked out by hand.
#include "host/image/view_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace diptych::image;

TEST(Srgb, HasItsKnownPointsAndIsItsOwnInverse)
{
    EXPECT_NEAR(srgb_encode(0.18f), 0.461356f, 1e-5);
    EXPECT_NEAR(srgb_decode(0.5f), 0.214041f, 1e-6);
    EXPECT_EQ(srgb_encode(0), 0);
    EXPECT_NEAR(srgb_encode(1), 1, 1e-6);
    for (int k = 0; k <= 255; ++k)
        EXPECT_EQ(std::lround(srgb_encode(srgb_decode(float(k) / 255)) * 255), k);
}

// Below 0.8 the view takes off exactly 0.04 (or 6.25 x^2 where the smallest component is under
// 0.08), hue kept.
TEST(Neutral, KeepsBaseColours)
{
    const Rgb grey = view_neutral({0.5f, 0.5f, 0.5f});
    EXPECT_NEAR(grey[0], 0.46f, 1e-6);
    const Rgb color = view_neutral({0.7f, 0.3f, 0.1f});
    EXPECT_NEAR(color[0], 0.66f, 1e-6);
    EXPECT_NEAR(color[1], 0.26f, 1e-6);
    EXPECT_NEAR(color[2], 0.06f, 1e-6);
    EXPECT_NEAR(view_neutral({0.04f, 0.04f, 0.04f})[0], 6.25f * 0.04f * 0.04f, 1e-7);
    EXPECT_EQ(view_neutral({0, 0, 0})[0], 0);
    EXPECT_EQ(view_neutral({-1, -1, -1})[0], 0);
}

// Peak p = 1.96 after the offset: 1 - 0.24^2 / (1.96 + 0.24 - 0.76) = 0.96.
TEST(Neutral, CompressesHighlights)
{
    EXPECT_NEAR(view_neutral({2, 2, 2})[0], 0.96f, 1e-6);
    const Rgb red = view_neutral({2, 0, 0});  // no offset: peak 2, new peak 1 - 0.0576 / 1.48
    const float peak = 1 - 0.0576f / 1.48f, white = 1 - 1 / (0.15f * (2 - peak) + 1);
    EXPECT_NEAR(red[0], peak, 1e-6);
    EXPECT_NEAR(red[1], peak * white, 1e-6);
    for (const float v : view_neutral({1e30f, 1e30f, 1e30f})) EXPECT_NEAR(v, 1, 1e-4);
}

TEST(Filmic, RisesFromBlackToWhiteAndKeepsGreyGrey)
{
    float before = -1;
    for (float x = 0; x < 100; x = x * 1.1f + 0.001f) {
        const Rgb grey = view_filmic({x, x, x});
        EXPECT_GE(grey[0], before);
        EXPECT_NEAR(grey[0], grey[1], 2e-4);
        EXPECT_NEAR(grey[0], grey[2], 2e-4);
        before = grey[0];
    }
    EXPECT_NEAR(view_filmic({0, 0, 0})[0], 0, 1e-6);
    EXPECT_GT(view_filmic({100, 100, 100})[0], 0.99f);
    // a = x (x + 0.0245786) - 0.000090537, b = x (0.983729 x + 0.432951) + 0.238081 at x = 0.18
    EXPECT_NEAR(view_filmic({0.18f, 0.18f, 0.18f})[1], 0.10560f, 3e-4);
}

TEST(DisplayValue, StaysBetweenZeroAndOneWhateverComes)
{
    for (const View view : {View::Standard, View::Neutral, View::Filmic}) {
        for (const float x : {NAN, INFINITY, -INFINITY, 1e38f, -1e38f, 0.0f, 1e-40f}) {
            for (const float v : display_value({x, 0.5f, 0}, 3, view)) {
                EXPECT_GE(v, 0) << x;
                EXPECT_LE(v, 1) << x;
            }
        }
        const Rgb one_stop = display_value({0.1f, 0.2f, 0.3f}, 1, view),
                  twice = display_value({0.2f, 0.4f, 0.6f}, 0, view);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(one_stop[c], twice[c], 1e-6);
    }
}
