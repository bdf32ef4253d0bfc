#include "host/scene/alias_table.hpp"
#include "host/scene/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace diptych {
namespace {

constexpr double pi = 3.14159265358979323846;

// The probability with which each outcome really comes out of a table.
std::vector<double> realised(const std::vector<AliasEntry>& table)
{
    std::vector<double> result(table.size(), 0);
    for (size_t k = 0; k < table.size(); ++k) {
        result[k] += table[k].threshold / double(table.size());
        result[size_t(table[k].alias)] += (1 - double(table[k].threshold)) / double(table.size());
    }
    return result;
}

void expect_consistent(const std::vector<AliasEntry>& table)
{
    const auto drawn = realised(table);
    double sum = 0;
    for (size_t k = 0; k < table.size(); ++k) {
        EXPECT_NEAR(drawn[k], table[k].probability, 1e-6 / std::sqrt(double(table.size()))) << k;
        if (table[k].probability == 0) {
            EXPECT_EQ(drawn[k], 0) << k;
        }
        sum += table[k].probability;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(AliasTable, Reproduces_its_weights)
{
    std::mt19937 random(3);
    std::exponential_distribution<double> weight;
    for (const int count : {1, 2, 3, 17, 1000}) {
        std::vector<double> weights;
        for (int k = 0; k < count; ++k) {
            weights.push_back(k % 5 == 4 ? 0 : weight(random));
        }
        weights[0] *= 1e6;
        const auto table = alias_table(weights);
        expect_consistent(table);
        double total = 0;
        for (const double w : weights) {
            total += w;
        }
        for (size_t k = 0; k < table.size(); ++k) {
            EXPECT_FLOAT_EQ(table[k].probability, float(weights[k] / total));
        }
    }
    EXPECT_TRUE(alias_table(std::vector<double>{0, 0}).empty());
    EXPECT_TRUE(alias_table(std::vector<double>{}).empty());
    // Equal weights leave rounding to decide which columns stay whole.
    expect_consistent(alias_table(std::vector<double>(49, 0.1)));
}

int add_lamp(SceneBuilder& scene, float radiance, double size, double x)
{
    const int lamp =
        scene.add_material({.specular = 0, .emission = {radiance, radiance, radiance}});
    return scene.add_mesh(quad_mesh({x, 0, 0}, {size, 0, 0}, {0, size, 0}, lamp));
}

TEST(Lights, Are_chosen_by_power)
{
    SceneBuilder scene;
    scene.place(add_lamp(scene, 2, 1, 0));  // 2 pi W, as two triangles
    scene.place(add_lamp(scene, 3, 2, 5));  // 12 pi W
    scene.add_light({.kind = LIGHT_POINT, .intensity = {1, 1, 1}});
    scene.add_light({.kind = LIGHT_SPOT, .intensity = {5, 5, 5}, .outer_angle = pi / 3});
    scene.add_light({.kind = LIGHT_DIRECTIONAL, .intensity = {0.25f, 0.25f, 0.25f}});
    scene.add_light({.kind = LIGHT_POINT, .intensity = {0, 0, 0}});  // no light
    const SceneData data = scene.finish();
    ASSERT_EQ(data.lights.size(), 7u);
    EXPECT_EQ(data.settings[0].light_count, 7);
    EXPECT_EQ(data.effects, unsigned(EFFECT_EMISSION | EFFECT_PUNCTUAL_LIGHTS));
    const double radius = data.settings[0].scene_radius;
    const double powers[] = {
        pi, pi, 6 * pi, 6 * pi, 4 * pi, 2 * pi * 0.5 * 5, pi * radius * radius * 0.25};
    double total = 0;
    for (const double p : powers) {
        total += p;
    }
    for (size_t k = 0; k < 7; ++k) {
        EXPECT_NEAR(data.lights[k].emission.w, powers[k] / total, 1e-6) << k;
        EXPECT_EQ(data.lights[k].emission.w, data.light_choice[k].probability);
    }
    expect_consistent(data.light_choice);
    // Density over area: the choice of a triangle, spread over it.
    EXPECT_NEAR(data.materials[0].emission.w, data.lights[0].emission.w / 0.5, 1e-6);
    EXPECT_NEAR(data.materials[1].emission.w, data.lights[2].emission.w / 2, 1e-6);
}

TEST(Lights, Of_instances_stand_in_the_world_and_shine_from_the_front)
{
    SceneBuilder scene;
    const int lamp = add_lamp(scene, 1, 1, 0);
    scene.place(lamp, translation(0, 0, 5));
    scene.place(lamp, translation(0, 0, -5) * scaling(-2, 1, 1));
    const SceneData data = scene.finish();
    ASSERT_EQ(data.lights.size(), 4u);
    for (const Light& light : data.lights) {
        const Vec3 e1{light.edge1.x, light.edge1.y, light.edge1.z};
        const Vec3 e2{light.edge2.x, light.edge2.y, light.edge2.z};
        // Both placements keep facing +z: a mirrored one by its sign.
        EXPECT_GT(cross(e1, e2)[2] * light.normal_sign, 0);
        EXPECT_EQ(light.position.z, light.instance == 1 ? 5 : -5);
        EXPECT_EQ(light.normal_sign, light.instance == 1 ? 1 : -1);
        EXPECT_NEAR(light.emission.w, light.instance == 1 ? 1.0 / 6 : 1.0 / 3, 1e-6);
    }
}

TEST(Lights, Textured_emission_counts_with_its_mean)
{
    SceneBuilder scene;
    Picture half{2, 1, {255, 255, 255, 255, 0, 0, 0, 255}, {}, true, 0};
    const int image = scene.add_image(half);
    const int lamp = scene.add_material(
        {.specular = 0, .emission = {4, 2, 0}, .emission_texture = {.image = image}});
    scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp)));
    const SceneData data = scene.finish();
    ASSERT_EQ(data.lights.size(), 2u);
    EXPECT_FLOAT_EQ(data.lights[0].emission.x, 2);
    EXPECT_FLOAT_EQ(data.lights[0].emission.y, 1);
    EXPECT_FLOAT_EQ(data.materials[0].emission.x, 4);
    EXPECT_FLOAT_EQ(data.materials[0].emission.w, 1) << "one square metre, the only light";
}

