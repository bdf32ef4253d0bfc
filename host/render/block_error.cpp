#include "host/render/block_error.hpp"

#include <algorithm>
#include <cmath>

namespace diptych {
namespace {

// The 3 x 3 pixels about one, as far as they lie in the area.
template<class Visit>
void for_pixels_around(const Window& area, int x, int y, const Visit& visit)
{
    const int right = std::min(x + 1, area.x + area.width - 1);
    const int low = std::min(y + 1, area.y + area.height - 1);
    for (int v = std::max(y - 1, area.y); v <= low; ++v)
        for (int u = std::max(x - 1, area.x); u <= right; ++u) visit(u, v);
}

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

BlockError block_error(const Film& film, const image::Viewer& viewer, Pixel corner, int shift)
{
    const int right = std::min(corner.x + (1 << shift), film.width());
    const int low = std::min(corner.y + (1 << shift), film.height());
    double square = 0, worst = 0;
    for (int y = corner.y; y < low; ++y)
        for (int x = corner.x; x < right; ++x) {
            const double error = double(confidence * pixel_error(film, x, y, viewer));
            square += error * error;
            worst = std::max(worst, error);
        }
    const double pixels = double(right - corner.x) * (low - corner.y);
    return {quantised(std::sqrt(square / pixels)), quantised(worst)};
}

float pixel_error(const Film& film, int x, int y, const image::Viewer& viewer)
{
    if (!film.is_error_known(x, y)) return unknown_error;
    const std::array<float, 3> error = film.standard_error(x, y);
    if (error[0] == 0 && error[1] == 0 && error[2] == 0) return 0;
    return image::visible_error(film.radiance(x, y), error, viewer);
}

float pixel_bound(const Film& film, int x, int y, const image::Viewer& viewer)
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

std::vector<BlockError> block_errors(const Film& film, const BlockGrid& grid,
                                     const image::Viewer& viewer)
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
    std::nth_element(
        errors.begin(), p95, errors.end(),
        [](const BlockError& a, const BlockError& b) { return error_of(a) < error_of(b); });
    return double(error_of(*p95)) / error_unit;
}

void measure_team(Schedule& schedule, const Film& film, const BlockGrid& grid,
                  const image::Viewer& viewer)
{
    for_team(schedule, schedule.turn, [&](size_t b) {
        if (!schedule.blocks[b].is_done)
            schedule.blocks[b].error = block_error(film, viewer, grid.corners[b], grid.shift);
    });
}

ErrorSummary summarise_error(const Film& film, const BlockGrid& grid, const image::Viewer& viewer,
                             double target)
{
    ErrorSummary summary;
    summary.blocks = int(grid.corners.size());
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

std::vector<float> predicted_error(const Film& film, const image::Viewer& viewer)
{
    const int width = film.width(), height = film.height();
    const Window whole{0, 0, width, height};
    std::vector<float> squares(size_t(width) * size_t(height)), out(squares.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float error = pixel_error(film, x, y, viewer);
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

image::Picture picture_of(const Film& film, const image::Viewer& viewer)
{
    image::Picture picture = film.picture();
    if (film.has_standard_error() && film.data().window.pixels() > 1)
        picture.layers.push_back(image::predicted_error_layer(predicted_error(film, viewer)));
    return picture;
}

}  // namespace diptych
