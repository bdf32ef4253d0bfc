#include "host/render/block_error.hpp"

#include <algorithm>
#include <cmath>

namespace diptych {
namespace {

constexpr int part_shift = 2;  // parts of a block: 4 x 4 pixels

float luminance(const std::array<float, 3>& color)
{
    return 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
}

// The 3 x 3 pixels about one, as far as they lie in the area.
template<class Visit>
void for_pixels_around(const Window& area, int x, int y, const Visit& visit)
{
    const int right = std::min(x + 1, area.x + area.width - 1);
    const int low = std::min(y + 1, area.y + area.height - 1);
    for (int v = std::max(y - 1, area.y); v <= low; ++v)
        for (int u = std::max(x - 1, area.x); u <= right; ++u) visit(u, v);
}

// Mean albedo of every pixel of the area, as luminance.
std::vector<float> albedo_luminances(const Film& film, const Window& area)
{
    std::vector<float> values;
    values.reserve(area.pixels());
    for (int y = 0; y < area.height; ++y)
        for (int x = 0; x < area.width; ++x)
            values.push_back(luminance(film.albedo(area.x + x, area.y + y)));
    return values;
}

// value(u, v): of the albedo's luminance at a pixel.
template<class Value>
float contrast_around(const Window& area, int x, int y, const Value& value)
{
    float sum = 0, square = 0;
    int count = 0;
    for_pixels_around(area, x, y, [&](int u, int v) {
        const float here = value(u, v);
        sum += here;
        square += here * here;
        ++count;
    });
    const float mean = sum / float(count);
    const float variance = std::max(square / float(count) - mean * mean, 0.0f);
    return mean > 0 ? std::sqrt(variance) / mean : 0;
}

// contrast(): of the texture at the pixel; asked where it counts.
template<class Contrast>
float error_at(const Film& film, int x, int y, const Viewer& viewer, const Contrast& contrast)
{
    if (!film.is_error_known(x, y)) return unknown_error;
    const std::array<float, 3> error = film.standard_error(x, y);
    if (error[0] == 0 && error[1] == 0 && error[2] == 0) return 0;
    return visible_error(film.radiance(x, y), error, contrast(), viewer);
}

// Errors of the pixels of an area of the film's window, by what lies in it: pixel_error with the
// albedos worked out once.
class PixelErrors {
public:
    PixelErrors(const Film& film, const Viewer& viewer, const Window& area)
        : film_(film), viewer_(viewer), area_(area), albedos_(albedo_luminances(film, area))
    {
    }

