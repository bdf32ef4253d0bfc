// Lights are chosen, and points on them, as their densities state.
#include "platform.h"

#include "common/lights/lights.h"
#include "host/scene/scene_builder.hpp"
#include "tests/common/statistics.hpp"

#include <gtest/gtest.h>

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
    for (int k = 0; k < draws; ++k) ++counts[size_t(light_choose(&scene, uniform_pair(random)))];
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

// Each of the map's cells in four parts; the direction is turned back by the code under test's
// inverse, whose own truth the orientation tests of the pictures show.
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
                double(data.environment_cells[size_t(y / parts * width + x / parts)].probability) /
                (parts * parts);
    std::mt19937 random(2);
    for (int k = 0; k < draws; ++k) {
        const float2 choice = uniform_pair(random);
        const LightSample sample = environment_light_sample(&scene, choice, uniform_pair(random));
        const float2 uv = environment_uv(direction_to_environment(&scene, sample.direction));
        const int x = std::min(columns - 1, int(uv.x * columns));
        const int y = std::min(rows - 1, int(uv.y * rows));
        ++counts[size_t(y * columns + x)];
        // A point on a cell's edge may fall to the next cell on the way back.
        const double edge_x = std::abs(uv.x * width - std::round(uv.x * width));
        const double edge_y = std::abs(uv.y * height - std::round(uv.y * height));
        if (std::min(edge_x, edge_y) < 1e-3 || std::min(uv.y, 1 - uv.y) < 0.01f) continue;
        const float pdf = data.settings[0].environment_probability * environment_pdf(&scene, uv);
        ASSERT_NEAR(sample.pdf, pdf, 1e-3f * pdf);
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
            const float2 uv = make_float2((float(x) + 0.5f) / size, (float(y) + 0.5f) / size);
            sum += environment_pdf(&scene, uv) * std::sin(3.14159265358979 * uv.y) * 2 *
                   3.14159265358979 * 3.14159265358979 / (double(size) * size);
        }
    EXPECT_NEAR(sum, 1, 1e-4);
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
            EXPECT_NEAR(mis_weight(a, b) + mis_weight(b, a), 1, 1e-6) << a << " " << b;
    EXPECT_EQ(mis_weight(0, 1), 0);
    EXPECT_EQ(mis_weight(1, 0), 1);
}

}  // namespace
