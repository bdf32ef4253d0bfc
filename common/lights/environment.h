// Light from everywhere: a latitude-longitude image, row 0 at +Y, u = 0.5 + atan2(z, x) / 2 pi, v =
// acos(y) / pi in the environment's own frame. Sampled in proportion to how much brighter the
// filtered map is than its mean, as scattering finds the rest, by inversion: neighbouring sample
// values give neighbouring directions, so that the spread of the samples over the unit square
// survives.
#pragma once

#include "common/buffers.h"
#include "common/lights/light_sample.h"
#include "common/math.h"

SHARED float3 direction_to_environment(const Scene* scene, float3 d)
{
    const float3 x = xyz(scene->settings[0].environment_x);
    const float3 y = xyz(scene->settings[0].environment_y);
    const float3 z = xyz(scene->settings[0].environment_z);
    return make_float3(vec_dot(x, d), vec_dot(y, d), vec_dot(z, d));
}

SHARED float3 direction_from_environment(const Scene* scene, float3 d)
{
    const float3 x = xyz(scene->settings[0].environment_x);
    const float3 y = xyz(scene->settings[0].environment_y);
    const float3 z = xyz(scene->settings[0].environment_z);
    return x * d.x + y * d.y + z * d.z;
}

SHARED float2 environment_uv(float3 d)
{
    const float u = 0.5f + math_atan2(d.z, d.x) * (0.5f * INV_PI);
    const float v = math_acos(math_clamp(d.y, -1.0f, 1.0f)) * INV_PI;
    return make_float2(u, v);
}

// Bilinear, around the seam; the poles are rows of their own.
SHARED float3 environment_texel(const Scene* scene, float2 uv)
{
    const int width = scene->settings[0].environment_width;
    const int height = scene->settings[0].environment_height;
    const int first = scene->settings[0].environment_texels;
    const float x = uv.x * (float)width - 0.5f;
    const float y = uv.y * (float)height - 0.5f;
    const float floor_x = math_floor(x);
    const float floor_y = math_floor(y);
    const float fx = x - floor_x;
    const float fy = y - floor_y;
    const int left = (int)floor_x;
    const int top = (int)floor_y;
    const int x0 = left < 0 ? left + width : (left >= width ? left - width : left);
    const int x1 = left + 1 >= width ? left + 1 - width : left + 1;
    const int y0 = top < 0 ? 0 : (top >= height ? height - 1 : top);
    const int y1 = top + 1 >= height ? height - 1 : top + 1;
    const int k00 = first + y0 * width + x0;
    const int k10 = first + y0 * width + x1;
    const int k01 = first + y1 * width + x0;
    const int k11 = first + y1 * width + x1;
    const float w00 = (1.0f - fx) * (1.0f - fy);
    const float w10 = fx * (1.0f - fy);
    const float w01 = (1.0f - fx) * fy;
    const float w11 = fx * fy;
    return make_float3(
        ROW_AT(scene, texels_float, k00).x * w00 + ROW_AT(scene, texels_float, k10).x * w10 +
            ROW_AT(scene, texels_float, k01).x * w01 + ROW_AT(scene, texels_float, k11).x * w11,
        ROW_AT(scene, texels_float, k00).y * w00 + ROW_AT(scene, texels_float, k10).y * w10 +
            ROW_AT(scene, texels_float, k01).y * w01 + ROW_AT(scene, texels_float, k11).y * w11,
        ROW_AT(scene, texels_float, k00).z * w00 + ROW_AT(scene, texels_float, k10).z * w10 +
            ROW_AT(scene, texels_float, k01).z * w01 + ROW_AT(scene, texels_float, k11).z * w11);
}

SHARED float3 environment_radiance(const Scene* scene, float2 uv)
{
    return environment_texel(scene, uv) * xyz(scene->settings[0].environment_scale);
}

