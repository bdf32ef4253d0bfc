#include "host/image/view_transform.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace diptych::image {

float srgb_encode(float linear)
{
    const float x = std::abs(linear);
    const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    return std::copysign(y, linear);
}

float srgb_decode(float encoded)
{
    const float x = std::abs(encoded);
    const float y = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    return std::copysign(y, encoded);
}

// Khronos Group, "PBR Neutral Tone Mapper" (2024): takes off the 4 % that a dielectric's Fresnel
// reflection adds, leaves what is then below 0.76 alone, compresses the rest and lets it fade to
// white.
Rgb view_neutral(Rgb color)
{
    const float start = 0.8f - 0.04f;
    const float desaturation = 0.15f;
    for (float& c : color) c = std::max(c, 0.0f);
    const float low = std::min({color[0], color[1], color[2]});
    const float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    for (float& c : color) c -= offset;
    const float peak = std::max({color[0], color[1], color[2]});
    if (peak < start) return color;

    const float d = 1 - start;
    const float new_peak = 1 - d * d / (peak + d - start);
    const float white = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    for (float& c : color) c = (c * (new_peak / peak)) * (1 - white) + new_peak * white;
    return color;
}

static Rgb transform(const float (&m)[3][3], Rgb v)
{
    Rgb out;
    for (int i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

// Stephen Hill's fit of the ACES reference rendering transform and sRGB output transform (first
// published with "Baking Lab", MJP and others, 2016). The matrices go from Rec.709 to the space the
// curve works in, and back.
Rgb view_filmic(Rgb color)
{
    static const float in[3][3] = {{0.59719f, 0.35458f, 0.04823f},
                                   {0.07600f, 0.90834f, 0.01566f},
                                   {0.02840f, 0.13383f, 0.83777f}};
    static const float out[3][3] = {{1.60475f, -0.53108f, -0.07367f},
                                    {-0.10208f, 1.10813f, -0.00605f},
                                    {-0.00327f, -0.07276f, 1.07602f}};
    for (float& c : color) c = std::clamp(c, 0.0f, 1e9f);  // the curve's quotient must not overflow
    color = transform(in, color);
    for (float& v : color) {
        const float a = v * (v + 0.0245786f) - 0.000090537f;
        const float b = v * (0.983729f * v + 0.4329510f) + 0.238081f;
        v = a / b;
    }
    color = transform(out, color);
    for (float& c : color) c = std::clamp(c, 0.0f, 1.0f);
    return color;
}

View view_of_name(const std::string& name)
{
    if (name == "standard") return View::Standard;
    if (name == "neutral") return View::Neutral;
    if (name == "filmic") return View::Filmic;
    throw std::runtime_error("--view " + name + ": no such view; use standard, neutral or filmic");
}

Rgb display_light(Rgb radiance, float exposure, View view)
{
    const float scale = std::exp2(exposure);
    for (float& c : radiance) c = std::isnan(c) ? 0.0f : std::clamp(c * scale, 0.0f, 1e9f);
    if (view == View::Neutral) radiance = view_neutral(radiance);
    if (view == View::Filmic) radiance = view_filmic(radiance);
    return radiance;
}

Rgb display_value(Rgb radiance, float exposure, View view)
{
    Rgb value = display_light(radiance, exposure, view);
    for (float& c : value) c = std::clamp(srgb_encode(c), 0.0f, 1.0f);
    return value;
}

}  // namespace diptych::image