// A square metre on the ground, of which a spot gives the only light.
TEST(Lights, Scenes_that_they_leave_black_are_noticed)
{
    for (const float radiance : {1.0f, 1e-4f}) {
        SceneBuilder scene;
        const int ground = scene.add_material({});
        const int lamp = scene.add_material({.emission = {radiance, radiance, radiance}});
        scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, ground)));
        scene.place(scene.add_mesh(quad_mesh({0.5, 0.1, 0.5}, {0.3, 0, 0}, {0, 0, 0.3}, lamp)));
        const SceneData data = scene.finish();
        const bool is_noticed =
            !data.notices.empty() && data.notices.back().find("nearly black") != std::string::npos;
        EXPECT_EQ(is_noticed, radiance < 0.01f) << radiance;
    }
}

TEST(Lights, Unlit_surfaces_are_none)
{
    SceneBuilder scene;
    const int lamp = scene.add_material({.emission = {4, 2, 0}, .is_unlit = true});
    scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp)));
    EXPECT_FALSE(scene.has_lights());
    EXPECT_TRUE(scene.finish().lights.empty());
}

TEST(Lights, Spots_have_the_cone_of_the_extension)
{
    SceneBuilder scene;
    scene.add_light({.kind = LIGHT_SPOT,
                     .position = {1, 2, 3},
                     .direction = {0, -2, 0},
                     .inner_angle = 0.2,
                     .outer_angle = 0.5,
                     .range = 9});
    const SceneData data = scene.finish();
    const Light& spot = data.lights[0];
    EXPECT_EQ(spot.edge1.y, -1);
    EXPECT_EQ(spot.position.z, 3);
    EXPECT_FLOAT_EQ(spot.edge2.x, float(std::cos(0.5)));
    EXPECT_FLOAT_EQ(spot.edge2.y, float(1 / (std::cos(0.2) - std::cos(0.5))));
    EXPECT_EQ(spot.range, 9);
}

