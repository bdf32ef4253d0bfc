#include "host/image/heat_map.hpp"

#include <algorithm>

namespace diptych::image {

// Samples of the map by Nathaniel Smith and Stéfan van der Walt (CC0); between them linear, within
// 3/255 of theirs.
Rgb magma(float value)
{
    static constexpr unsigned char samples[18][3] = {
        {0, 0, 4},       {9, 7, 32},      {26, 16, 66},   {49, 17, 101},   {74, 16, 121},
        {98, 25, 128},   {121, 34, 130},  {145, 43, 129}, {170, 51, 125},  {194, 59, 117},
        {217, 70, 107},  {236, 88, 96},   {247, 114, 92}, {252, 142, 100}, {254, 170, 116},
        {254, 198, 138}, {253, 226, 163}, {252, 253, 191}};
    const float at = value > 0 ? std::min(value, 1.0f) * 17 : 0.0f;
    const int k = std::min(int(at), 16);
    const float t = at - float(k);
    Rgb color;
    for (int c = 0; c < 3; ++c)
        color[c] = (float(samples[k][c]) * (1 - t) + float(samples[k + 1][c]) * t) / 255;
    return color;
}

Picture heat_map(std::span<const float> values, int width, int height)
{
    Layer layer{"", {"R", "G", "B"}, {}, {}};
    layer.pixels.reserve(3 * values.size());
    for (const float value : values)
        for (const float c : magma(value)) layer.pixels.push_back(srgb_decode(c));
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.layers.push_back(std::move(layer));
    return picture;
}

}  // namespace diptych::image
