// Laws of the library's hashes and noises.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/texture_tool/library_functions.hpp"

namespace user_language {
namespace {

using Noise = std::function<float(float3)>;

struct Moments {
    double mean = 0.0, deviation = 0.0, low = 1.0e9, high = -1.0e9;
};

Moments moments(const Noise& noise, int count = 200000)
{
    Moments m;
    double squares = 0.0;
    for (int k = 0; k < count; ++k) {
        const double value = noise(scattered(k, 100.0f));
        m.mean += value / count;
        squares += value * value / count;
        m.low = std::min(m.low, value);
        m.high = std::max(m.high, value);
    }
    m.deviation = std::sqrt(squares - m.mean * m.mean);
    return m;
}

// The steepest slope seen over steps of 1/1000 that begin anywhere, and on lattice planes.
double steepest(const Noise& noise)
{
    double slope = 0.0;
    for (int k = 0; k < 100000; ++k) {
        float3 p = scattered(k, 20.0f);
        if (k % 3 == 1) p.x = std::floor(p.x) - 5.0e-4f;
        if (k % 3 == 2) p.y = std::floor(p.y) - 5.0e-4f;
        const float3 step = scattered(k + 500000, 1.0e-3f);
        const double run = length(step);
        if (run < 1.0e-4) continue;
        slope = std::max(slope, std::fabs(double(noise(p + step)) - noise(p)) / run);
    }
    return slope;
}

float of_plane(float (*noise)(float2), float3 p) { return noise(float2(p.x, p.y)); }

// What the same formulas give in Python's integers.
TEST(LibraryHash, HasKnownValues)
{
    EXPECT_EQ(hash_scramble(0u), 0u);
    EXPECT_EQ(hash_scramble(1u), 0x688990c0u);
    EXPECT_EQ(hash_scramble(2u), 0xd1132181u);
    EXPECT_EQ(hash_scramble(0xffffffffu), 0x6768824au);
    EXPECT_EQ(hash1(-5, 7u), hash_scramble(0xfffffffbu ^ hash_scramble(7u)));
    EXPECT_EQ(hash2(3, -7, 5u), 0x8d430413u);
    EXPECT_EQ(hash3(1, 2, 3, 4u), 0x5e1a4073u);
    EXPECT_EQ(hash3(-1000, 2, 77777, 9u), 0xa24d8a0eu);
    EXPECT_EQ(hash4(1, -2, 3, -4, 5u), 0x43369af1u);
}

TEST(LibraryHash, ScramblesOneToOne)
{
    for (int k = 0; k < 1000000; ++k) {
        const uint x = uint(k) * 2654435761u;
        uint y = hash_scramble(x);
        y ^= y >> 16;
        y *= 0x43021123u;
        y ^= y >> 15 ^ y >> 30;
        y *= 0x1d69e2a5u;
        y ^= y >> 16;
        ASSERT_EQ(y, x);
    }
}

TEST(LibraryHash, ChangesEachBitForHalfOfAllChangesOfAnother)
{
    constexpr int count = 20000;
    std::vector<int> flips(32 * 32, 0);
    for (int k = 0; k < count; ++k) {
        const uint x = uint(k) * 2654435761u + 12345u;
        for (int in = 0; in < 32; ++in) {
            const uint change = hash_scramble(x) ^ hash_scramble(x ^ (1u << in));
            for (int out = 0; out < 32; ++out) flips[in * 32 + out] += int(change >> out & 1u);
        }
    }
    const auto [low, high] = std::minmax_element(flips.begin(), flips.end());
    EXPECT_GT(double(*low) / count, 0.47);
    EXPECT_LT(double(*high) / count, 0.53);
}

// For each x and y the one nearest z with the sum of the origin.
TEST(LibraryHash, RepeatsSumsNoNearerThanItSays)
{
    const uint step = lattice_sum3(0, 0, 1);
    uint inverse = step;
    for (int k = 0; k < 5; ++k) inverse *= 2u - step * inverse;
    ASSERT_EQ(step * inverse, 1u);
    double nearest = 1.0e18;
    for (int y = 0; y <= 1700; ++y)
        for (int x = -1700; x <= 1700; ++x) {
            if (y == 0 && x <= 0) continue;
            const double z = int(0u - lattice_sum2(x, y) * inverse);
            nearest = std::min(nearest, double(x) * x + double(y) * y + z * z);
        }
    EXPECT_NEAR(std::sqrt(nearest), 1659.57, 0.01);
}

TEST(LibraryHash, FractionsFillTheUnitInterval)
{
    double sums[6] = {};
    constexpr int count = 100000;
    for (int k = 0; k < count; ++k) {
        const uint h = hash_scramble(uint(k) + 77u);
        const float3 three = hash_fractions3(h);
        const float2 two = hash_fractions2(h);
        const float all[6] = {hash_fraction(h), three.x, three.y, three.z, two.x, two.y};
        for (int c = 0; c < 6; ++c) {
            ASSERT_GE(all[c], 0.0f);
            ASSERT_LT(all[c], 1.0f);
            sums[c] += all[c];
        }
    }
    for (double sum : sums) EXPECT_NEAR(sum / count, 0.5, 0.005);
    EXPECT_EQ(hash_fraction(0u), 0.0f);
    EXPECT_LT(hash_fraction(0xffffffffu), 1.0f);
}

// The function `grad` of "Improving Noise", and its noise in double.
double grad(int hash, double x, double y, double z)
{
    const int h = hash & 15;
    const double u = h < 8 ? x : y;
    const double v = h < 4 ? y : h == 12 || h == 14 ? x : z;
    return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}
double improved_noise(float3 p, uint seed)
{
    const double whole[3] = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const double rest[3] = {p.x - whole[0], p.y - whole[1], p.z - whole[2]};
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        int c[3];
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            c[axis] = corner >> axis & 1;
            const double t = rest[axis];
            const double fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
            weight *= c[axis] == 1 ? fade : 1.0 - fade;
        }
        const uint h =
            hash3(int(whole[0]) + c[0], int(whole[1]) + c[1], int(whole[2]) + c[2], seed);
        sum += weight * grad(int(h & 15u), rest[0] - c[0], rest[1] - c[1], rest[2] - c[2]);
    }
    return 0.9649 * sum;
}

