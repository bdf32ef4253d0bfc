// Lights are chosen, and points on them, as their densities state.
#include "platform.h"

#include "common/lights/lights.h"
#include "common/random.h"
#include "host/scene/scene_builder.hpp"
#include "tests/common/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace {

using namespace diptych;

constexpr int draws = 100000;

Scene view_of(const SceneData& data)
{
    Scene scene{};
    scene.effects = data.effects;
#define BIND(type, name) scene.name = data.name.data();
    SCENE_BUFFERS(BIND)
#undef BIND
    return scene;
}

float2 uniform_pair(std::mt19937& random)
{
    const float x = float(random() >> 8) * 0x1p-24f;
    return make_float2(x, float(random() >> 8) * 0x1p-24f);
}

// Lamps of very different power under a sky with a sun.
SceneData lamps_and_sky(int width, int height)
{
    SceneBuilder builder;
    std::mt19937 random(4);
    for (int k = 0; k < 12; ++k) {
        const float power = std::exp2(float(k % 5) - 3);
        const int lamp = builder.add_material({.emission = {power, power, 0.5f * power}});
        builder.place(
            builder.add_mesh(quad_mesh({double(k), 1, 0}, {0.5 + 0.1 * k, 0, 0}, {0, 0, 1}, lamp)));
    }
    builder.add_light({.kind = LIGHT_POINT, .intensity = {2, 2, 2}, .position = {0, 3, 0}});
    Picture map{width, height, {}, {}, false, 0};
    for (int t = 0; t < width * height; ++t) {
        const float value = t == 11 ? 100.0f : uniform_pair(random).x;
        map.floats.insert(map.floats.end(), {value, value, value, 1});
    }
    builder.set_environment(map, 0.6, 0.1f);
    return builder.finish();
}

