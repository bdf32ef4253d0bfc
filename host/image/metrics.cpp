#include "host/image/metrics.hpp"

#include "host/image/view_transform.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace diptych::image {
namespace {

// Three values a pixel of the layer's first three channels, or of its only one.
std::vector<float> three_channels(const Layer& layer, size_t pixels)
{
    const size_t count = layer.channels.size();
    std::vector<float> values(3 * pixels);
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            const size_t from = i * count + (count < 3 ? 0 : c);
            values[3 * i + c] = layer.ids.empty() ? layer.pixels[from] : float(layer.ids[from]);
        }
    }
    return values;
}

void check_finite(const Colors& colors, const std::vector<float>& values, const std::string& where)
{
    for (size_t k = 0; k < values.size(); ++k) {
        if (std::isfinite(values[k])) continue;
        const size_t pixel = k / 3;
        throw std::runtime_error(
            fmt::format("{}: pixel {},{} is {}, which cannot be compared; render the picture anew",
                        where, pixel % colors.width, pixel / colors.width,
                        std::isnan(values[k]) ? "not a number" : "infinite"));
    }
}

std::string layer_names(const Picture& picture)
{
    std::string names;
    for (const Layer& layer : picture.layers)
        names += (names.empty() ? "" : ", ") +
                 (layer.name.empty() ? std::string("its colours") : layer.name);
    return names;
}

double half_width(double variance_of_sum, size_t pixels)
{
    return 1.959964 * std::sqrt(variance_of_sum) / double(pixels);
}

double share_of_blocks_above(double bar, const std::vector<double>& differences, int width,
                             int height)
{
    const int side = error_block_side(width, height);
    int blocks = 0, above = 0;
    for (int top = 0; top < height; top += side)
        for (int left = 0; left < width; left += side, ++blocks) {
            const int right = std::min(left + side, width), low = std::min(top + side, height);
            double square = 0;
            for (int y = top; y < low; ++y)
                for (int x = left; x < right; ++x) {
                    const double d = differences[size_t(y) * size_t(width) + size_t(x)];
                    square += d * d;
                }
            above += square > bar * bar * (right - left) * (low - top);
        }
    return double(above) / blocks;
}

std::vector<float> linear_values(const Colors& colors)
{
    std::vector<float> values = colors.values;
    if (colors.encoding == Encoding::Display)
        for (float& v : values) v = srgb_decode(v);
    return values;
}

}  // namespace

Colors colors_of(const Picture& picture, const std::string& name, const std::string& where)
{
    const Layer* layer = find_layer(picture, name);
    if (!layer)
        throw std::runtime_error(fmt::format("{}: no {}; it holds {}", where,
                                             name.empty() ? "colours" : "layer '" + name + "'",
                                             layer_names(picture)));
    Colors colors{picture.width, picture.height, picture.encoding, {}, {}};
    const size_t pixels = size_t(picture.width) * picture.height;
    colors.values = three_channels(*layer, pixels);
    check_finite(colors, colors.values, where);
    const auto find_pixels = [&](const char* of_beauty) {
        const Layer* found = name.empty() ? find_layer(picture, of_beauty) : nullptr;
        return found && found->ids.empty() ? found : nullptr;
    };
    if (const Layer* error = find_pixels("standard_error")) {
        colors.standard_error = three_channels(*error, pixels);
        check_finite(colors, colors.standard_error, where + " (standard error)");
    }
    if (const Layer* error = find_pixels("predicted_error"); error && error->channels.size() == 1)
        colors.predicted_error = error->pixels;
    return colors;
}

PixelDifferences pixel_differences(const Colors& reference, const Colors& test)
{
    const size_t count = reference.values.size();
    double mean_reference = 0;
    for (const float r : reference.values) mean_reference += r;
    mean_reference /= double(count);
    const double floor = 0.01 * mean_reference * mean_reference;

    PixelDifferences result;
    double squares = 0, relative = 0, absolute = 0;
    for (size_t k = 0; k < count; ++k) {
        const double r = reference.values[k], d = double(test.values[k]) - r;
        squares += d * d;
        absolute += std::abs(d);
        if (d != 0) relative += d * d / (r * r + floor);
        if (std::abs(d) > result.max) {
            result.max = std::abs(d);
            result.max_x = int(k / 3 % reference.width);
            result.max_y = int(k / 3 / reference.width);
        }
    }
    result.rmse = std::sqrt(squares / double(count));
    result.relmse = relative / double(count);
    result.mean = absolute / double(count);
    return result;
}

Bias bias_of(const Colors& reference, const Colors& test)
{
    const size_t pixels = reference.values.size() / 3;
    Bias bias;
    double variance = 0;
    std::array<double, 3> variances{};
    for (size_t i = 0; i < pixels; ++i) {
        for (const Colors* side : {&reference, &test}) {
            if (side->standard_error.empty()) continue;
            const float* error = &side->standard_error[3 * i];
            const double together = (double(error[0]) + error[1] + error[2]) / 3;
            variance += together * together;
            for (int c = 0; c < 3; ++c) variances[c] += double(error[c]) * error[c];
        }
        for (size_t c = 0; c < 3; ++c)
            bias.channels[c] += double(test.values[3 * i + c]) - reference.values[3 * i + c];
    }
    for (double& channel : bias.channels) channel /= double(pixels);
    bias.mean = (bias.channels[0] + bias.channels[1] + bias.channels[2]) / 3;
    if (reference.standard_error.empty() && test.standard_error.empty()) return bias;
    bias.half_width = half_width(variance, pixels);
    for (int c = 0; c < 3; ++c) bias.channel_half_widths[c] = half_width(variances[c], pixels);
    return bias;
}

VisibleDifferences visible_differences(const Colors& reference, const Colors& test,
                                       const Viewer& viewer)
{
    const std::vector<float> a = linear_values(reference), b = linear_values(test);
    std::vector<double> differences;
    differences.reserve(a.size() / 3);
    double square = 0, predicted = 0, broken = 0;
    for (size_t i = 0; i < a.size() / 3; ++i) {
        const Rgb one{a[3 * i], a[3 * i + 1], a[3 * i + 2]};
        const Rgb other{b[3 * i], b[3 * i + 1], b[3 * i + 2]};
        const double difference = double(visible_difference(one, other, viewer));
        square += difference * difference;
        if (!test.predicted_error.empty() && test.predicted_error[i] <= 1) {
            predicted += 1;
            broken += difference > 1 ? 1 : 0;
        }
        differences.push_back(difference);
    }
    VisibleDifferences result;
    result.rms = std::sqrt(square / double(differences.size()));
    result.blocks = share_of_blocks_above(1, differences, test.width, test.height);
    const auto p95 = differences.begin() + std::ptrdiff_t((differences.size() - 1) * 95 / 100);
    std::nth_element(differences.begin(), p95, differences.end());
    result.p95 = *p95;
    if (!test.predicted_error.empty()) result.broken = predicted > 0 ? broken / predicted : 0;
    return result;
}

double yee_share(const Colors& reference, const Colors& test)
{
    const OIIO::ImageSpec spec(reference.width, reference.height, 3, OIIO::TypeDesc::FLOAT);
    std::vector<float> a = linear_values(reference), b = linear_values(test);
    const OIIO::ImageBuf first(spec, a.data()), second(spec, b.data());
    OIIO::ImageBufAlgo::CompareResults details;
    const int differing = OIIO::ImageBufAlgo::compare_Yee(first, second, details);
    return double(differing) / (double(reference.width) * reference.height);
}

}  // namespace diptych::image