TEST(LibraryPerlin, IsImprovedNoise)
{
    for (int k = 0; k < 100000; ++k) {
        const float3 p = scattered(k, 50.0f);
        ASSERT_NEAR(perlin3_seeded(p, uint(k % 5)), improved_noise(p, uint(k % 5)), 2.0e-6);
    }
}

TEST(LibraryPerlin, IsZeroAtLatticePoints)
{
    for (int k = 0; k < 10000; ++k) {
        const float3 p = floor(scattered(k, 3000.0f));
        ASSERT_EQ(perlin3(p), 0.0f);
        ASSERT_EQ(perlin2(float2(p.x, p.y)), 0.0f);
    }
}

// At each place the gradients that give most, one corner at a time.
TEST(LibraryPerlin, CannotLeaveItsRange)
{
    double plane = 0.0;
    double space = 0.0;
    for (int k = 0; k < 400000; ++k) {
        const float3 p = k == 0 ? float3(0.5f) : scattered(k, 0.5f) + float3(0.5f);
        double sum = 0.0;
        double plane_sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const float c[3] = {float(corner & 1), float(corner >> 1 & 1), float(corner >> 2)};
            double d[3] = {std::fabs(p.x - c[0]), std::fabs(p.y - c[1]), std::fabs(p.z - c[2])};
            double w[3];
            for (int axis = 0; axis < 3; ++axis) w[axis] = noise_fade(float(1.0 - d[axis]));
            const double reach = std::max(std::max(d[0], d[1]), (d[0] + d[1]) * std::sqrt(0.5));
            if (corner < 4) plane_sum += w[0] * w[1] * reach;
            sum += w[0] * w[1] * w[2] * (d[0] + d[1] + d[2] - std::min({d[0], d[1], d[2]}));
        }
        plane = std::max(plane, std::sqrt(2.0) * plane_sum);
        space = std::max(space, 0.9649 * sum);
    }
    EXPECT_LE(plane, 1.0 + 1.0e-6);
    EXPECT_LE(space, 1.0 + 1.0e-6);
    EXPECT_GT(plane, 0.99);
    EXPECT_GT(space, 0.99);
}

