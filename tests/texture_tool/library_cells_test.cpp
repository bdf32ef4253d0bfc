// Laws of the library's cellular noises and colour ramps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/texture_tool/library_functions.hpp"

namespace user_language {
namespace {

struct Nearest {
    double f1 = 1.0e9, f2 = 1.0e9;
    uint cell = 0;
};

double length_by(int metric, double x, double y, double z)
{
    if (metric == 1) return std::fabs(x) + std::fabs(y) + std::fabs(z);
    if (metric == 2) return std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
    return std::sqrt(x * x + y * y + z * z);
}

// All points within four cells, in double.
Nearest search(float3 p, double jitter, int metric, uint seed, bool is_plane)
{
    Nearest nearest;
    const int reach = is_plane ? 0 : 4;
    const int cx = int(std::floor(p.x));
    const int cy = int(std::floor(p.y));
    const int cz = int(std::floor(p.z));
    for (int k = -reach; k <= reach; ++k)
        for (int j = -4; j <= 4; ++j)
            for (int i = -4; i <= 4; ++i) {
                const uint h =
                    is_plane ? hash2(cx + i, cy + j, seed) : hash3(cx + i, cy + j, cz + k, seed);
                const float2 two = hash_fractions2(h);
                const float3 r = is_plane ? float3(two.x, two.y, 0.5f) : hash_fractions3(h);
                const double x = cx + i + 0.5 + jitter * (r.x - 0.5) - p.x;
                const double y = cy + j + 0.5 + jitter * (r.y - 0.5) - p.y;
                const double z = is_plane ? 0.0 : cz + k + 0.5 + jitter * (r.z - 0.5) - p.z;
                const double d = length_by(metric, x, y, z);
                if (d < nearest.f1) {
                    nearest.f2 = nearest.f1;
                    nearest.f1 = d;
                    nearest.cell = h;
                } else if (d < nearest.f2) {
                    nearest.f2 = d;
                }
            }
    return nearest;
}

TEST(LibraryWorley, FindsTheNearestPointsOfAll)
{
    for (int k = 0; k < 4000; ++k) {
        const float3 p = scattered(k, 30.0f);
        for (float jitter : {0.0f, 0.5f, 0.87f, 1.0f}) {
            const Nearest known = search(p, jitter, 0, 0u, false);
            const float2 found = worley3(p, jitter);
            ASSERT_NEAR(found.x, known.f1, 1.0e-5) << jitter;
            if (jitter <= 0.87f) {
                ASSERT_NEAR(found.y, known.f2, 1.0e-5) << jitter;
            }
        }
    }
}

TEST(LibraryWorley, FindsThemInThePlane)
{
    for (int k = 0; k < 20000; ++k) {
        const float3 p = scattered(k, 30.0f);
        for (float jitter : {0.0f, 0.92f, 1.0f}) {
            const Nearest known = search(p, jitter, 0, 3u, true);
            const float2 found = worley2_seeded(float2(p.x, p.y), jitter, 3u);
            ASSERT_NEAR(found.x, known.f1, 1.0e-5) << jitter;
            if (jitter <= 0.92f) {
                ASSERT_NEAR(found.y, known.f2, 1.0e-5) << jitter;
            }
        }
    }
}

TEST(LibraryWorley, KnowsOtherMetrics)
{
    for (int k = 0; k < 2000; ++k) {
        const float3 p = scattered(k, 30.0f);
        ASSERT_NEAR(worley3_metric(p, 0.5f, 1, 5u).x, search(p, 0.5, 1, 5u, false).f1, 1.0e-5);
        ASSERT_NEAR(worley3_metric(p, 1.0f, 2, 5u).x, search(p, 1.0, 2, 5u, false).f1, 1.0e-5);
        ASSERT_NEAR(worley3_metric(p, 0.87f, 0, 5u).y, search(p, 0.87, 0, 5u, false).f2, 1.0e-5);
    }
}

// The proof, over places p relative to the nearest corner: however the points lie in their cells,
// the nearest (second nearest) of the cells searched is no farther than the first that is not.
double margin(double jitter, int metric, int rank, int axes)
{
    const double h = 0.5 * jitter;
    double smallest = 1.0e9;
    constexpr int steps = 20;
    const int last = axes == 3 ? steps : 0;
    for (int a = 0; a <= steps; ++a)
        for (int b = 0; b <= steps; ++b)
            for (int c = 0; c <= last; ++c) {
                const double d[3] = {0.5 * a / steps, 0.5 * b / steps, 0.5 * c / steps};
                std::vector<double> worst;
                for (int cell = 0; cell < (axes == 3 ? 64 : 16); ++cell) {
                    double far[3] = {};
                    for (int axis = 0; axis < axes; ++axis)
                        far[axis] = std::fabs((cell >> 2 * axis & 3) - 1.5 - d[axis]) + h;
                    worst.push_back(length_by(metric, far[0], far[1], far[2]));
                }
                std::nth_element(worst.begin(), worst.begin() + rank - 1, worst.end());
                const double unseen = 2.5 - h - std::max({d[0], d[1], d[2]});
                smallest = std::min(smallest, unseen - worst[rank - 1]);
            }
    return smallest;
}

TEST(LibraryWorley, SearchesFarEnough)
{
    EXPECT_GE(margin(1.0, 0, 1, 3), -1.0e-12);
    EXPECT_GE(margin(0.87, 0, 2, 3), 0.0);
    EXPECT_LT(margin(0.89, 0, 2, 3), 0.0);
    EXPECT_GE(margin(1.0, 0, 1, 2), 0.0);
    EXPECT_GE(margin(0.92, 0, 2, 2), 0.0);
    EXPECT_LT(margin(0.94, 0, 2, 2), 0.0);
    EXPECT_GE(margin(0.5, 1, 1, 3), -1.0e-12);
    EXPECT_GE(margin(1.0, 2, 1, 3), -1.0e-12);
}

TEST(LibraryVoronoi, NamesTheCellOfTheNearestPoint)
{
    for (int k = 0; k < 4000; ++k) {
        const float3 p = scattered(k, 30.0f);
        const Nearest space = search(p, 1.0, 0, 0u, false);
        if (space.f2 - space.f1 > 1.0e-5) {
            ASSERT_EQ(voronoi3_cell(p, 1.0f), space.cell);
        }
        const Nearest plane = search(p, 1.0, 0, 0u, true);
        if (plane.f2 - plane.f1 > 1.0e-5) {
            ASSERT_EQ(voronoi2_cell(float2(p.x, p.y), 1.0f), plane.cell);
        }
    }
}

// Going from p to the border by that distance, the two nearest points are equally far: F2 - F1
// falls to no more than what moving so far can leave.
TEST(LibraryVoronoi, BorderIsWhereTheNearestChanges)
{
    int crossed = 0;
    for (int k = 0; k < 4000; ++k) {
        const float3 q = scattered(k, 30.0f);
        const float2 p(q.x, q.y);
        const float border = voronoi2_border(p, 0.9f, 0u);
        ASSERT_GE(border, 0.0f);
        if (border > 0.05f) continue;
        const uint own = voronoi2_cell(p, 0.9f);
        bool changes = false;
        bool changes_early = false;
        for (int turn = 0; turn < 64; ++turn) {
            const float2 ray(std::cos(turn * 0.0981748f), std::sin(turn * 0.0981748f));
            changes |= voronoi2_cell(p + ray * (1.02f * border + 1.0e-4f), 0.9f) != own;
            changes_early |= voronoi2_cell(p + ray * (0.98f * border - 1.0e-4f), 0.9f) != own;
        }
        EXPECT_TRUE(changes);
        crossed += changes && !changes_early ? 1 : 0;
    }
    EXPECT_GT(crossed, 300);
}

const float3 colors[] = {float3(0.1f, 0.2f, 0.3f), float3(0.9f, 0.1f, 0.5f),
                         float3(0.4f, 0.8f, 0.0f)};
const float positions[] = {0.2f, 0.5f, 0.8f};

void expect_color(float3 a, float3 b, float tolerance = 1.0e-6f)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(LibraryRamp, HasItsColorsAtItsPositions)
{
    for (const auto ramp : {ramp_constant3, ramp_linear3, ramp_smooth3}) {
        for (int k = 0; k < 3; ++k)
            expect_color(ramp(positions[k], colors, positions, 3), colors[k], 0.0f);
        expect_color(ramp(-5.0f, colors, positions, 3), colors[0], 0.0f);
        expect_color(ramp(5.0f, colors, positions, 3), colors[2], 0.0f);
        expect_color(ramp(0.3f, colors, positions, 1), colors[0], 0.0f);
    }
    expect_color(ramp_constant3(0.49f, colors, positions, 3), colors[0]);
    expect_color(ramp_linear3(0.35f, colors, positions, 3), (colors[0] + colors[1]) * 0.5f);
    expect_color(ramp_smooth3(0.35f, colors, positions, 3), (colors[0] + colors[1]) * 0.5f);
    const float third = 1.0f / 3.0f;
    const float eased = third * third * (3.0f - 2.0f * third);
    expect_color(ramp_linear3(0.6f, colors, positions, 3),
                 colors[1] + (colors[2] - colors[1]) * third);
    expect_color(ramp_smooth3(0.6f, colors, positions, 3),
                 colors[1] + (colors[2] - colors[1]) * eased);
}

TEST(LibraryRamp, JumpsWherePositionsAreEqual)
{
    const float equal[] = {0.5f, 0.5f, 0.9f};
    for (const auto ramp : {ramp_constant3, ramp_linear3, ramp_smooth3}) {
        expect_color(ramp(0.4999f, colors, equal, 3), colors[0], 1.0e-6f);
        expect_color(ramp(0.501f, colors, equal, 3), colors[1], 5.0e-3f);
    }
}

}  // namespace
}  // namespace user_language