TEST(Lights, AreChosenByTheirProbability)
{
    const SceneData data = lamps_and_sky(8, 4);
    const Scene scene = view_of(data);
    std::vector<double> expected, counts(data.lights.size());
    double sum = 0;
    for (const Light& light : data.lights) {
        expected.push_back(draws * double(light.emission.w));
        sum += light.emission.w;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    std::mt19937 random(1);
    for (int k = 0; k < draws; ++k)
        ++counts[size_t(light_choose(&scene, unsigned(random())).light)];
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

// Whichever light is chosen, and by whichever of the two ways that lead to it.
TEST(Lights, WhatTheChoiceLeavesIsUniform)
{
    constexpr int parts = 8;
    const SceneData data = lamps_and_sky(8, 4);
    const Scene scene = view_of(data);
    std::vector<double> expected, counts(data.lights.size() * parts);
    for (const Light& light : data.lights)
        expected.insert(expected.end(), parts, draws * double(light.emission.w) / parts);
    std::mt19937 random(3);
    for (int k = 0; k < draws; ++k) {
        const LightChoice choice = light_choose(&scene, unsigned(random()));
        ASSERT_GE(choice.rest, 0);
        ASSERT_LT(choice.rest, 1);
        ++counts[size_t(choice.light * parts + int(choice.rest * parts))];
    }
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

// A rectangle of two triangles: of 64 samples 32 fall to each, one in every cell of a grid of 8x4.
TEST(Lights, PointsOnALampOfTwoTrianglesStayStratified)
{
    SceneBuilder builder;
    const int lamp = builder.add_material({.emission = {1, 1, 1}});
    builder.place(builder.add_mesh(quad_mesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, lamp)));
    const SceneData data = builder.finish();
    const Scene scene = view_of(data);
    ASSERT_EQ(data.lights.size(), 2u);
    for (int pixel = 0; pixel < 16; ++pixel) {
        std::array<int, 64> counts{};
        for (int s = 0; s < 64; ++s) {
            const SampleBits bits = sample_bits(sample_key(1u, 2, pixel, s), 3);
            const LightChoice choice = light_choose(&scene, bits.x);
            const int column = int(choice.rest * 8);
            ++counts[size_t(choice.light * 32 + column * 4 + int(bits.y >> 30))];
        }
        for (int cell = 0; cell < 64; ++cell) EXPECT_EQ(counts[size_t(cell)], 1) << cell;
    }
}

// Density over the unit square of uv.
double density_of_uv(const Scene& scene, float u, float v)
{
    constexpr double pi = 3.14159265358979;
    return environment_pdf(&scene, make_float2(u, v)) * std::sin(pi * v) * 2 * pi * pi;
}

// Each of the map's texels in four parts, in which the density is bilinear: its middle is its mean.
// The direction is turned back by the code under test's inverse, whose own truth the orientation
// tests of the pictures show.
TEST(Lights, EnvironmentSamplesFollowTheirDensity)
{
    constexpr int width = 16, height = 8, parts = 2;
    const SceneData data = lamps_and_sky(width, height);
    const Scene scene = view_of(data);
    constexpr int columns = width * parts, rows = height * parts;
    std::vector<double> expected(columns * rows), counts(columns * rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            expected[size_t(y * columns + x)] =
                draws *
                density_of_uv(scene, (float(x) + 0.5f) / columns, (float(y) + 0.5f) / rows) /
                (columns * rows);
    std::mt19937 random(2);
    for (int k = 0; k < draws; ++k) {
        const LightSample sample = environment_light_sample(&scene, uniform_pair(random));
        const float2 uv = environment_uv(direction_to_environment(&scene, sample.direction));
        const int x = std::min(columns - 1, int(uv.x * columns));
        const int y = std::min(rows - 1, int(uv.y * rows));
        ++counts[size_t(y * columns + x)];
        // A point on a cell's edge, between nodes, may fall to the next cell on the way back.
        const float row = uv.y * height - 0.5f;
        if (std::abs(row - std::round(row)) < 1e-3f || std::min(uv.y, 1 - uv.y) < 0.01f) continue;
        const float pdf = data.settings[0].environment_probability * environment_pdf(&scene, uv);
        ASSERT_NEAR(sample.pdf, pdf, 1e-3f * pdf + 1e-3f);
        ASSERT_NEAR(sample.radiance.x, environment_radiance(&scene, uv).x, 1e-3f);
    }
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

TEST(Lights, EnvironmentDensityIntegratesToOne)
{
    const SceneData data = lamps_and_sky(16, 8);
    const Scene scene = view_of(data);
    constexpr int size = 512;
    double sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const float u = (float(x) + 0.5f) / size, v = (float(y) + 0.5f) / size;
            sum += density_of_uv(scene, u, v) / (double(size) * size);
        }
    EXPECT_NEAR(sum, 1, 1e-4);
}

// A map in which many texels and whole rows are black: each texel a cell.
SceneData sparse_sky(int width, int height)
{
    std::mt19937 random(8);
    Picture map{width, height, {}, {}, false, 0};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool is_lit = y % 7 > 2 && x % 11 > 4 && x < width - 9;
            const float value = is_lit ? std::exp2(40 * uniform_pair(random).x - 30) : 0.0f;
            map.floats.insert(map.floats.end(), {value, value, value, 1});
        }
    SceneBuilder builder;
    builder.set_environment(map);
    return builder.finish();
}

// The search against its definition, on both sides of each border between two cells: the last cell
// that starts at u or before, which is never an empty one.
void expect_found(const Scene& scene, int start, int count)
{
    const float* table = scene.environment_cells + start;
    ASSERT_EQ(table[0], 0);
    ASSERT_EQ(table[count], 1);
    for (int cell = 0; cell < count; ++cell) {
        ASSERT_LE(table[cell], table[cell + 1]);
        for (const float u : {table[cell], table[cell + 1] - 0x1p-24f}) {
            if (u < table[cell] || u >= table[cell + 1]) continue;
            ASSERT_EQ(environment_find(&scene, start, count, u), cell);
            const float within = environment_within(&scene, start, cell, u);
            ASSERT_GT(within, 0);
            ASSERT_LE(within, 1);
        }
    }
}

TEST(Lights, EnvironmentCellsAreFound)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {64, 33}, {1024, 512}}) {
        const SceneData data = sparse_sky(width, height);
        const Scene scene = view_of(data);
        const int rows = data.settings[0].cell_rows, columns = data.settings[0].cell_columns;
        ASSERT_NO_FATAL_FAILURE(expect_found(scene, 0, rows));
        for (int row = 0; row < rows; ++row)
            ASSERT_NO_FATAL_FAILURE(
                expect_found(scene, environment_row_start(&scene, row), columns));
    }
}

// A sun whose edge is as hard as texels can make it, in a dim sky: what is seen is as bright as it
// is rare, so that one sample tells the light of all.
TEST(Lights, EnvironmentSamplesAreAsBrightAsTheyAreRare)
{
    Picture map{64, 32, {}, {}, false, 0};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const bool is_sun = std::abs(x - 20) < 2 && std::abs(y - 9) < 2;
            const float value = is_sun ? 1000.0f : 0.01f * float(1 + x % 3 + y % 2);
            map.floats.insert(map.floats.end(), {value, value, value, 1});
        }
    SceneBuilder builder;
    builder.set_environment(map);
    const SceneData data = builder.finish();
    const Scene scene = view_of(data);
    std::mt19937 random(6);
    double least = 1e30, most = 0;
    for (int k = 0; k < 4096; ++k) {
        const LightSample sample = environment_light_sample(&scene, uniform_pair(random));
        if (std::abs(sample.direction.y) > 0.95f) continue;  // a row is wide there, and sines vary
        least = std::min(least, double(sample.radiance.x / sample.pdf));
        most = std::max(most, double(sample.radiance.x / sample.pdf));
    }
    EXPECT_LT(most, 1.2 * least);
}