TEST(LibraryPerlin, IsTheSameAroundPointsOfEqualSums)
{
    const uint inverse = [] {
        const uint step = lattice_sum3(0, 0, 1);
        uint x = step;
        for (int k = 0; k < 5; ++k) x *= 2u - step * x;
        return x;
    }();
    int found = 0;
    for (int x = 1; x < 3000 && found < 3; ++x)
        for (int y = -3000; y < 3000; ++y) {
            const int z = int(0u - lattice_sum2(x, y) * inverse);
            if (std::abs(z) > 1500) continue;
            ++found;
            for (int k = 0; k < 200; ++k) {
                const float3 p = scattered(k, 4.0f);
                const float3 moved = floor(p * 256.0f) * (1.0f / 256.0f);  // exact when shifted
                const float3 far = moved + float3(float(x), float(y), float(z));
                ASSERT_EQ(perlin3(moved), perlin3(far));
            }
            break;
        }
    EXPECT_EQ(found, 3);
}

TEST(LibraryNoise, HasItsMeanRangeAndNoJumps)
{
    struct Case {
        const char* name;
        Noise noise;
        double deviation, slope;
    };
    const Case cases[] = {
        {"perlin3", [](float3 p) { return perlin3(p); }, 0.260, 4.0},
        {"perlin2", [](float3 p) { return of_plane(perlin2, p); }, 0.305, 4.0},
        {"simplex3", [](float3 p) { return simplex3(p); }, 0.393, 9.0},
        {"simplex2", [](float3 p) { return of_plane(simplex2, p); }, 0.540, 9.0},
        {"fbm3", [](float3 p) { return fbm3(p, 6.0f, 2.0f, 0.5f); }, 0.153, 12.0},
    };
    for (const Case& c : cases) {
        const Moments m = moments(c.noise);
        EXPECT_NEAR(m.mean, 0.0, 0.004) << c.name;
        EXPECT_NEAR(m.deviation, c.deviation, 0.005) << c.name;
        EXPECT_GE(m.low, -1.0) << c.name;
        EXPECT_LE(m.high, 1.0) << c.name;
        const double slope = steepest(c.noise);
        EXPECT_LT(slope, c.slope) << c.name;
        EXPECT_GT(slope, 0.5) << c.name;
    }
}

TEST(LibraryNoise, PatternsOfOtherSeedsAreStrangers)
{
    double product = 0.0;
    for (int k = 0; k < 200000; ++k) {
        const float3 p = scattered(k, 100.0f);
        product += perlin3_seeded(p, 1u) * perlin3_seeded(p, 2u) / 200000.0;
    }
    EXPECT_NEAR(product, 0.0, 0.26 * 0.26 * 0.02);
}

TEST(LibrarySimplex, IsZeroAtItsCorners)
{
    for (int k = 0; k < 10000; ++k) {
        const float3 cell = floor(scattered(k, 50.0f));
        const float unskew = (cell.x + cell.y + cell.z) / 6.0f;
        ASSERT_NEAR(simplex3(cell - float3(unskew)), 0.0f, 1.0e-4f);
        const float unskew2 = (cell.x + cell.y) * 0.211324865f;
        ASSERT_NEAR(simplex2(float2(cell.x - unskew2, cell.y - unskew2)), 0.0f, 3.0e-4f);
    }
}