    float at(int x, int y) const
    {
        const auto albedo = [&](int u, int v) {
            return albedos_[size_t(v - area_.y) * size_t(area_.width) + size_t(u - area_.x)];
        };
        return error_at(film_, x, y, viewer_, [&] { return contrast_around(area_, x, y, albedo); });
    }

private:
    const Film& film_;
    const Viewer& viewer_;
    Window area_;
    std::vector<float> albedos_;
};

int quantised(double error)
{
    return int(std::min(std::ceil(error * error_unit), double(1 << 30)));
}

// The probability that a normal error of this standard deviation is smaller than `bound`.
double share_below(double bound, double deviation)
{
    return deviation > 0 ? std::erf(bound / (deviation * std::sqrt(2.0))) : 1;
}

}  // namespace

BlockError block_error(const Film& film, const Viewer& viewer, Pixel corner, int shift)
{
    const int parts = std::max(1, 1 << (shift - part_shift));
    const int part_side = (1 << shift) / parts;
    const int right = std::min(corner.x + (1 << shift), film.width());
    const int low = std::min(corner.y + (1 << shift), film.height());
    const PixelErrors errors(film, viewer, {corner.x, corner.y, right - corner.x, low - corner.y});
    double all = 0, worst = 0;
    int pixels = 0;
    for (int top = corner.y; top < low; top += part_side)
        for (int left = corner.x; left < right; left += part_side) {
            double sum = 0;
            int count = 0;
            for (int y = top; y < std::min(top + part_side, low); ++y)
                for (int x = left; x < std::min(left + part_side, right); ++x, ++count) {
                    const double error = double(confidence * errors.at(x, y));
                    sum += error * error;
                }
            all += sum;
            pixels += count;
            worst = std::max(worst, sum / count);
        }
    return {quantised(std::sqrt(all / pixels)), quantised(std::sqrt(worst))};
}

float texture_contrast(const Film& film, int x, int y)
{
    return contrast_around(film.data().window, x, y,
                           [&](int u, int v) { return luminance(film.albedo(u, v)); });
}

float pixel_error(const Film& film, int x, int y, const Viewer& viewer)
{
    return error_at(film, x, y, viewer, [&] { return texture_contrast(film, x, y); });
}

float pixel_bound(const Film& film, int x, int y, const Viewer& viewer)
{
    float sum = 0;
    int count = 0;
    for_pixels_around(film.data().window, x, y, [&](int u, int v) {
        const float error = pixel_error(film, u, v, viewer);
        sum += error * error;
        ++count;
    });
    return confidence * std::sqrt(sum / float(count));
}

std::vector<BlockError> block_errors(const Film& film, const BlockGrid& grid, const Viewer& viewer)
{
    std::vector<BlockError> errors;
    errors.reserve(grid.corners.size());
    for (const Pixel& corner : grid.corners)
        errors.push_back(block_error(film, viewer, corner, grid.shift));
    return errors;
}

double block_p95(std::vector<BlockError> errors)
{
    const auto p95 = errors.begin() + std::ptrdiff_t((errors.size() - 1) * 95 / 100);
    std::nth_element(errors.begin(), p95, errors.end(),
                     [](const BlockError& a, const BlockError& b) { return a.rms < b.rms; });
    return double(p95->rms) / error_unit;
}

void measure_team(Schedule& schedule, const Film& film, const BlockGrid& grid, const Viewer& viewer)
{
    for_team(schedule, schedule.turn, [&](size_t b) {
        if (!schedule.blocks[b].is_done)
            schedule.blocks[b].error = block_error(film, viewer, grid.corners[b], grid.shift);
    });
}

ErrorSummary summarise_error(const Film& film, const BlockGrid& grid, const Viewer& viewer,
                             double target)
{
    ErrorSummary summary;
    double square = 0, within = 0;
    for (const float bound : predicted_error(film, viewer)) {
        const double deviation = double(bound / confidence);
        square += deviation * deviation;
        within += share_below(target, deviation);
    }
    const double pixels = double(film.width()) * film.height();
    summary.rms = std::sqrt(square / pixels);
    summary.share_within = within / pixels;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            summary.share_unknown += film.is_error_known(x, y) ? 0 : 1 / pixels;
    summary.block_p95 = block_p95(block_errors(film, grid, viewer));
    return summary;
}

std::vector<float> predicted_error(const Film& film, const Viewer& viewer)
{
    const int width = film.width(), height = film.height();
    const Window whole{0, 0, width, height};
    const PixelErrors errors(film, viewer, whole);
    std::vector<float> squares(size_t(width) * size_t(height)), out(squares.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float error = errors.at(x, y);
            squares[size_t(y) * size_t(width) + size_t(x)] = error * error;
        }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float sum = 0;
            int count = 0;
            for_pixels_around(whole, x, y, [&](int u, int v) {
                sum += squares[size_t(v) * size_t(width) + size_t(u)];
                ++count;
            });
            out[size_t(y) * size_t(width) + size_t(x)] = confidence * std::sqrt(sum / float(count));
        }
    return out;
}

image::Picture picture_of(const Film& film, const Viewer& viewer)
{
    image::Picture picture = film.picture();
    if (film.has_standard_error() && film.data().window.pixels() > 1)
        picture.layers.push_back(image::predicted_error_layer(predicted_error(film, viewer)));
    return picture;
}

}  // namespace diptych
