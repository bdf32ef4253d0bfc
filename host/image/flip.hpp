// ꟻLIP: the difference that a viewer notices when two pictures are flipped back and forth on the
// same spot. Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "ꟻLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020; HDR:
// Andersson, Nilsson, Shirley, Akenine-Möller: "Visualizing Errors in Rendered High Dynamic Range
// Images", Eurographics Short Papers 2021.
#pragma once

#include <span>
#include <vector>

namespace diptych::image {

// A 3840-pixel-wide, 0.7 m wide display seen from 0.7 m, as the authors use it: 67.02 pixels per
// degree.
constexpr double FLIP_PIXELS_PER_DEGREE = 67.02064327658226;

struct FlipResult {
    std::vector<float> map;  // per pixel, 0 (no difference) to 1
    double mean = 0;
    double median = 0;
    double p99 = 0;  // 99th percentile, between neighbours interpolated
    double max = 0;
    double start_exposure =
        0;  // HDR: the stops at which the pictures were compared, `exposures` of them, evenly
    double stop_exposure = 0;
    int exposures = 0;  // 0 for LDR
};

// Both pictures: three values a pixel, rows from the top, `width * height * 3` of them, finite. The
// same result for any number of threads. Throws std::runtime_error when pixels_per_degree is not
// between 1 and 1000.
FlipResult flip_ldr(std::span<const float> reference, std::span<const float> test, int width,
                    int height,
                    double pixels_per_degree);  // sRGB-encoded, 0..1

// Linear Rec.709. Exposures follow the paper: from where the ACES tone mapper makes the reference's
// brightest pixel 0.85 to where it makes its median so; each pixel keeps the largest difference
// over all of them. A reference whose median is 0 (mostly black) ends at 2^-23 of its brightest
// pixel; a black one is compared at the test's own exposures.
FlipResult flip_hdr(std::span<const float> reference, std::span<const float> test, int width,
                    int height, double pixels_per_degree);

}  // namespace diptych::image