// Neighbours stay neighbours: a direction's v follows y to within a row, its u rises with x.
TEST(Lights, EnvironmentSamplesKeepTheOrderOfTheirNumbers)
{
    const SceneData data = sparse_sky(64, 32);
    const Scene scene = view_of(data);
    float last_v = 0;
    for (int y = 0; y < 64; ++y) {
        float last_u = 0;
        for (int x = 0; x < 64; ++x) {
            const float2 u = make_float2(float(x) / 64, float(y) / 64);
            const LightSample sample = environment_light_sample(&scene, u);
            const float2 uv = environment_uv(direction_to_environment(&scene, sample.direction));
            ASSERT_GE(uv.x, last_u - 1e-6f);
            ASSERT_GE(uv.y, last_v - 1.0f / 32);
            last_u = uv.x;
            if (x == 63) last_v = uv.y;
        }
    }
}

// Of the irradiance on a horizontal surface by what is brighter than `mean`: its variance as
// `samples` points estimate it, relative to its square, times the number of points; constant for
// random points.
double error_per_sample(const Scene& scene, double mean_radiance, int samples)
{
    constexpr int trials = 2000;
    double sum = 0, squares = 0;
    for (int trial = 0; trial < trials; ++trial) {
        double estimate = 0;
        for (int k = 0; k < samples; ++k) {
            const SampleKey key{unsigned(k), hash_uint(unsigned(trial))};
            const LightSample sample = environment_light_sample(&scene, sample_pair(key, 3));
            const double above = std::max(double(sample.radiance.x) - mean_radiance, 0.0);
            if (sample.direction.y > 0 && sample.pdf > 0)
                estimate += above * sample.direction.y / sample.pdf / samples;
        }
        sum += estimate;
        squares += estimate * estimate;
    }
    const double mean = sum / trials;
    return (squares / trials - mean * mean) / (mean * mean) * samples;
}

// The points of a sequence are spread evenly over the square, and the directions made of them over
// the sky: the error falls faster than with random points.
TEST(Lights, EnvironmentSamplesStayStratified)
{
    SceneBuilder builder;
    Picture map{256, 128, {}, {}, false, 0};
    double sum = 0, area = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const double sun = std::exp(-0.02 * ((x - 90) * (x - 90) + (y - 30) * (y - 30)));
            const float value = float(1 + 0.5 * std::sin(0.07 * x) + 60 * sun);
            const double sine = std::sin(3.14159265358979 * (y + 0.5) / 128);
            sum += sine * double(value);
            area += sine;
            map.floats.insert(map.floats.end(), {value, value, value, 1});
        }
    builder.set_environment(map);
    const SceneData data = builder.finish();
    const Scene scene = view_of(data);
    const double at_1 = error_per_sample(scene, sum / area, 1);
    const double at_16 = error_per_sample(scene, sum / area, 16);
    const double at_64 = error_per_sample(scene, sum / area, 64);
    EXPECT_LT(at_16, 0.03 * at_1);
    EXPECT_LT(at_64, 0.8 * at_16);
}

// Density over solid angle: that of the area, seen under its distance and slope.
TEST(Lights, TriangleDensityIsThatOfItsSolidAngle)
{
    const SceneData data = lamps_and_sky(8, 4);
    const Scene scene = view_of(data);
    const float3 below = make_float3(0.3f, -1.5f, 0.2f);  // where the quads face
    const float3 above = make_float3(0.3f, 2.5f, 0.2f);
    std::mt19937 random(3);
    for (int light = 0; light < 24; ++light) {
        const Light& l = data.lights[size_t(light)];
        EXPECT_EQ(triangle_light_sample(&scene, light, above, uniform_pair(random)).pdf, 0);
        const LightSample sample =
            triangle_light_sample(&scene, light, below, uniform_pair(random));
        const double area = 0.5 * double(vec_length(vec_cross(xyz(l.edge1), xyz(l.edge2))));
        const double expected =
            l.emission.w / area * sample.distance * sample.distance / std::abs(sample.direction.y);
        EXPECT_NEAR(sample.pdf, expected, 1e-4 * expected);
        const float3 point = below + sample.direction * sample.distance;
        EXPECT_NEAR(point.y, 1, 1e-4);
    }
}

TEST(Lights, WeightsOfTwoTechniquesAddUpToOne)
{
    for (const float a : {1e-20f, 1e-3f, 1.0f, 7.0f, 1e20f})
        for (const float b : {1e-20f, 1e-3f, 1.0f, 7.0f, 1e20f})
            for (const auto weight : {mis_weight, mis_balance_weight})
                EXPECT_NEAR(weight(a, b) + weight(b, a), 1, 1e-6) << a << " " << b;
    for (const auto weight : {mis_weight, mis_balance_weight}) {
        EXPECT_EQ(weight(0, 1), 0);
        EXPECT_EQ(weight(1, 0), 1);
    }
}

}  // namespace
