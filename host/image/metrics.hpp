// How far a picture is from its reference, in numbers. ꟻLIP has a file of its own (flip.hpp).
#pragma once

#include "host/image/image.hpp"
#include "host/image/visible_error.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace diptych::image {

// One layer of a picture as three values a pixel (a single channel repeated), all of them finite,
// and what other layers say of the beauty, where the picture has them.
struct Colors {
    int width = 0;
    int height = 0;
    Encoding encoding = Encoding::Linear;
    std::vector<float> values;
    std::vector<float> standard_error;        // of each value; empty: not known
    std::vector<float> predicted_error = {};  // JND that each pixel's stays below; empty: not known
};

// Throws std::runtime_error, naming the pixel, for a NaN or an infinity; and for a layer that is
// not there (`name` empty: the beauty). `where` names the picture in errors.
Colors colors_of(const Picture& picture, const std::string& name, const std::string& where);

// All are of test against reference, over every pixel and channel, in the values as stored
// (radiance, or sRGB 0..1).
struct PixelDifferences {
    double rmse = 0;
    double relmse = 0;  // mean of (t - r)^2 / (r^2 + 0.01 mean(r)^2), mean(r) over all channels; 0
                        // where both are black
    double mean = 0;    // mean |t - r|
    double max = 0;     // largest |t - r|, first found at:
    int max_x = 0;
    int max_y = 0;
};
PixelDifferences pixel_differences(const Colors& reference, const Colors& test);

// The signed mean difference, t - r, and the half width of its 95 % confidence interval when at
// least one picture has a standard-error layer (a picture without one counts as exact). Pixels are
// taken as independent, the channels of a pixel as fully correlated, since one path carries all
// three: the interval is never too narrow on that account.
struct Bias {
    double mean = 0;
    std::optional<double> half_width;
    std::array<double, 3> channels{};
    std::array<double, 3> channel_half_widths{};
};
Bias bias_of(const Colors& reference, const Colors& test);

// Just noticeable differences from pixel to pixel of what a display shows.
struct VisibleDifferences {
    double rms = 0;
    double p95 = 0;                // 95 % of the pixels have less
    double blocks = 0;             // those of error_block_side with an RMS above 1, of all
    std::optional<double> broken;  // of the pixels that test predicts within 1: those that are not
};
VisibleDifferences visible_differences(const Colors& reference, const Colors& test,
                                       const Viewer& viewer);

// The share of pixels that OpenImageIO's perceptual comparison (Hector Yee's metric, 100 cd/m2, 45
// degrees) tells apart. Take it as a second opinion on colour only: in OpenImageIO 2.4 its
// luminance test reads a channel that is not there and never fails (black passes against white).
double yee_share(const Colors& reference, const Colors& test);

}  // namespace diptych::image
