// How visible an error is: in just noticeable differences (JND) of what a display shows.
#pragma once

#include "host/image/view_transform.hpp"

namespace diptych {

// How the picture is looked at.
struct Viewer {
    float exposure = 0;  // stops
    image::View view = image::View::Standard;
};

// CIE L*, 0 to 100, of what the display shows.
float lightness(const image::Rgb& radiance, const Viewer& viewer);

// JND between two radiances of a pixel: their difference in L* over what is just seen from pixel to
// pixel (2 at 67 pixels per degree, measured with FLIP). A textured surface hides more: by 1 + 10 *
// contrast, taken to hide at most twice as much. contrast: standard deviation of the albedo around
// the pixel over its mean.
float visible_difference(const image::Rgb& a, const image::Rgb& b, float contrast,
                         const Viewer& viewer);

// JND of an error of this size in a pixel's radiance, its channels moving together: half the
// difference between brighter and darker by it.
float visible_error(const image::Rgb& mean, const image::Rgb& error, float contrast,
                    const Viewer& viewer);

}  // namespace diptych
