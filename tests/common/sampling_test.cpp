// What the sampling functions draw follows the densities they state: chi-square tests.
#include "platform.h"

#include "common/filter.h"
#include "common/lights/triangle_light.h"
#include "common/materials/metallic_roughness.h"
#include "tests/common/statistics.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

constexpr int draws = 100000;
constexpr int rows = 16, columns = 16;
constexpr double pi = 3.14159265358979323846;

class Uniform {
public:
    explicit Uniform(unsigned seed) : random_(seed) {}
    float operator()() { return uniform_from_bits(random_()); }
    float2 pair()
    {
        const float x = (*this)();
        return make_float2(x, (*this)());
    }

private:
    static float uniform_from_bits(unsigned bits) { return float(bits >> 8) * 0x1p-24f; }
    std::mt19937 random_;
};

int clamped(double x, int count) { return x < 0 ? 0 : (x >= count ? count - 1 : int(x)); }

double azimuth(float3 v) { return std::atan2(double(v.y), double(v.x)) / (2 * pi) + 0.5; }

struct Case {
    float roughness, metallic, cosine;
};

std::vector<Case> cases()
{
    std::vector<Case> all;
    for (const float roughness : {0.1f, 0.25f, 0.5f, 1.0f})
        for (const float metallic : {0.0f, 0.5f, 1.0f})
            for (const float cosine : {0.05f, 0.4f, 0.95f})
                all.push_back({roughness, metallic, cosine});
    return all;
}

Lobes lobes_for(const Case& c)
{
    Surface surface;
    surface.base_color = make_float3(0.7f, 0.5f, 0.4f);
    surface.metallic = c.metallic;
    surface.roughness = c.roughness;
    surface.dielectric_f0 = make_float3(0.04f, 0.04f, 0.04f);
    surface.dielectric_f90 = 1;
    return lobes_of(surface, c.cosine);
}

float3 direction_of(const Case& c)
{
    const float sine = std::sqrt(1 - c.cosine * c.cosine);
    return make_float3(sine * 0.6f, sine * 0.8f, c.cosine);
}

// A microfacet normal at a point of a unit square in which narrow lobes are wide: c is the share of
// normals less tilted than it, s = 1 - sqrt(1 - c).
struct Microfacet {
    float3 normal;
    double density;      // of normals over solid angle, D
    double solid_angle;  // of normals, per area of the square
};

Microfacet microfacet_at(double s, double around, double alpha)
{
    const double c = 1 - (1 - s) * (1 - s);
    const double tangent2 = alpha * alpha * c / (1 - c);
    const double z = 1 / std::sqrt(1 + tangent2), r = std::sqrt(tangent2) * z;
    const double phi = 2 * pi * (around - 0.5);
    const double d = z * z * (tangent2 / (alpha * alpha) + 1);
    const double density = 1 / (pi * alpha * alpha * d * d);
    return {make_float3(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)), density,
            2 * (1 - s) / (density * z)};
}

double place_of(float3 h, double alpha)
{
    const double tangent2 = (double(h.x) * h.x + double(h.y) * h.y) / (double(h.z) * h.z);
    return 1 - std::sqrt(alpha * alpha / (tangent2 + alpha * alpha));
}

// Over the cells of that square: what the lobes' stated density gives for specular samples, and
// what is lost because the reflection would point into the surface, by the density of visible
// normals (Heitz 2014) written out here.
struct Expected {
    std::vector<double> cells;
    double lost = 0;
};

Expected expected_specular(const Lobes& lobes, float3 wo, double alpha)
{
    constexpr int fine = 24;
    const double p = lobes.specular_probability;
    const double g1 = 2 / (1 + std::sqrt(1 + alpha * alpha * (1 / (double(wo.z) * wo.z) - 1)));
    const double cell = 1.0 / (double(rows) * columns * fine * fine);
    Expected expected{std::vector<double>(rows * columns), 0};
    for (int y = 0; y < rows * fine; ++y) {
        for (int x = 0; x < columns * fine; ++x) {
            const Microfacet m =
                microfacet_at((y + 0.5) / (rows * fine), (x + 0.5) / (columns * fine), alpha);
            const double cosine = vec_dot(wo, m.normal);
            if (cosine <= 0) continue;
            const float3 wi = m.normal * float(2 * cosine) - wo;
            const double solid_angle = cell * m.solid_angle;
            if (wi.z <= 0) {
                expected.lost += g1 * cosine / wo.z * m.density * solid_angle;
                continue;
            }
            const Scatter scatter = lobes_evaluate(lobes, wo, wi);
            const double specular = (scatter.pdf - (1 - p) * wi.z / pi) / p;
            expected.cells[size_t(y / fine * columns + x / fine)] +=
                specular * 4 * cosine * solid_angle;
        }
    }
    return expected;
}

