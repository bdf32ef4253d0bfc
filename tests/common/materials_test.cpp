// Laws of the metallic-roughness surface: it gives back no more light than it receives, what it
// must give back it does, and light goes both ways alike.
#include "platform.h"

#include "common/materials/metallic_roughness.h"
#include "common/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

constexpr float roughnesses[] = {0,    0.009f, 0.01f, 0.05f, 0.1f, 0.2f, 0.3f,
                                 0.4f, 0.5f,   0.6f,  0.7f,  0.8f, 0.9f, 1};
constexpr float cosines[] = {0.02f, 0.1f, 0.25f, 0.5f, 0.75f, 0.95f, 1};

Surface surface_of(float base, float metallic, float roughness, float f0 = 0.04f, float f90 = 1)
{
    Surface surface;
    surface.base_color = make_float3(base, base, base);
    surface.metallic = metallic;
    surface.roughness = roughness;
    surface.dielectric_f0 = make_float3(f0, f0, f0);
    surface.dielectric_f90 = f90;
    return surface;
}

// What albedos may miss by: the table that balances the lobes is linear between its entries.
constexpr double tolerance = 0.005;

// Share of the light from wo that is scattered, by the surface's own samples.
double albedo(const Surface& surface, float cosine, int count = 1 << 14)
{
    const float3 wo = make_float3(std::sqrt(1 - cosine * cosine), 0, cosine);
    const Lobes lobes = lobes_of(surface, cosine);
    double sum = 0;
    for (unsigned k = 0; k < unsigned(count); ++k) {
        const SampleKey key = {k, 12345u};
        const ScatterSample sample = lobes_sample(lobes, wo, sample_pair(key, 3));
        sum += sample.wi.z > 0 ? double(sample.weight.x) : 0.0;
    }
    return sum / count;
}

TEST(Materials, WhiteMetalReflectsAll)
{
    for (const float roughness : roughnesses)
        for (const float cosine : cosines)
            EXPECT_NEAR(albedo(surface_of(1, 1, roughness), cosine), 1, tolerance)
                << "roughness " << roughness << " cosine " << cosine;
}

TEST(Materials, WhiteWithoutSpecularIsLambert)
{
    for (const float roughness : roughnesses)
        for (const float cosine : cosines)
            EXPECT_NEAR(albedo(surface_of(1, 0, roughness, 0, 0), cosine), 1, 1e-6);
}

TEST(Materials, WhiteDielectricReflectsAll)
{
    for (const float roughness : roughnesses)
        for (const float cosine : cosines)
            EXPECT_NEAR(albedo(surface_of(1, 0, roughness), cosine), 1, tolerance)
                << "roughness " << roughness << " cosine " << cosine;
}

TEST(Materials, NothingReflectsMoreThanItReceives)
{
    for (const float roughness : roughnesses) {
        for (const float cosine : cosines) {
            for (const float metallic : {0.0f, 0.5f, 1.0f}) {
                for (const float base : {0.0f, 0.5f, 1.0f}) {
                    for (const float f0 : {0.0f, 0.02f, 0.17f, 1.0f}) {
                        for (const float f90 : {0.0f, 0.5f, 1.0f}) {
                            if (f0 > f90) continue;  // the specular factor scales both
                            ASSERT_LE(
                                albedo(surface_of(base, metallic, roughness, f0, f90), cosine),
                                1 + tolerance)
                                << "roughness " << roughness << " cosine " << cosine << " metallic "
                                << metallic << " base " << base << " f0 " << f0 << " f90 " << f90;
                        }
                    }
                }
            }
        }
    }
}

TEST(Materials, LightGoesBothWaysAlike)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int k = 0; k < 20000; ++k) {
        Surface surface = surface_of(0, uniform(random), 0.02f + 0.98f * uniform(random),
                                     0.2f * uniform(random), uniform(random));
        surface.base_color = make_float3(uniform(random), uniform(random), uniform(random));
        const auto direction = [&] {
            const float z = 0.01f + 0.99f * uniform(random), r = std::sqrt(1 - z * z);
            const float phi = 6.2831853f * uniform(random);
            return make_float3(r * std::cos(phi), r * std::sin(phi), z);
        };
        const float3 wo = direction(), wi = direction();
        const float there = lobes_evaluate(lobes_of(surface, wo.z), wo, wi).value.y / wi.z;
        const float back = lobes_evaluate(lobes_of(surface, wi.z), wi, wo).value.y / wo.z;
        ASSERT_NEAR(there, back, 2e-5f * there) << "roughness " << surface.roughness;
    }
}

}  // namespace
