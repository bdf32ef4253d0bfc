#include "host/image/flip.hpp"

#include "host/image/view_transform.hpp"

#include <OpenImageIO/parallel.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace diptych::image {
namespace {

constexpr double PI = std::numbers::pi;
using Plane = std::vector<float>;

// sRGB primaries to XYZ and back, and the white that (1, 1, 1) is.
constexpr float TO_XYZ[3][3] = {{0.41238656f, 0.35759149f, 0.18045049f},
                                {0.21263682f, 0.71518298f, 0.07218020f},
                                {0.01933062f, 0.11919716f, 0.95037259f}};
constexpr float FROM_XYZ[3][3] = {{3.24100323f, -1.53739897f, -0.49861588f},
                                  {-0.96922425f, 1.87592998f, 0.04155423f},
                                  {0.05563942f, -0.20401121f, 1.05714898f}};
constexpr float WHITE[3] = {0.95042855f, 1.0f, 1.08890037f};

float dot3(const float (&row)[3], const Rgb& v)
{
    return row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
}

// Relative to white, so that neutral colours have three equal values.
Rgb relative_xyz(const Rgb& rgb)
{
    return {dot3(TO_XYZ[0], rgb) / WHITE[0], dot3(TO_XYZ[1], rgb) / WHITE[1],
            dot3(TO_XYZ[2], rgb) / WHITE[2]};
}

// The linearised CIELAB that contrast sensitivity is measured in (2020 paper, section 4.1.1).
Rgb to_opponent(const Rgb& rgb)
{
    const Rgb xyz = relative_xyz(rgb);
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Rgb from_opponent(const Rgb& c)
{
    const float y = (c[0] + 16) / 116;
    const Rgb xyz = {(y + c[1] / 500) * WHITE[0], y * WHITE[1], (y - c[2] / 200) * WHITE[2]};
    return {dot3(FROM_XYZ[0], xyz), dot3(FROM_XYZ[1], xyz), dot3(FROM_XYZ[2], xyz)};
}

float lab_curve(float t)
{
    constexpr float delta = 6.0f / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
}

// CIELAB with the Hunt effect: colours matter more the brighter they are.
Rgb to_hunt_lab(const Rgb& rgb)
{
    const Rgb xyz = relative_xyz(rgb);
    const float fx = lab_curve(xyz[0]), fy = lab_curve(xyz[1]), fz = lab_curve(xyz[2]);
    const float l = 116 * fy - 16;
    return {l, 0.01f * l * 500 * (fx - fy), 0.01f * l * 200 * (fy - fz)};
}

float hyab(const Rgb& a, const Rgb& b)
{
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// One-dimensional filters; every two-dimensional one of the papers is a product of two, or a sum of
// two products.
struct Filter {
    int radius = 0;
    std::vector<float> taps;
};

// Positive taps sum to 1, negative ones to -1.
Filter sampled(int radius, double (*value)(double x, double scale), double scale)
{
    double positive = 0, negative = 0;
    for (int x = -radius; x <= radius; ++x) {
        const double v = value(x, scale);
        (v > 0 ? positive : negative) += std::abs(v);
    }
    Filter filter{radius, {}};
    for (int x = -radius; x <= radius; ++x) {
        const double v = value(x, scale);
        filter.taps.push_back(float(v > 0 ? v / positive : v < 0 ? v / negative : 0));
    }
    return filter;
}

double gaussian(double x, double sigma) { return std::exp(-x * x / (2 * sigma * sigma)); }

// What the eye does to the picture, for one viewing distance.
struct Observer {
    Filter luminance, red_green, blue_yellow_wide,
        blue_yellow_narrow;      // contrast sensitivity (2020, table 1)
    float wide_share = 0;        // of the first blue-yellow term
    Filter smooth, edge, point;  // feature detection (2020, section 4.2)
    int halo = 0;
    float largest_color = 0;  // HyAB of green and blue, to the power below

    explicit Observer(double pixels_per_degree)
    {
        // A term a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees, is a Gaussian of this deviation
        // in pixels.
        const auto deviation = [=](double b) { return std::sqrt(b / 2) / PI * pixels_per_degree; };
        const int radius = int(std::ceil(3 * deviation(0.04)));
        luminance = sampled(radius, gaussian, deviation(0.0047));
        red_green = sampled(radius, gaussian, deviation(0.0053));
        blue_yellow_wide = sampled(radius, gaussian, deviation(0.04));
        blue_yellow_narrow = sampled(radius, gaussian, deviation(0.025));
        const double wide = volume(34.1, 0.04, radius, deviation(0.04));
        const double narrow = volume(13.5, 0.025, radius, deviation(0.025));
        wide_share = float(wide / (wide + narrow));

        const double sigma = 0.5 * 0.082 * pixels_per_degree;
        const int reach = int(std::ceil(3 * sigma));
        smooth = sampled(reach, gaussian, sigma);
        edge = sampled(
            reach, [](double x, double s) { return -x * gaussian(x, s); }, sigma);
        point = sampled(
            reach, [](double x, double s) { return (x * x / (s * s) - 1) * gaussian(x, s); },
            sigma);
        halo = std::max(radius, reach);
        largest_color = std::pow(hyab(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), 0.7f);
    }

    // Sum of a two-dimensional term over its taps.
    static double volume(double a, double b, int radius, double sigma)
    {
        double line = 0;
        for (int x = -radius; x <= radius; ++x) line += gaussian(x, sigma);
        return a * std::sqrt(PI / b) * line * line;
    }
};

// A band of rows with its neighbours above and below; rows and columns beyond the picture repeat
// its border.
class Band {
public:
    Band(int width, int first, int rows, int halo, int height)
        : width_(width), first_(first), rows_(rows), halo_(halo), height_(height)
    {
    }

    int rows() const { return rows_; }
    int stored_rows() const { return rows_ + 2 * halo_; }
    int picture_row(int stored) const
    {
        return std::clamp(first_ + stored - halo_, 0, height_ - 1);
    }

    // Filters every stored row along x, then the band's own rows along y.
    Plane filtered(const Plane& stored, const Filter& along_x, const Filter& along_y) const
    {
        return down(across(stored, along_x), along_y);
    }

    Plane across(const Plane& stored, const Filter& filter) const
    {
        Plane out(stored.size(), 0.0f);
        std::vector<float> padded(size_t(width_) + 2 * filter.radius);
        for (int y = 0; y < stored_rows(); ++y) {
            const float* row = stored.data() + size_t(y) * width_;
            std::fill_n(padded.begin(), filter.radius, row[0]);
            std::copy_n(row, width_, padded.begin() + filter.radius);
            std::fill_n(padded.end() - filter.radius, filter.radius, row[width_ - 1]);
            float* to = out.data() + size_t(y) * width_;
            for (int k = 0; k <= 2 * filter.radius; ++k)
                add_scaled(to, padded.data() + k, filter.taps[k]);
        }
        return out;
    }

    Plane down(const Plane& stored, const Filter& filter) const
    {
        Plane out(size_t(rows_) * width_, 0.0f);
        for (int y = 0; y < rows_; ++y) {
            float* to = out.data() + size_t(y) * width_;
            for (int k = -filter.radius; k <= filter.radius; ++k)
                add_scaled(to, stored.data() + size_t(y + halo_ + k) * width_,
                           filter.taps[k + filter.radius]);
        }
        return out;
    }

private:
    void add_scaled(float* to, const float* from, float scale) const
    {
        for (int x = 0; x < width_; ++x) to[x] += scale * from[x];
    }

    int width_, first_, rows_, halo_, height_;
};

// One of the two pictures, as linear display colours in 0..1.
struct Source {
    std::span<const float> values;
    bool hdr = false;
    float scale = 1;  // 2^exposure

    Rgb linear(size_t pixel) const
    {
        Rgb color = {values[3 * pixel], values[3 * pixel + 1], values[3 * pixel + 2]};
        for (float& c : color)
            c = hdr ? tone_mapped(std::max(c, 0.0f) * scale)
                    : srgb_decode(std::clamp(c, 0.0f, 1.0f));
        return color;
    }

    // Krzysztof Narkowicz' curve for ACES (2015) on 0.6 times the input: the 2021 paper's default.
    static float tone_mapped(float c)
    {
        const float x = 0.6f * std::min(c, 1e9f);
        return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
    }
};

// What is compared, pixel by pixel, for one band of one picture.
struct Seen {
    std::vector<Rgb> color;
    Plane edge, point;
};

Seen look(const Source& source, const Band& band, const Observer& eye, int width)
{
    Plane opponent[3];
    for (Plane& plane : opponent) plane.resize(size_t(band.stored_rows()) * width);
    for (int y = 0; y < band.stored_rows(); ++y) {
        for (int x = 0; x < width; ++x) {
            const Rgb c = to_opponent(source.linear(size_t(band.picture_row(y)) * width + x));
            for (int k = 0; k < 3; ++k) opponent[k][size_t(y) * width + x] = c[k];
        }
    }
    const Plane y = band.filtered(opponent[0], eye.luminance, eye.luminance);
    const Plane cx = band.filtered(opponent[1], eye.red_green, eye.red_green);
    const Plane cz_wide = band.filtered(opponent[2], eye.blue_yellow_wide, eye.blue_yellow_wide);
    const Plane cz_narrow =
        band.filtered(opponent[2], eye.blue_yellow_narrow, eye.blue_yellow_narrow);

    for (float& v : opponent[0]) v = (v + 16) / 116;
    const Plane smoothed = band.across(opponent[0], eye.smooth);
    const Plane edge_x = band.filtered(opponent[0], eye.edge, eye.smooth),
                edge_y = band.down(smoothed, eye.edge);
    const Plane point_x = band.filtered(opponent[0], eye.point, eye.smooth),
                point_y = band.down(smoothed, eye.point);

    Seen seen{std::vector<Rgb>(y.size()), Plane(y.size()), Plane(y.size())};
    for (size_t i = 0; i < y.size(); ++i) {
        const float cz = eye.wide_share * cz_wide[i] + (1 - eye.wide_share) * cz_narrow[i];
        Rgb rgb = from_opponent({y[i], cx[i], cz});
        for (float& c : rgb) c = std::clamp(c, 0.0f, 1.0f);
        seen.color[i] = to_hunt_lab(rgb);
        seen.edge[i] = std::sqrt(edge_x[i] * edge_x[i] + edge_y[i] * edge_y[i]);
        seen.point[i] = std::sqrt(point_x[i] * point_x[i] + point_y[i] * point_y[i]);
    }
    return seen;
}

// The colour difference, compressed so that what exceeds 40 % of the largest possible takes the
// last 5 % of the range.
float color_difference(const Rgb& a, const Rgb& b, float largest)
{
    const float knee = 0.4f * largest, at_knee = 0.95f;
    const float d = std::pow(hyab(a, b), 0.7f);
    return d < knee ? at_knee / knee * d : at_knee + (d - knee) / (largest - knee) * (1 - at_knee);
}

float difference(const Seen& a, const Seen& b, size_t i, const Observer& eye)
{
    const float color = std::min(color_difference(a.color[i], b.color[i], eye.largest_color), 1.0f);
    const float edge = std::abs(a.edge[i] - b.edge[i]), point = std::abs(a.point[i] - b.point[i]);
    const float feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2_v<float>);
    return std::pow(color, 1 - std::min(feature, 1.0f));
}

// Raises the map to the difference of the two sources, in independent bands of rows.
void raise_map(std::vector<float>& map, const Source& reference, const Source& test, int width,
               int height, const Observer& eye)
{
    const int band_rows = std::max(64, 4 * eye.halo);
    const int bands = (height + band_rows - 1) / band_rows;
    OIIO::parallel_for_chunked(0, bands, 1, [&](int64_t begin, int64_t end) {
        for (int64_t b = begin; b < end; ++b) {
            const int first = int(b) * band_rows;
            const Band band(width, first, std::min(band_rows, height - first), eye.halo, height);
            const Seen seen_reference = look(reference, band, eye, width);
            const Seen seen_test = look(test, band, eye, width);
            float* out = map.data() + size_t(first) * width;
            for (size_t i = 0; i < size_t(band.rows()) * width; ++i)
                out[i] = std::max(out[i], difference(seen_reference, seen_test, i, eye));
        }
    });
}

double quantile(const std::vector<float>& sorted, double q)
{
    const double at = q * double(sorted.size() - 1);
    const size_t below = size_t(at), above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - double(below)) * (double(sorted[above]) - sorted[below]);
}

void summarise(FlipResult& result)
{
    std::vector<float> sorted = result.map;
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (const float v : sorted) sum += v;
    result.mean = sum / double(sorted.size());
    result.median = quantile(sorted, 0.5);
    result.p99 = quantile(sorted, 0.99);
    result.max = sorted.back();
}

struct Luminances {
    double brightest = 0;
    double median = 0;
};

Luminances luminances_of(std::span<const float> values)
{
    std::vector<float> y(values.size() / 3);
    for (size_t i = 0; i < y.size(); ++i)
        y[i] =
            std::max(0.0f, dot3(TO_XYZ[1], {values[3 * i], values[3 * i + 1], values[3 * i + 2]}));
    std::sort(y.begin(), y.end());
    return {y.back(), quantile(y, 0.5)};
}

// The luminance that the tone mapper takes to 0.85: the positive root of a quadratic (2021 paper,
// section 3.1).
double luminance_at_target()
{
    const double target = 0.85;
    const double a = 0.36 * (2.51 - target * 2.43), b = 0.6 * (0.03 - target * 0.59),
                 c = -target * 0.14;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

void choose_exposures(FlipResult& result, std::span<const float> reference,
                      std::span<const float> test)
{
    Luminances y = luminances_of(reference);
    if (y.brightest <= 0) y = luminances_of(test);
    if (y.brightest <= 0) y = {1, 1};
    y.median = std::max(y.median, y.brightest * 0x1p-23);
    result.start_exposure = std::log2(luminance_at_target() / y.brightest);
    result.stop_exposure = std::log2(luminance_at_target() / y.median);
    result.exposures = std::max(2, int(std::ceil(result.stop_exposure - result.start_exposure)));
}

FlipResult empty_result(int width, int height, double pixels_per_degree)
{
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000))
        throw std::runtime_error(
            fmt::format("--ppd {}: pixels per degree lie between 1 and 1000; 67.02 is usual",
                        pixels_per_degree));
    FlipResult result;
    result.map.assign(size_t(width) * height, 0.0f);
    return result;
}

}  // namespace

FlipResult flip_ldr(std::span<const float> reference, std::span<const float> test, int width,
                    int height, double pixels_per_degree)
{
    FlipResult result = empty_result(width, height, pixels_per_degree);
    raise_map(result.map, {reference}, {test}, width, height, Observer(pixels_per_degree));
    summarise(result);
    return result;
}

FlipResult flip_hdr(std::span<const float> reference, std::span<const float> test, int width,
                    int height, double pixels_per_degree)
{
    FlipResult result = empty_result(width, height, pixels_per_degree);
    choose_exposures(result, reference, test);
    const Observer eye(pixels_per_degree);
    for (int k = 0; k < result.exposures; ++k) {
        const double step = (result.stop_exposure - result.start_exposure) / (result.exposures - 1);
        const float scale = float(std::exp2(result.start_exposure + k * step));
        raise_map(result.map, {reference, true, scale}, {test, true, scale}, width, height, eye);
    }
    summarise(result);
    return result;
}

}  // namespace diptych::image