// Entries of environment_cells for so many cells; see common/lights/environment.h.
size_t cumulated_size(const Settings& s)
{
    return size_t(s.cell_rows + 1) + size_t(s.cell_rows) * size_t(s.cell_columns + 1) +
           size_t(s.cell_rows - 1) * size_t(s.cell_columns);
}

double cell_probability(const SceneData& data, int row, int column)
{
    const Settings& s = data.settings[0];
    const float* rows = data.environment_cells.data();
    const float* columns = rows + s.cell_rows + 1 + row * (s.cell_columns + 1);
    return (double(rows[row + 1]) - double(rows[row])) *
           (double(columns[column + 1]) - double(columns[column]));
}

// A map of noise with one bright texel at the seam.
Picture environment_map(int width, int height)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> value(0, 1);
    Picture map{width, height, {}, {}, false, 0};
    for (int k = 0; k < width * height; ++k) {
        const float v = k == width * (height / 3) ? 5000 : value(random);
        map.floats.insert(map.floats.end(), {v, v, v, 1});
    }
    return map;
}

// The map's luminance as the renderer will filter it.
double filtered(const SceneData& data, double u, double v)
{
    const Settings& s = data.settings[0];
    const double x = u * s.environment_width - 0.5, y = v * s.environment_height - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    double sum = 0;
    for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
            const int column = (x0 + dx + s.environment_width) % s.environment_width;
            const int row = std::min(std::max(y0 + dy, 0), s.environment_height - 1);
            const double share = (dx ? x - x0 : 1 - x + x0) * (dy ? y - y0 : 1 - y + y0);
            sum +=
                share *
                data.texels_float[size_t(s.environment_texels + column + row * s.environment_width)]
                    .y;
        }
    }
    return sum;
}

// The density in a cell by its corners, x and y from its upper left one, over the cell's mean.
double over_mean(const SceneData& data, int row, int column, double x, double y)
{
    const Settings& s = data.settings[0];
    const auto node = [&](int r, int c) {
        const int inside = std::clamp(r, 0, s.cell_rows - 2);
        const size_t first = size_t(s.cell_rows + 1) + size_t(s.cell_rows * (s.cell_columns + 1));
        return double(data.environment_cells[first + size_t(inside * s.cell_columns) +
                                             size_t(c % s.cell_columns)]);
    };
    const double top = node(row - 1, column) * (1 - x) + node(row - 1, column + 1) * x;
    const double bottom = node(row, column) * (1 - x) + node(row, column + 1) * x;
    const double mean = (node(row - 1, column) + node(row - 1, column + 1) + node(row, column) +
                         node(row, column + 1)) /
                        4;
    return (top * (1 - y) + bottom * y) / mean;
}

// At the nodes, over all directions.
double mean_of_nodes(const SceneData& data, const std::function<double(double)>& of_radiance)
{
    const int columns = data.settings[0].cell_columns, rows = data.settings[0].cell_rows - 1;
    double sum = 0, area = 0;
    for (int y = 0; y < rows; ++y) {
        const double sine = std::sin(pi * (y + 0.5) / rows);
        for (int x = 0; x < columns; ++x)
            sum += sine * of_radiance(filtered(data, (x + 0.5) / columns, (y + 0.5) / rows));
        area += sine * columns;
    }
    return sum / area;
}

