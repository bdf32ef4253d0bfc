// Light from everywhere: a latitude-longitude image, row 0 at +Y, u = 0.5 + atan2(z, x) / 2 pi, v =
// acos(y) / pi in the environment's own frame. Sampled by cells of equal angle, in proportion to
// their power, by inversion: neighbouring sample values give neighbouring directions, so that the
// spread of the samples over the unit square survives.
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
// those of the columns within each row (cell_columns + 1 values each). They are multiples of 2^-24,
// as sample values are: differences are exact, and are the very probabilities with which sample
// values fall between two of them.
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

// Density over solid angle of a cell of that share of all, at the angle v * pi from the pole.
SHARED float environment_density(const Scene* scene, float share, float v)
{
    const float cells =
        (float)scene->settings[0].cell_columns * (float)scene->settings[0].cell_rows;
    const float sine = math_sinpi(v);
    return sine > 0.0f ? share * cells / (2.0f * PI * PI * sine) : 0.0f;
}

// Density over solid angle at uv of environment_light_sample, without the choice of the light.
SHARED float environment_pdf(const Scene* scene, float2 uv)
{
    const int columns = scene->settings[0].cell_columns;
    const int rows = scene->settings[0].cell_rows;
    const int x = (int)(uv.x * (float)columns);
    const int y = (int)(uv.y * (float)rows);
    const int column = x < 0 ? 0 : (x >= columns ? columns - 1 : x);
    const int row = y < 0 ? 0 : (y >= rows ? rows - 1 : y);
    const float share = environment_share(scene, 0, row) *
                        environment_share(scene, environment_row_start(scene, row), column);
    return environment_density(scene, share, uv.y);
}

// u in [0, 1)^2: y picks the row and the height in it, x the column and the place in that.
SHARED LightSample environment_light_sample(const Scene* scene, float2 u)
{
    const int columns = scene->settings[0].cell_columns;
    const int rows = scene->settings[0].cell_rows;
    const int row = environment_find(scene, 0, rows, u.y);
    const int start = environment_row_start(scene, row);
    const int column = environment_find(scene, start, columns, u.x);
    const float x = (float)column + environment_within(scene, start, column, u.x);
    const float y = (float)row + environment_within(scene, 0, row, u.y);
    const float2 uv = make_float2(x / (float)columns, y / (float)rows);
    const float around = 2.0f * uv.x - 1.0f;
    const float sine = math_sinpi(uv.y);
    const float3 in_environment =
        make_float3(math_cospi(around) * sine, math_cospi(uv.y), math_sinpi(around) * sine);
    const float share = environment_share(scene, 0, row) * environment_share(scene, start, column);

    LightSample sample;
    sample.direction = direction_from_environment(scene, in_environment);
    sample.distance = FLOAT_MAX;
    sample.radiance = environment_radiance(scene, uv);
    sample.pdf =
        scene->settings[0].environment_probability * environment_density(scene, share, uv.y);
    sample.is_punctual = 0;
    return sample;
}
