// Laws and known answers of the arithmetic that works in any precision.
#include "platform.h"

#include "tests/common/sample_floats.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::vector<float3> random_directions(int count)
{
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    std::vector<float3> directions;
    while (static_cast<int>(directions.size()) < count) {
        directions.push_back(
            vec_normalize(make_float3(normal(random), normal(random), normal(random))));
    }
    for (float sign : {-1.0f, 1.0f}) {
        directions.push_back(make_float3(sign, 0.0f, 0.0f));
        directions.push_back(make_float3(0.0f, sign, 0.0f));
        directions.push_back(make_float3(0.0f, 0.0f, sign));
        directions.push_back(vec_normalize(make_float3(1e-6f, sign * 1e-4f, -1.0f)));
    }
    return directions;
}

TEST(Math, MinimumAndMaximumIgnoreNan)
{
    for (float a : special_floats) {
        for (float b : special_floats) {
            const float low = math_min(a, b);
            const float high = math_max(a, b);
            EXPECT_TRUE(low == std::fmin(a, b) || (std::isnan(a) && std::isnan(b))) << a << b;
            EXPECT_TRUE(high == std::fmax(a, b) || (std::isnan(a) && std::isnan(b))) << a << b;
        }
    }
}

TEST(Math, ClampTakesNanToItsLowerEnd)
{
    EXPECT_EQ(math_clamp(nan, -1.0f, 2.0f), -1.0f);
    EXPECT_EQ(math_clamp(-infinity, -1.0f, 2.0f), -1.0f);
    EXPECT_EQ(math_clamp(infinity, -1.0f, 2.0f), 2.0f);
    EXPECT_EQ(math_clamp(0.25f, -1.0f, 2.0f), 0.25f);
}

TEST(Math, ConversionToIntSaturates)
{
    EXPECT_EQ(float_to_int(nan), 0);
    EXPECT_EQ(float_to_int(infinity), 2147483647);
    EXPECT_EQ(float_to_int(-infinity), -2147483647 - 1);
    EXPECT_EQ(float_to_int(2147483648.0f), 2147483647);
    EXPECT_EQ(float_to_int(-2147483648.0f), -2147483647 - 1);
    EXPECT_EQ(float_to_int(2147483520.0f), 2147483520);
    EXPECT_EQ(float_to_int(-1.99f), -1);
    EXPECT_EQ(float_to_int(1.99f), 1);
}

TEST(Math, LerpHitsBothEnds)
{
    const float3 a = make_float3(1e8f, -3.0f, 0.1f);
    const float3 b = make_float3(1.0f, 7.0f, 0.7f);
    EXPECT_EQ(vec_lerp(a, b, 0.0f).z, a.z);
    EXPECT_EQ(vec_lerp(a, b, 1.0f).x, b.x);
    EXPECT_EQ(math_lerp(2.0f, 4.0f, 0.5f), 3.0f);
}

TEST(Math, CrossProductIsOrthogonalAndRightHanded)
{
    const float3 z = vec_cross(make_float3(1.0f, 0.0f, 0.0f), make_float3(0.0f, 1.0f, 0.0f));
    EXPECT_EQ(z.z, 1.0f);
    const std::vector<float3> directions = random_directions(100);
    for (std::size_t i = 1; i < directions.size(); ++i) {
        const float3 c = vec_cross(directions[i - 1], directions[i]);
        EXPECT_NEAR(vec_dot(c, directions[i]), 0.0f, 3e-7f);
    }
}

TEST(Math, ReflectionMirrorsAboutTheNormal)
{
    const float3 n = make_float3(0.0f, 0.0f, 1.0f);
    const float3 r = vec_reflect(make_float3(0.6f, 0.0f, 0.8f), n);
    EXPECT_NEAR(r.x, -0.6f, 1e-7f);
    EXPECT_NEAR(r.z, 0.8f, 1e-7f);
}

TEST(Math, LuminanceOfWhiteIsOne)
{
    EXPECT_FLOAT_EQ(vec_luminance(make_float3(1.0f, 1.0f, 1.0f)), 1.0f);
    EXPECT_EQ(vec_max_component(make_float3(-3.0f, 2.0f, 1.0f)), 2.0f);
    EXPECT_EQ(vec_min_component(make_float3(-3.0f, 2.0f, 1.0f)), -3.0f);
}

TEST(Math, FiniteVectorsAreToldFromOthers)
{
    EXPECT_TRUE(vec_is_finite(make_float3(FLOAT_MAX, -FLOAT_MAX, 0.0f)));
    for (float bad : {nan, infinity, -infinity}) {
        EXPECT_FALSE(vec_is_finite(make_float3(bad, 0.0f, 0.0f)));
        EXPECT_FALSE(vec_is_finite(make_float3(0.0f, bad, 0.0f)));
        EXPECT_FALSE(vec_is_finite(make_float3(0.0f, 0.0f, bad)));
    }
}

TEST(Math, NormalizingZeroGivesZero)
{
    EXPECT_EQ(vec_length(vec_normalize(make_float3(0.0f, 0.0f, 0.0f))), 0.0f);
    EXPECT_NEAR(vec_length(vec_normalize(make_float3(3e-15f, 4e-15f, 1e-15f))), 1.0f, 2e-7f);
}

TEST(Math, FramesAreOrthonormalAndRightHanded)
{
    for (const float3& n : random_directions(10000)) {
        const float3 t = frame_tangent(n);
        const float3 b = frame_bitangent(n);
        ASSERT_NEAR(vec_length(t), 1.0f, 1e-6f);
        ASSERT_NEAR(vec_length(b), 1.0f, 1e-6f);
        ASSERT_NEAR(vec_dot(t, b), 0.0f, 1e-6f);
        ASSERT_NEAR(vec_dot(t, n), 0.0f, 1e-6f);
        ASSERT_NEAR(vec_dot(vec_cross(t, b), n), 1.0f, 1e-6f);
    }
}

TEST(Math, PackedNormalsReturn)
{
    float worst = 0.0f;
    for (const float3& n : random_directions(200000)) {
        const float3 back = normal_unpack(normal_pack(n));
        ASSERT_NEAR(vec_length(back), 1.0f, 2e-7f);
        worst = math_max(worst, vec_length(back - n));
    }
    EXPECT_LT(worst, 7e-5f);
    for (float sign : {-1.0f, 1.0f}) {
        EXPECT_EQ(normal_unpack(normal_pack(make_float3(sign, 0.0f, 0.0f))).x, sign);
        EXPECT_EQ(normal_unpack(normal_pack(make_float3(0.0f, sign, 0.0f))).y, sign);
        EXPECT_EQ(normal_unpack(normal_pack(make_float3(0.0f, 0.0f, sign))).z, sign);
    }
    EXPECT_EQ(normal_unpack(normal_pack(make_float3(0.0f, 0.0f, 0.0f))).z, 1.0f);
    EXPECT_TRUE(vec_is_finite(normal_unpack(normal_pack(make_float3(nan, infinity, -nan)))));
}

}  // namespace
