// The environment: its radiance map and the cells by which light sampling finds its bright parts.
#include "host/scene/environment.hpp"

#include "host/scene/scene_assembly.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

namespace diptych {
namespace {

using std::numbers::pi;

constexpr int most_node_columns = 4096;
constexpr int most_node_rows = 2048;
static_assert(most_node_columns <= MOST_ENVIRONMENT_CELLS &&
              most_node_rows + 1 <= MOST_ENVIRONMENT_CELLS);

// Where a node stands for several texels: the part of its brightness that follows the brightest one
// rather than the mean, so that it is never much rarer than it is bright.
constexpr double peak_share = 0.05;

// The texels whose linear filter reaches into interval `cell` of `cells`, and the part that each
// has in the interval's mean.
struct Footprint {
    int first;
    std::vector<double> shares;
};

// Integral of the filter's hat from -1 to t.
double hat_integral(double t)
{
    t = std::clamp(t, -1.0, 1.0);
    return t < 0 ? (1 + t) * (1 + t) / 2 : 1 - (1 - t) * (1 - t) / 2;
}

Footprint footprint(int cell, int cells, int texels)
{
    const double low = double(cell) * texels / cells, high = double(cell + 1) * texels / cells;
    Footprint f{int(std::floor(low - 0.5)), {}};
    const int last = int(std::ceil(high + 0.5)) - 1;
    for (int t = f.first; t <= last; ++t) {
        const double centre = t + 0.5;
        f.shares.push_back((hat_integral(high - centre) - hat_integral(low - centre)) /
                           (high - low));
    }
    return f;
}

std::vector<float> luminance_map(const Picture& map)
{
    std::vector<float> result(size_t(map.width) * size_t(map.height));
    for (size_t t = 0; t < result.size(); ++t) {
        const float* texel = &map.floats[4 * t];
        result[t] = float(luminance(texel[0], texel[1], texel[2]));
    }
    return result;
}

// Of the filtered luminance over an area; columns wrap, rows end at the poles.
double brightness(const std::vector<float>& map, int width, int height, const Footprint& across,
                  const Footprint& down)
{
    double mean = 0, peak = 0;
    for (size_t j = 0; j < down.shares.size(); ++j) {
        const int row = std::clamp(down.first + int(j), 0, height - 1);
        for (size_t i = 0; i < across.shares.size(); ++i) {
            const int column = ((across.first + int(i)) % width + width) % width;
            const double value = map[size_t(row) * size_t(width) + size_t(column)];
            mean += value * across.shares[i] * down.shares[j];
            peak = std::max(peak, value);
        }
    }
    return mean + peak_share * peak;
}

// Brightness at the middles of texels, or, in larger maps, of equal areas of as many texels.
struct Nodes {
    int columns;
    int rows;
    std::vector<float> values;

    double row_solid_angle(int row) const
    {
        return 2 * pi * (std::cos(pi * row / rows) - std::cos(pi * (row + 1) / rows));
    }

    double mean() const
    {
        double sum = 0;
        for (int row = 0; row < rows; ++row) {
            const auto first = values.begin() + std::ptrdiff_t(row) * columns;
            sum += row_solid_angle(row) * std::accumulate(first, first + columns, 0.0) / columns;
        }
        return sum / (4 * pi);
    }

