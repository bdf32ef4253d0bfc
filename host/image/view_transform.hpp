// From scene-linear radiance to display values: exposure, view, sRGB encoding.
#pragma once

#include "host/image/image.hpp"

#include <array>

namespace diptych::image {

using Rgb = std::array<float, 3>;

float srgb_encode(
    float linear);  // the piecewise curve of IEC 61966-2-1; negative values keep their sign
float srgb_decode(float encoded);

// Linear display light in 0..1 for linear scene light.
Rgb view_neutral(
    Rgb color);  // Khronos PBR Neutral: base colours up to 0.76 keep their hue and saturation
Rgb view_filmic(Rgb color);  // Stephen Hill's fit of the ACES RRT and sRGB ODT

// Linear display light of linear radiance, 2^exposure times as bright; above 1 a display clips.
Rgb display_light(Rgb radiance, float exposure, View view);

// standard, neutral or filmic; throws std::runtime_error for another name.
View view_of_name(const std::string& name);

// sRGB values in 0..1 of linear radiance, 2^exposure times as bright.
Rgb display_value(Rgb radiance, float exposure, View view);

}  // namespace diptych::image
