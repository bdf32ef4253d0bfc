// Light from everywhere: a latitude-longitude image, row 0 at +Y, u = 0.5 + atan2(z, x) / 2 pi, v =
// acos(y) / pi in the environment's own frame. Sampled by cells of equal angle, chosen by their
// power.
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
    return make_float3(scene->texels_float[k00].x * w00 + scene->texels_float[k10].x * w10 +
                           scene->texels_float[k01].x * w01 + scene->texels_float[k11].x * w11,
                       scene->texels_float[k00].y * w00 + scene->texels_float[k10].y * w10 +
                           scene->texels_float[k01].y * w01 + scene->texels_float[k11].y * w11,
                       scene->texels_float[k00].z * w00 + scene->texels_float[k10].z * w10 +
                           scene->texels_float[k01].z * w01 + scene->texels_float[k11].z * w11);
}

SHARED float3 environment_radiance(const Scene* scene, float2 uv)
{
    return environment_texel(scene, uv) * xyz(scene->settings[0].environment_scale);
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
    const float share = scene->environment_cells[row * columns + column].probability;
    const float sine = math_sinpi(uv.y);
    const float cells = (float)columns * (float)rows;
    return sine > 0.0f ? share * cells / (2.0f * PI * PI * sine) : 0.0f;
}

// choice picks the cell, within the point in it; both in [0, 1)^2.
SHARED LightSample environment_light_sample(const Scene* scene, float2 choice, float2 within)
{
    const int columns = scene->settings[0].cell_columns;
    const int rows = scene->settings[0].cell_rows;
    const int last = columns * rows - 1;
    const float scaled = choice.x * ((float)columns * (float)rows);
    const int drawn = (int)scaled > last ? last : (int)scaled;
    const int alias = scene->environment_cells[drawn].alias;
    const float threshold = scene->environment_cells[drawn].threshold;
    const int mask = choice.y < threshold ? 0 : -1;
    const int cell = drawn ^ ((drawn ^ alias) & mask);
    const int row = (int)(((float)cell + 0.5f) / (float)columns);
    const int column = cell - row * columns;
    const float2 uv = make_float2(((float)column + within.x) / (float)columns,
                                  ((float)row + within.y) / (float)rows);
    const float around = 2.0f * uv.x - 1.0f;
    const float sine = math_sinpi(uv.y);
    const float3 in_environment =
        make_float3(math_cospi(around) * sine, math_cospi(uv.y), math_sinpi(around) * sine);
    const float share = scene->environment_cells[cell].probability;
    const float cells = (float)columns * (float)rows;

    LightSample sample;
    sample.direction = direction_from_environment(scene, in_environment);
    sample.distance = FLOAT_MAX;
    sample.radiance = environment_radiance(scene, uv);
    sample.pdf = sine > 0.0f ? scene->settings[0].environment_probability * share * cells /
                                   (2.0f * PI * PI * sine)
                             : 0.0f;
    sample.is_punctual = 0;
    return sample;
}