    double at(int row, int column) const
    {
        const size_t y = size_t(std::clamp(row, 0, rows - 1)), x = size_t(column % columns);
        return double(values[y * size_t(columns) + x]);
    }
};

Nodes nodes_of(std::vector<float> map, int width, int height)
{
    Nodes nodes{std::min(width, most_node_columns), std::min(height, most_node_rows), {}};
    if (nodes.columns == width && nodes.rows == height) {
        nodes.values = std::move(map);
        return nodes;
    }
    std::vector<Footprint> across;
    for (int column = 0; column < nodes.columns; ++column) {
        across.push_back(footprint(column, nodes.columns, width));
    }
    for (int row = 0; row < nodes.rows; ++row) {
        const Footprint down = footprint(row, nodes.rows, height);
        for (const Footprint& of_column : across) {
            nodes.values.push_back(float(brightness(map, width, height, of_column, down)));
        }
    }
    return nodes;
}

// Leaves what is brighter than the mean: scattering finds the rest as well as light sampling would,
// which then serves the bright parts alone (Karlik et al. 2019, MIS Compensation). An even map,
// in which nothing would be left, stays as it is.
void compensate(Nodes& nodes, double mean)
{
    constexpr double least_left = 0.01;  // of the mean
    Nodes above = nodes;
    for (float& value : above.values) value = float(std::max(double(value) - mean, 0.0));
    if (above.mean() > least_left * mean) nodes = std::move(above);
}

// Appends the cumulated shares of the weights: count + 1 values from 0 to 1, never falling, in
// units of a sample value, 2^-24. A weight of zero gets an empty interval. If all are zero, the
// first one gets everything, so that kernels may search; returns the sum of the weights.
double append_cumulated(std::span<const double> weights, std::vector<float>& table)
{
    double total = 0;
    for (const double weight : weights) {
        total += weight;
    }
    double sum = 0;
    table.push_back(0);
    for (const double weight : weights) {
        sum += weight;
        table.push_back(total > 0 ? float(std::round(sum / total * 0x1p24) * 0x1p-24) : 1.0f);
    }
    return total;
}

// The rows' shares, then those of the columns in each row: environment_cells, see
// common/lights/environment.h.
void cumulate(std::span<const double> weights, int rows, int columns, std::vector<float>& table)
{
    std::vector<double> row_weights;
    std::vector<float> of_columns;
    of_columns.reserve(size_t(rows) * size_t(columns + 1));
    for (int row = 0; row < rows; ++row) {
        row_weights.push_back(append_cumulated(
            weights.subspan(size_t(row) * size_t(columns), size_t(columns)), of_columns));
    }
    table.clear();
    append_cumulated(row_weights, table);
    table.insert(table.end(), of_columns.begin(), of_columns.end());
}

// Linear floats, whatever the file held.
Picture linear_map(const Picture& map)
{
    Picture result = map;
    if (map.is_8_bit()) {
        result.floats.resize(map.bytes.size());
        for (size_t k = 0; k < map.bytes.size(); ++k) {
            result.floats[k] =
                k % 4 == 3 ? float(map.bytes[k]) / 255 : srgb_decode_byte(map.bytes[k]);
        }
        result.bytes.clear();
    } else if (map.is_integer) {
        for (size_t k = 0; k < map.floats.size(); ++k) {
            if (k % 4 != 3) {
                result.floats[k] = srgb_decode(map.floats[k]);
            }
        }
    }
    return result;
}

}  // namespace

double assemble_environment(const Picture& file, double rotation, float scale, SceneData& data)
{
    const Picture map = linear_map(file);
    Settings& s = data.settings[0];
    const double c = std::cos(rotation), n = std::sin(rotation);
    s.environment_x = {float(c), 0, float(-n), 0};
    s.environment_y = {0, 1, 0, 0};
    s.environment_z = {float(n), 0, float(c), 0};
    s.environment_scale = {scale, scale, scale, 0};
    s.environment_width = map.width;
    s.environment_height = map.height;
    const size_t texels = map.floats.size() / 4;
    if (data.texels_float.size() + texels > size_t(std::numeric_limits<int>::max())) {
        throw SceneError("environment: its texels and the textures' are more than 32-bit indices "
                         "reach; use a smaller map");
    }
    s.environment_texels = int(data.texels_float.size());
    for (size_t t = 0; t < map.floats.size(); t += 4) {
        data.texels_float.push_back(
            {map.floats[t], map.floats[t + 1], map.floats[t + 2], map.floats[t + 3]});
    }

    Nodes nodes = nodes_of(luminance_map(map), map.width, map.height);
    const double mean_brightness = nodes.mean();
    compensate(nodes, mean_brightness);
    const int columns = nodes.columns, rows = nodes.rows + 1;
    std::vector<double> weights;
    weights.reserve(size_t(columns) * size_t(rows));
    for (int row = 0; row < rows; ++row) {
        const double upper = std::max(row - 0.5, 0.0), lower = std::min(row + 0.5, rows - 1.0);
        const double solid_angle =
            2 * pi / columns *
            (std::cos(pi * upper / nodes.rows) - std::cos(pi * lower / nodes.rows));
        for (int column = 0; column < columns; ++column) {
            const double mean = 0.25 * (nodes.at(row - 1, column) + nodes.at(row - 1, column + 1) +
                                        nodes.at(row, column) + nodes.at(row, column + 1));
            weights.push_back(mean * solid_angle);
        }
    }
    s.cell_columns = columns;
    s.cell_rows = rows;
    cumulate(weights, rows, columns, data.environment_cells);
    const float most = *std::max_element(nodes.values.begin(), nodes.values.end());
    for (const float value : nodes.values) {
        data.environment_cells.push_back(most > 0 ? value / most : 0);
    }
    if (file.bad_texels > 0) {
        data.notices.push_back("environment: " + std::to_string(file.bad_texels) +
                               " values were NaN, infinite or negative; they were replaced");
    }
    return 4 * pi * mean_brightness * scale;
}

Picture neutral_sky()
{
    constexpr int width = 32, height = 64;
    Picture sky{width, height, {}, {}, false, 0};
    const auto mix = [](double a, double b, double t) { return float(a + (b - a) * t); };
    for (int row = 0; row < height; ++row) {
        const double up = std::cos(pi * (row + 0.5) / height);
        const double t = up > 0 ? std::sqrt(up) : std::min(1.0, -8 * up);
        for (int column = 0; column < width; ++column) {
            if (up > 0) {
                sky.floats.insert(sky.floats.end(),
                                  {mix(1.0, 0.62, t), mix(1.0, 0.72, t), mix(1.0, 0.88, t), 1});
            } else {
                sky.floats.insert(sky.floats.end(),
                                  {mix(1.0, 0.30, t), mix(1.0, 0.29, t), mix(1.0, 0.28, t), 1});
            }
        }
    }
    return sky;
}

}  // namespace diptych
