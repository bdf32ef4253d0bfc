// Just noticeable differences against values worked out by hand from CIE 15.
#include "host/image/visible_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace diptych::image;

Rgb grey(float value) { return {value, value, value}; }

TEST(VisibleError, LightnessIsThatOfTheCie)
{
    EXPECT_NEAR(lightness(grey(1), {}), 100, 1e-3);
    EXPECT_NEAR(lightness(grey(0.18f), {}), 49.4961, 1e-3);
    EXPECT_NEAR(lightness(grey(0.5f), {}), 76.0693, 1e-3);
    EXPECT_NEAR(lightness(grey(0.003f), {}), 2.70989, 1e-4);  // on the straight piece
    EXPECT_NEAR(lightness({1, 0, 0}, {}), 53.2371, 1e-2);
    EXPECT_EQ(lightness(grey(0), {}), 0);
    EXPECT_NEAR(lightness(grey(50), {}), 100, 1e-3);  // the display clips
}

TEST(VisibleError, IsSeenThroughExposureAndView)
{
    EXPECT_NEAR(lightness(grey(0.25f), {1, View::Standard}), 76.0693, 1e-3);
    EXPECT_NEAR(lightness(grey(0.18f), {0, View::Neutral}), lightness(grey(0.14f), {}), 1e-3);
    EXPECT_LT(lightness(grey(0.9f), {0, View::Filmic}), lightness(grey(0.9f), {}));
}

TEST(VisibleError, CountsInJustNoticeableDifferences)
{
    EXPECT_NEAR(visible_difference(grey(0.5f), grey(0.18f), {}), 13.2866, 1e-3);
    EXPECT_NEAR(visible_difference(grey(0.18f), grey(0.5f), {}), 13.2866, 1e-3);
    EXPECT_NEAR(visible_error(grey(0.18f), grey(0.01f), {}), 0.60679, 1e-4);
    EXPECT_NEAR(visible_error(grey(0.001f), grey(0.002f), {}), 0.677472, 1e-4);
    EXPECT_EQ(visible_error(grey(4), grey(1), {}), 0);  // white either way
}

// By the Lab of CIE 15 and the weights that FLIP gives to white noise in each of its channels.
TEST(VisibleError, HueCountsBesideLightness)
{
    EXPECT_NEAR(visible_difference({0.4f, 0.2f, 0.2f}, grey(0.2f), {}), 7.05375, 2e-3);
    EXPECT_NEAR(visible_difference({0.2f, 0.2f, 0.4f}, grey(0.2f), {}), 4.38740, 2e-3);
    EXPECT_NEAR(visible_difference({0.2f, 0.4f, 0.2f}, grey(0.2f), {}), 14.6098, 2e-3);
    EXPECT_NEAR(visible_error(grey(0.18f), {0.01f, 0, 0}, {}), 0.400739, 3e-4);
}

}  // namespace
