#include "host/image/visible_error.hpp"

#include <algorithm>
#include <cmath>

namespace diptych::image {
namespace {

constexpr long long small_picture = 500'000;  // pixels

// L*: with it --error 1 leaves a 99th percentile of FLIP below the 0.0575 that are seen, also where
// noise is all over a picture. Textures are not taken to hide any: FLIP sees it there too.
constexpr float seen_from_pixel_to_pixel = 2.0f;

// What FLIP's contrast sensitivity leaves of white noise at 67 pixels per degree, over what it
// leaves of that in lightness (Andersson et al. 2020, table 1).
constexpr float red_green_seen = 0.94f;
constexpr float yellow_blue_seen = 0.37f;

// f of CIE 15, whose L* is 116 f(Y) - 16.
float lab_curve(float t)
{
    const float linear_end = 216.0f / 24389;
    return t > linear_end ? std::cbrt(t) : t * (24389.0f / 27 / 116) + 16.0f / 116;
}

// What is seen of a colour from pixel to pixel, in units of L*: more of the hue where it is bright
// (Hunt's effect, as in FLIP).
struct Seen {
    float lightness;
    float red_green;
    float yellow_blue;
};

Seen seen(const Rgb& radiance, const Viewer& viewer)
{
    Rgb shown = display_light(radiance, viewer.exposure, viewer.view);
    for (float& c : shown) c = std::clamp(c, 0.0f, 1.0f);
    const auto [r, g, b] = shown;
    const float x = lab_curve(0.433891f * r + 0.376239f * g + 0.189870f * b);  // over D65's
    const float y = lab_curve(0.2126f * r + 0.7152f * g + 0.0722f * b);
    const float z = lab_curve(0.017725f * r + 0.109466f * g + 0.872809f * b);
    const float lightness = 116 * y - 16;
    const float hunt = 0.01f * lightness;
    return {lightness, red_green_seen * hunt * 500 * (x - y),
            yellow_blue_seen * hunt * 200 * (y - z)};
}

}  // namespace

int error_block_side(int width, int height)
{
    return (long long)width * height < small_picture ? 8 : 16;
}

float lightness(const Rgb& radiance, const Viewer& viewer)
{
    return seen(radiance, viewer).lightness;
}

float visible_difference(const Rgb& a, const Rgb& b, const Viewer& viewer)
{
    const Seen one = seen(a, viewer), other = seen(b, viewer);
    const float hue =
        std::hypot(one.red_green - other.red_green, one.yellow_blue - other.yellow_blue);
    return (std::abs(one.lightness - other.lightness) + hue) / seen_from_pixel_to_pixel;
}

float visible_error(const Rgb& mean, const Rgb& error, const Viewer& viewer)
{
    Rgb brighter{}, darker{};
    for (size_t c = 0; c < 3; ++c) {
        brighter[c] = mean[c] + error[c];
        darker[c] = std::max(mean[c] - error[c], 0.0f);
    }
    return 0.5f * visible_difference(brighter, darker, viewer);
}

}  // namespace diptych::image
