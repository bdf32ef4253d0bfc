// Laws of common/triangle.h: known hits, and no gap between triangles that share an edge.
#include "common/surface.h"
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

// A random place and orientation for a triangle given in its own plane.
WorldTriangle placed(const float2 (&flat)[3], float offset, std::mt19937& random)
{
    const float3 normal = random_unit(random);
    const float3 x = frame_tangent(normal);
    const float3 y = frame_bitangent(normal);
    const float3 origin = random_unit(random) * offset;
    float3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = origin + x * flat[k].x + y * flat[k].y;
    WorldTriangle t;
    t.corner = corners[0];
    t.edge1 = corners[1] - corners[0];
    t.edge2 = corners[2] - corners[0];
    t.magnitude = 0;
    for (const float3& corner : corners)
        t.magnitude = std::max(t.magnitude, vec_max_component(vec_abs(corner)));
    return t;
}

// Rays that meet the triangle, then leave it as evaluate_surface lets them; how many meet it again.
int hits_of_what_was_left(const WorldTriangle& t, int rays, std::mt19937& random)
{
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const float3 a = t.corner, b = t.corner + t.edge1, c = t.corner + t.edge2;
    const float3 cross = vec_cross(t.edge1, t.edge2);
    const float3 normal = cross * (1.0f / vec_length(cross));
    int again = 0;
    for (int k = 0; k < rays; ++k) {
        const float u = uniform(random), v = uniform(random) * (1 - u);
        const float3 origin =
            a + t.edge1 * u + t.edge2 * v + random_unit(random) * (t.magnitude * uniform(random));
        const float3 target = a + t.edge1 * v + t.edge2 * u;
        const float3 direction = vec_normalize(target - origin);
        const float2 weights = triangle_barycentrics(t, origin, direction);
        const float3 point = a + t.edge1 * weights.x + t.edge2 * weights.y;
        float3 away = random_unit(random);
        if (vec_dot(away, normal) < 0) away = -away;
        const float3 start = offset_origin(point, normal, surface_error(t.magnitude), away);
        again += triangle_intersect(triangle_ray(start, away), a, b, c, FLOAT_MAX).is_hit;
    }
    return again;
}

// Squares, long strips as floors are made of, and needles, near the origin and far from it.
TEST(Triangle, IsNotMetAgainByRaysThatLeaveIt)
{
    const float2 shapes[][3] = {
        {{0, 0}, {1, 0}, {0, 1}},     {{0, 0}, {40, 0}, {40, 0.4f}},
        {{0, 0.4f}, {0, 0}, {40, 0}}, {{6000, 4}, {0, 0}, {6000, 0}},
        {{-1, 0}, {1, 0}, {0, 3000}}, {{-500, 0}, {500, 0}, {0, 20}},
    };
    std::mt19937 random(11);
    for (const auto& shape : shapes) {
        for (const float offset : {0.0f, 1.0f, 1e4f}) {
            int again = 0;
            for (int k = 0; k < 40; ++k)
                again += hits_of_what_was_left(placed(shape, offset, random), 500, random);
            EXPECT_EQ(again, 0) << shape[0].x << " " << shape[1].x << " " << shape[2].x << " at "
                                << offset;
        }
    }
}

}  // namespace