// environment_cells: the cumulated shares of the rows (cell_rows + 1 values from 0 to 1), then
// those of the columns within each row (cell_columns + 1 values each), then the brightness above
// the mean at the nodes, cell_columns in each of cell_rows - 1 rows. Shares are multiples of 2^-24,
// as sample values are: differences are exact, and are the very probabilities with which sample
// values fall between two of them.
//
// A node is the middle of a texel (in maps of more than MOST_ENVIRONMENT_CELLS, of a few). A cell
// reaches from four of them to each other: column k from node k to node k + 1, around the seam, and
// row k from node k - 1 to node k; the first and the last row end at the poles, after half the way.
// Within a cell the density follows the brightness at its corners, as the filtered map does.
SHARED int environment_row_start(const Scene* scene, int row)
{
    return scene->settings[0].cell_rows + 1 + row * (scene->settings[0].cell_columns + 1);
}

SHARED float environment_share(const Scene* scene, int start, int cell)
{
    return scene->environment_cells[start + cell + 1] - scene->environment_cells[start + cell];
}

// One halving: whether u lies `step` cells or more behind the start of the cell `found`.
SHARED int environment_advance(const Scene* scene, int start, int count, float u, int found,
                               int step)
{
    const int ahead = found + step > count ? count : found + step;  // there the sum is 1, beyond u
    return scene->environment_cells[start + ahead] <= u ? ahead : found;
}

// The cell of `count` <= MOST_ENVIRONMENT_CELLS whose interval holds u in [0, 1); never an empty
// one. Written out, because vector code wants a fixed number of steps.
SHARED int environment_find(const Scene* scene, int start, int count, float u)
{
    int found = 0;
    found = environment_advance(scene, start, count, u, found, 2048);
    found = environment_advance(scene, start, count, u, found, 1024);
    found = environment_advance(scene, start, count, u, found, 512);
    found = environment_advance(scene, start, count, u, found, 256);
    found = environment_advance(scene, start, count, u, found, 128);
    found = environment_advance(scene, start, count, u, found, 64);
    found = environment_advance(scene, start, count, u, found, 32);
    found = environment_advance(scene, start, count, u, found, 16);
    found = environment_advance(scene, start, count, u, found, 8);
    found = environment_advance(scene, start, count, u, found, 4);
    found = environment_advance(scene, start, count, u, found, 2);
    return environment_advance(scene, start, count, u, found, 1);
}

// Where u lies in the cell's interval, in (0, 1]: in the middle of the 2^-24 that it stands for.
SHARED float environment_within(const Scene* scene, int start, int cell, float u)
{
    const float half_unit = 2.98023223876953125e-8f;
    const float share = environment_share(scene, start, cell);
    const float rest = u - scene->environment_cells[start + cell] + half_unit;
    return share > 0.0f ? rest / share : 0.5f;
}

SHARED float environment_node(const Scene* scene, int row, int column)
{
    const int columns = scene->settings[0].cell_columns;
    const int last = scene->settings[0].cell_rows - 2;
    const int first = environment_row_start(scene, scene->settings[0].cell_rows);
    const int y = row < 0 ? 0 : (row > last ? last : row);
    const int x = column < columns ? column : 0;
    return scene->environment_cells[first + y * columns + x];
}

// Brightness at a cell's corners, in proportion to their sum; even where all are dark.
typedef struct {
    float top_left;
    float top_right;
    float bottom_left;
    float bottom_right;
} EnvironmentCorners;

SHARED EnvironmentCorners environment_corners(const Scene* scene, int row, int column)
{
    EnvironmentCorners corners;
    corners.top_left = environment_node(scene, row - 1, column);
    corners.top_right = environment_node(scene, row - 1, column + 1);
    corners.bottom_left = environment_node(scene, row, column);
    corners.bottom_right = environment_node(scene, row, column + 1);
    const float sum =
        (corners.top_left + corners.top_right) + (corners.bottom_left + corners.bottom_right);
    const float inverse = sum > 0.0f ? 1.0f / sum : 0.0f;
    corners.top_left = sum > 0.0f ? corners.top_left * inverse : 0.25f;
    corners.top_right = sum > 0.0f ? corners.top_right * inverse : 0.25f;
    corners.bottom_left = sum > 0.0f ? corners.bottom_left * inverse : 0.25f;
    corners.bottom_right = sum > 0.0f ? corners.bottom_right * inverse : 0.25f;
    return corners;
}

