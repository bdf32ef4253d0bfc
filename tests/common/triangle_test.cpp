// Laws of common/triangle.h: known hits, and no gap between triangles that share an edge.
#include "common/triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

const float3 corner0 = {0, 0, 0};
const float3 corner1 = {1, 0, 0};
const float3 corner2 = {0, 1, 0};

TriangleHit hit_from(float3 origin, float3 direction, float t_max = FLOAT_MAX)
{
    return triangle_intersect(triangle_ray(origin, direction), corner0, corner1, corner2, t_max);
}

float3 random_unit(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    const float3 v = {normal(random), normal(random), normal(random)};
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

TEST(Triangle, GivesDistanceAndWeights)
{
    const TriangleHit hit = hit_from({0.25f, 0.5f, 2.0f}, {0, 0, -1});
    EXPECT_TRUE(hit.is_hit);
    EXPECT_FLOAT_EQ(hit.t, 2.0f);
    EXPECT_FLOAT_EQ(hit.u, 0.25f);
    EXPECT_FLOAT_EQ(hit.v, 0.5f);
}

TEST(Triangle, CountsInUnitsOfTheDirection)
{
    EXPECT_FLOAT_EQ(hit_from({0.25f, 0.5f, 2.0f}, {0, 0, -4}).t, 0.5f);
}

TEST(Triangle, IsTwoSided)
{
    EXPECT_TRUE(hit_from({0.25f, 0.25f, 1}, {0, 0, -1}).is_hit);
    EXPECT_TRUE(hit_from({0.25f, 0.25f, -1}, {0, 0, 1}).is_hit);
}

TEST(Triangle, MissesOutsideBehindBeyondAndEdgeOn)
{
    EXPECT_FALSE(hit_from({0.75f, 0.75f, 1}, {0, 0, -1}).is_hit);
    EXPECT_FALSE(hit_from({0.25f, 0.25f, 1}, {0, 0, 1}).is_hit);
    EXPECT_FALSE(hit_from({0.25f, 0.25f, 1}, {0, 0, -1}, 0.5f).is_hit);
    EXPECT_FALSE(hit_from({-1, 0.25f, 0}, {1, 0, 0}).is_hit);
    EXPECT_FALSE(hit_from({0.25f, 0.25f, 0}, {0, 0, -1}).is_hit) << "the origin itself is no hit";
}

TEST(Triangle, MissesWithNumbersThatAreNone)
{
    EXPECT_FALSE(hit_from({NAN, 0.25f, 1}, {0, 0, -1}).is_hit);
    EXPECT_FALSE(hit_from({0.25f, 0.25f, 1}, {NAN, NAN, NAN}).is_hit);
    EXPECT_FALSE(hit_from({0.25f, 0.25f, 1}, {0, 0, 0}).is_hit);
}

// A closed and nearly flat fan of n triangles around a hub, seen from a random place at any
// distance: a ray at a point of a spoke, or at the hub itself, is stopped by at least one triangle.
TEST(Triangle, LetsNoRaySlipBetweenNeighbours)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    constexpr int n = 7;
    int leaks = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const float offset = trial % 3 == 0 ? 0.0f : (trial % 3 == 1 ? 1e3f : 1e5f);
        const float3 hub = {offset + uniform(random), offset * uniform(random), uniform(random)};
        float3 rim[n];
        for (int k = 0; k < n; ++k) {
            const float angle = 2 * PI * float(k) / float(n);
            const float radius = 0.5f + 10.0f * uniform(random);
            rim[k] = hub + make_float3(radius * std::cos(angle), radius * std::sin(angle),
                                       0.1f * (uniform(random) - 0.5f));
        }
        const float3 end = rim[trial % n];
        const float along = trial % 5 == 0 ? 0.0f : 0.9f * uniform(random);
        const float3 aim = hub + (end - hub) * along;
        float3 from = random_unit(random);
        from.z = (from.z < 0 ? -0.3f : 0.3f) + from.z;
        const float3 origin = aim + from * (1.0f + 30.0f * uniform(random));
        const TriangleRay ray = triangle_ray(origin, aim - origin);
        int stopped = 0;
        for (int k = 0; k < n; ++k)
            stopped += triangle_intersect(ray, hub, rim[k], rim[(k + 1) % n], FLOAT_MAX).is_hit;
        leaks += stopped == 0;
    }
    EXPECT_EQ(leaks, 0);
}

}  // namespace