// What light sampling and scattering find, the latter by the mean in all directions, is the
// filtered map's brightness or more; where nodes stand for several texels, no direction is much
// brighter.
TEST(Environment, Light_sampling_finds_what_is_brighter_than_the_mean)
{
    for (const auto& [width, height] : {std::pair{64, 32}, {1500, 700}, {5000, 8}}) {
        SceneBuilder scene;
        scene.set_environment(environment_map(width, height));
        const SceneData data = scene.finish();
        const Settings& s = data.settings[0];
        EXPECT_EQ(data.effects, unsigned(EFFECT_ENVIRONMENT));
        EXPECT_EQ(s.environment_light, 0);
        EXPECT_EQ(s.environment_probability, 1);
        EXPECT_LE(s.cell_columns, MOST_ENVIRONMENT_CELLS);
        EXPECT_LE(s.cell_rows, MOST_ENVIRONMENT_CELLS);
        ASSERT_EQ(data.environment_cells.size(), cumulated_size(s));

        const bool is_exact = s.cell_columns == width;
        const double mean = mean_of_nodes(data, [](double value) { return value; });
        const double above =
            4 * pi * mean_of_nodes(data, [&](double value) { return std::max(value - mean, 0.0); });
        double integral = 0, weighted = 0, worst = 0, where_dark = 0;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> unit_range(0, 1);
        for (int row = 0; row < s.cell_rows; ++row) {
            for (int column = 0; column < s.cell_columns; ++column) {
                const double rows = s.cell_rows - 1;
                const double upper = std::max(row - 0.5, 0.0), lower = std::min(row + 0.5, rows);
                const double x = unit_range(random);
                const double y = upper + (lower - upper) * unit_range(random);
                const auto brightness = [&](double u, double v) {
                    return filtered(data, u / s.cell_columns, v / rows);
                };
                const double here = brightness(column + 0.5 + x, y);
                const double solid_angle =
                    2 * pi / s.cell_columns *
                    (std::cos(pi * upper / rows) - std::cos(pi * lower / rows));
                const double probability = cell_probability(data, row, column);
                const double density = probability > 0
                                           ? probability / solid_angle *
                                                 over_mean(data, row, column, x, y - (row - 0.5))
                                           : 0;
                const double found = density * above + mean;
                integral += here * solid_angle;
                weighted += here * here / found * solid_angle;
                worst = std::max(worst, here / found);
                const double corners =
                    std::max({brightness(column + 0.5, upper), brightness(column + 1.5, upper),
                              brightness(column + 0.5, lower), brightness(column + 1.5, lower)});
                if (corners < 0.99 * mean) where_dark += probability;
            }
        }
        EXPECT_LT(worst, is_exact ? 1.02 : 6) << width;
        EXPECT_LT(weighted / integral, is_exact ? 1 : 1.5) << width;
        EXPECT_LT(where_dark, is_exact ? 1e-6 : 0.5) << width;
    }
}

TEST(Environment, Light_samples_of_an_even_one_are_even)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {16, 8}}) {
        SceneBuilder scene;
        scene.set_environment(
            Picture{width, height, {}, std::vector<float>(size_t(4 * width * height), 0.7f)});
        const SceneData data = scene.finish();
        const Settings& s = data.settings[0];
        for (int row = 0; row < s.cell_rows; ++row) {
            const double rows = s.cell_rows - 1;
            const double upper = std::max(row - 0.5, 0.0), lower = std::min(row + 0.5, rows);
            const double share =
                (std::cos(pi * upper / rows) - std::cos(pi * lower / rows)) / 2 / s.cell_columns;
            for (int column = 0; column < s.cell_columns; ++column)
                EXPECT_NEAR(cell_probability(data, row, column), share, 1e-6);
        }
    }
}

TEST(Environment, Turns_about_the_vertical)
{
    SceneBuilder scene;
    scene.set_environment(environment_map(8, 4), pi / 2, 3);
    const SceneData data = scene.finish();
    const Settings& s = data.settings[0];
    EXPECT_EQ(s.environment_scale.x, 3);
    // What stood at +x is now at -z, as a quarter turn about +y takes it.
    EXPECT_NEAR(-s.environment_x.z, 1, 1e-6);
    EXPECT_NEAR(-s.environment_z.z, 0, 1e-6);
    EXPECT_EQ(s.environment_y.y, 1);
}

TEST(Environment, A_black_one_is_no_light)
{
    SceneBuilder scene;
    scene.set_environment(Picture{2, 1, {}, std::vector<float>(8, 0.0f), false, 0});
    const SceneData data = scene.finish();
    EXPECT_TRUE(data.lights.empty());
    EXPECT_EQ(data.settings[0].environment_light, -1);
    // Never chosen, but kernels search before they select.
    EXPECT_EQ(data.environment_cells, (std::vector<float>{0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 0}));
}

}  // namespace
}  // namespace diptych