// Where a density that rises evenly from a to b has the share u in (0, 1] of its sum behind it.
SHARED float environment_ramp(float a, float b, float u)
{
    const float root = math_sqrt(math_lerp(a * a, b * b, u));
    const float t = a + root > 0.0f ? u * (a + b) / (a + root) : u;
    return t < 1.0f ? t : 1.0f;
}

// How far a cell's row reaches, from its upper to its lower nodes: from x to y.
SHARED float2 environment_reach(const Scene* scene, int row)
{
    return make_float2(row == 0 ? 0.5f : 0.0f,
                       row == scene->settings[0].cell_rows - 1 ? 0.5f : 1.0f);
}

// Density over solid angle at a place in a cell, from its upper left to its lower right node, that
// has a share of all; v * pi is its angle from the pole.
SHARED float environment_density(const Scene* scene, int row, EnvironmentCorners corners,
                                 float2 place, float share, float v)
{
    const float cells =
        (float)scene->settings[0].cell_columns * (float)(scene->settings[0].cell_rows - 1);
    const float2 reach = environment_reach(scene, row);
    const float top = math_lerp(corners.top_left, corners.top_right, place.x);
    const float bottom = math_lerp(corners.bottom_left, corners.bottom_right, place.x);
    const float over_mean = 4.0f * math_lerp(top, bottom, place.y);
    const float sine = math_sinpi(v);
    const float area = 2.0f * PI * PI * sine * (reach.y - reach.x);
    return sine > 0.0f ? share * over_mean * cells / area : 0.0f;
}

// Density over solid angle at uv of environment_light_sample, without the choice of the light.
SHARED float environment_pdf(const Scene* scene, float2 uv)
{
    const int columns = scene->settings[0].cell_columns;
    const int rows = scene->settings[0].cell_rows;
    const float x = uv.x * (float)columns - 0.5f;
    const float y = uv.y * (float)(rows - 1) + 0.5f;
    const float floor_x = math_floor(x);
    const float floor_y = math_floor(y);
    const int left = (int)floor_x;
    const int column = left < 0 ? left + columns : (left >= columns ? left - columns : left);
    const int row = floor_y < 0.0f ? 0 : (floor_y > (float)(rows - 1) ? rows - 1 : (int)floor_y);
    const float share = environment_share(scene, 0, row) *
                        environment_share(scene, environment_row_start(scene, row), column);
    return environment_density(scene, row, environment_corners(scene, row, column),
                               make_float2(x - floor_x, y - floor_y), share, uv.y);
}

// u in [0, 1)^2: y picks the row and the height in it, x the column and the place in that.
SHARED LightSample environment_light_sample(const Scene* scene, float2 u)
{
    const int columns = scene->settings[0].cell_columns;
    const int rows = scene->settings[0].cell_rows;
    const int row = environment_find(scene, 0, rows, u.y);
    const int start = environment_row_start(scene, row);
    const int column = environment_find(scene, start, columns, u.x);
    const EnvironmentCorners corners = environment_corners(scene, row, column);
    const float2 reach = environment_reach(scene, row);
    const float down = environment_ramp(corners.top_left + corners.top_right,
                                        corners.bottom_left + corners.bottom_right,
                                        environment_within(scene, 0, row, u.y));
    const float y = math_lerp(reach.x, reach.y, down);
    const float x = environment_ramp(math_lerp(corners.top_left, corners.bottom_left, y),
                                     math_lerp(corners.top_right, corners.bottom_right, y),
                                     environment_within(scene, start, column, u.x));
    const float2 uv = make_float2(((float)column + 0.5f + x) / (float)columns,
                                  ((float)row - 0.5f + y) / (float)(rows - 1));
    const float around = 2.0f * uv.x - 1.0f;
    const float sine = math_sinpi(uv.y);
    const float3 in_environment =
        make_float3(math_cospi(around) * sine, math_cospi(uv.y), math_sinpi(around) * sine);
    const float share = environment_share(scene, 0, row) * environment_share(scene, start, column);

    LightSample sample;
    sample.direction = direction_from_environment(scene, in_environment);
    sample.distance = FLOAT_MAX;
    sample.radiance = environment_radiance(scene, uv);
    sample.pdf = scene->settings[0].environment_probability *
                 environment_density(scene, row, corners, make_float2(x, y), share, uv.y);
    sample.is_punctual = 0;
    return sample;
}