TEST(Sampling, SpecularSamplesFollowTheirDensity)
{
    const std::vector<Case> all = cases();
    const double level = sidak_level(int(all.size()));
    for (const Case& c : all) {
        SCOPED_TRACE(testing::Message() << "roughness " << c.roughness << " metallic " << c.metallic
                                        << " cosine " << c.cosine);
        const Lobes lobes = lobes_for(c);
        const float3 wo = direction_of(c);
        const double alpha = double(c.roughness) * c.roughness;
        Expected expected = expected_specular(lobes, wo, alpha);
        double sum = 0;
        for (double& cell : expected.cells) sum += cell;
        EXPECT_NEAR(sum + expected.lost, 1, 3e-3);

        std::vector<double> counts(rows * columns + 1);
        Uniform uniform(5);
        for (int k = 0; k < draws; ++k) {
            float2 u = uniform.pair();
            u.x *= lobes.specular_probability * 0.9999999f;
            const ScatterSample sample = lobes_sample(lobes, wo, u);
            if (sample.wi.z <= 0) {
                ++counts.back();
                continue;
            }
            const float3 h = vec_normalize(wo + sample.wi);
            const int y = clamped(place_of(h, alpha) * rows, rows);
            const int x = clamped(azimuth(h) * columns, columns);
            ++counts[size_t(y * columns + x)];
        }
        for (double& cell : expected.cells) cell *= draws;
        expected.cells.push_back(draws * (1 - sum));
        EXPECT_GT(chi_square_probability(expected.cells, counts), level);
    }
}

// All lobes together, over the directions they scatter to; wide lobes, so that bins of direction
// are smooth enough to integrate.
TEST(Sampling, ScatteredDirectionsFollowTheirDensity)
{
    std::vector<Case> all = cases();
    std::erase_if(all, [](const Case& c) { return c.roughness < 0.5f; });
    const double level = sidak_level(int(all.size()));
    constexpr int fine = 24;
    for (const Case& c : all) {
        SCOPED_TRACE(testing::Message() << "roughness " << c.roughness << " metallic " << c.metallic
                                        << " cosine " << c.cosine);
        const Lobes lobes = lobes_for(c);
        const float3 wo = direction_of(c);
        std::vector<double> expected(rows * columns), counts(rows * columns + 1);
        double sum = 0;
        for (int y = 0; y < rows * fine; ++y) {
            for (int x = 0; x < columns * fine; ++x) {
                const double z = (y + 0.5) / (rows * fine), r = std::sqrt(1 - z * z);
                const double phi = 2 * pi * ((x + 0.5) / (columns * fine) - 0.5);
                const float3 wi =
                    make_float3(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
                const double mass = lobes_evaluate(lobes, wo, wi).pdf * 2 * pi /
                                    (double(rows) * columns * fine * fine);
                expected[size_t(y / fine * columns + x / fine)] += mass * draws;
                sum += mass;
            }
        }
        EXPECT_LE(sum, 1.002);
        Uniform uniform(6);
        for (int k = 0; k < draws; ++k) {
            const ScatterSample sample = lobes_sample(lobes, wo, uniform.pair());
            const int y = clamped(double(sample.wi.z) * rows, rows);
            const int x = clamped(azimuth(sample.wi) * columns, columns);
            ++counts[sample.wi.z <= 0 ? counts.size() - 1 : size_t(y * columns + x)];
        }
        expected.push_back(std::max(0.0, draws * (1 - sum)));
        EXPECT_GT(chi_square_probability(expected, counts), level);
    }
}

TEST(Sampling, SamplesStateTheDensityThatEvaluationGives)
{
    Uniform uniform(7);
    for (const Case& c : cases()) {
        const Lobes lobes = lobes_for(c);
        const float3 wo = direction_of(c);
        for (int k = 0; k < 1000; ++k) {
            const ScatterSample sample = lobes_sample(lobes, wo, uniform.pair());
            const Scatter scatter = lobes_evaluate(lobes, wo, sample.wi);
            ASSERT_EQ(sample.pdf, scatter.pdf);
            ASSERT_NEAR(sample.weight.x * sample.pdf, scatter.value.x, 1e-5f * scatter.value.x);
        }
    }
}

TEST(Sampling, DiffuseDirectionsFollowTheCosine)
{
    std::vector<double> counts(rows * columns);
    const std::vector<double> expected(rows * columns, double(draws) / (rows * columns));
    Uniform uniform(8);
    for (int k = 0; k < draws; ++k) {
        const ScatterSample sample = diffuse_sample(make_float3(1, 1, 1), uniform.pair());
        const double disc = double(sample.wi.x) * sample.wi.x + double(sample.wi.y) * sample.wi.y;
        ++counts[size_t(clamped(disc * rows, rows) * columns +
                        clamped(azimuth(sample.wi) * columns, columns))];
        ASSERT_FLOAT_EQ(sample.pdf, diffuse_evaluate(make_float3(1, 1, 1), sample.wi).pdf);
        ASSERT_NEAR(vec_length(sample.wi), 1, 1e-6);
    }
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

TEST(Sampling, TrianglesAreCoveredEvenly)
{
    constexpr int size = 10;  // size * size small triangles of equal area
    std::vector<double> counts(size * size * 2);
    std::vector<double> expected(size * size * 2, 0.0);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x + y < size; ++x)
            for (int upper = 0; upper < (x + y + 1 < size ? 2 : 1); ++upper)
                expected[size_t(2 * (y * size + x) + upper)] = double(draws) / (size * size);
    Uniform uniform(9);
    for (int k = 0; k < draws; ++k) {
        const float2 w = triangle_sample(uniform.pair());
        ASSERT_TRUE(w.x >= 0 && w.y >= 0 && w.x + w.y <= 1.0000001f);
        const double x = double(w.x) * size, y = double(w.y) * size;
        const int upper = x - std::floor(x) + y - std::floor(y) > 1 ? 1 : 0;
        ++counts[size_t(2 * (clamped(y, size) * size + clamped(x, size)) + upper)];
    }
    EXPECT_GT(chi_square_probability(expected, counts), 1e-4);
}

}  // namespace
