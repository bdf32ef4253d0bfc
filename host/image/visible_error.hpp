// How visible an error is: in just noticeable differences (JND) of what a display shows.
#pragma once

#include "host/image/view_transform.hpp"

namespace diptych::image {

// How a picture is looked at.
struct Viewer {
    float exposure = 0;  // stops
    View view = View::Standard;

    bool operator==(const Viewer&) const = default;
};

// Side of the blocks that errors are summed up in: 16 pixels, and 8 below half a megapixel.
int error_block_side(int width, int height);

// CIE L*, 0 to 100, of what the display shows.
float lightness(const Rgb& radiance, const Viewer& viewer);

// JND between two radiances of a pixel: how far they lie apart in L* and in hue, as much of the
// latter as the eye sees from pixel to pixel (HyAB of ꟻLIP), over the 2 L* of white noise that are
// just seen at 67 pixels per degree.
float visible_difference(const Rgb& a, const Rgb& b, const Viewer& viewer);

// JND of an error of this size in a pixel's radiance, its channels moving together: half the
// difference between brighter and darker by it.
float visible_error(const Rgb& mean, const Rgb& error, const Viewer& viewer);

}  // namespace diptych::image
