// Just noticeable differences against values worked out by hand from CIE 15.
#include "host/render/visible_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace diptych;

image::Rgb grey(float value) { return {value, value, value}; }

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
    EXPECT_NEAR(lightness(grey(0.25f), {1, image::View::Standard}), 76.0693, 1e-3);
    EXPECT_NEAR(lightness(grey(0.18f), {0, image::View::Neutral}), lightness(grey(0.14f), {}),
                1e-3);
    EXPECT_LT(lightness(grey(0.9f), {0, image::View::Filmic}), lightness(grey(0.9f), {}));
}

TEST(VisibleError, CountsInJustNoticeableDifferences)
{
    EXPECT_NEAR(visible_difference(grey(0.5f), grey(0.18f), 0, {}), 13.2866, 1e-3);
    EXPECT_NEAR(visible_difference(grey(0.18f), grey(0.5f), 0.05f, {}), 8.85772, 1e-3);
    EXPECT_NEAR(visible_difference(grey(0.18f), grey(0.5f), 5, {}), 6.64330, 1e-3);  // at most 2
    EXPECT_NEAR(visible_error(grey(0.18f), grey(0.01f), 0, {}), 0.60675, 6e-4);
    EXPECT_NEAR(visible_error(grey(0.001f), grey(0.002f), 0, {}), 0.677473, 1e-4);
    EXPECT_EQ(visible_error(grey(4), grey(1), 0, {}), 0);  // white either way
}

}  // namespace