TEST(LibraryFractal, AddsOctavesByTheirShares)
{
    for (int k = 0; k < 20000; ++k) {
        const float3 p = scattered(k, 10.0f);
        ASSERT_NEAR(fbm3(p, 1.0f, 2.0f, 0.5f), perlin3(p), 1.0e-6f);
        ASSERT_NEAR(fbm3_seeded(p, 2.0f, 2.0f, 0.5f, 7u), noise3_of_two(p, 7u), 1.0e-6f);
        ASSERT_NEAR(fbm3_seeded(p, 3.0f, 2.0f, 0.5f, 7u), noise3_of_three(p, 7u), 1.0e-6f);
        ASSERT_NEAR(fbm3_seeded(p, 4.0f, 2.0f, 0.5f, 7u), noise3_of_four(p, 7u), 1.0e-6f);
        ASSERT_EQ(fbm3(p, 0.0f, 2.0f, 0.5f), 0.0f);
        ASSERT_EQ(fbm3(p, 8.0f, 2.0f, 0.5f), fbm3(p, 20.0f, 2.0f, 0.5f));
        // The last octave fades in, neither early nor with a jump.
        ASSERT_NEAR(fbm3(p, 4.0f, 2.1f, 0.6f), fbm3(p, 4.001f, 2.1f, 0.6f), 5.0e-4f);
        const float t = turbulence3(p, 5.5f, 2.0f, 0.5f);
        ASSERT_GE(t, 0.0f);
        ASSERT_LE(t, 1.0f);
        ASSERT_NEAR(turbulence3(p, 1.0f, 2.0f, 0.5f), std::fabs(perlin3(p)), 1.0e-6f);
    }
}

TEST(LibraryGabor, HasAThirdAsDeviationAtEveryFrequency)
{
    for (float frequency : {0.0f, 0.4f, 1.0f, 4.0f})
        for (float spread : {0.0f, 1.0f}) {
            const Moments m = moments(
                [=](float3 p) { return gabor2(float2(p.x, p.y), frequency, 0.1f, spread); }, 15000);
            EXPECT_NEAR(m.mean, 0.0, 0.01) << frequency;
            EXPECT_NEAR(m.deviation, 1.0 / 3.0, 0.015) << frequency << " " << spread;
        }
}

// Half a wave along the waves' direction turns the sign; across, nothing changes so fast.
TEST(LibraryGabor, WavesInItsDirection)
{
    const float turn = 0.08f;
    const float2 along(std::cos(6.2831853f * turn), std::sin(6.2831853f * turn));
    const float half_wave = 0.5f / 3.0f;
    double along_product = 0.0;
    double across_product = 0.0;
    for (int k = 0; k < 15000; ++k) {
        const float3 q = scattered(k, 100.0f);
        const float2 p(q.x, q.y);
        const float value = gabor2(p, 3.0f, turn, 0.0f);
        along_product += value * gabor2(p + along * half_wave, 3.0f, turn, 0.0f);
        const float2 across(-along.y, along.x);
        across_product += value * gabor2(p + across * half_wave, 3.0f, turn, 0.0f);
    }
    EXPECT_LT(along_product / 15000.0, -0.08);
    EXPECT_GT(across_product / 15000.0, 0.08);
}

TEST(LibraryGabor, DrawsImpulsesByPoissonsLaw)
{
    double mean = 0.0;
    int counts[9] = {};
    for (int k = 0; k < 100000; ++k) {
        const int count = gabor_impulses((float(k) + 0.5f) / 100000.0f);
        ASSERT_GE(count, 0);
        ASSERT_LE(count, 8);
        ++counts[count];
        mean += count / 100000.0;
    }
    double chance = std::exp(-3.0);
    for (int n = 0; n < 8; ++n) {
        EXPECT_NEAR(counts[n] / 100000.0, chance, 2.0e-5) << n;
        chance *= 3.0 / (n + 1);
    }
    EXPECT_NEAR(mean, 3.0, 0.01);
}

}  // namespace
}  // namespace user_language
