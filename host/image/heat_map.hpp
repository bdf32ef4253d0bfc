// Numbers as colours.
#pragma once

#include "host/image/image.hpp"
#include "host/image/view_transform.hpp"

#include <span>

namespace diptych::image {

// sRGB-encoded colour of a value in 0..1 on the magma scale: black, purple, orange, pale yellow,
// evenly brighter.
Rgb magma(float value);

// A picture of one value a pixel, 0..1. Its colours are linear, so that PNG and EXR show the same.
Picture heat_map(std::span<const float> values, int width, int height);

}  // namespace diptych::image
