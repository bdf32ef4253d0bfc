// Accuracy against the C library's double, special values of C99, and the same bits from a
// vectorised compile as from a plain one.
#include "platform.h"

#include "tests/common/function_loops.hpp"
#include "tests/common/sample_floats.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double wrong = 1e9;

bool is_same(float a, float b)
{
    return as_uint(a) == as_uint(b) || (std::isnan(a) && std::isnan(b));
}

// The distance in units of the last place of the exact value; a wrong class or sign is far off.
double ulp_error(float value, double exact)
{
    const float rounded = static_cast<float>(exact);
    if (!std::isfinite(rounded) || exact == 0.0) {
        const bool is_next = std::isfinite(exact) && std::abs(value) == FLOAT_MAX;
        return is_same(value, rounded) ? 0.0 : is_next ? 1.0 : wrong;
    }
    if (!std::isfinite(value)) {
        return std::abs(rounded) == FLOAT_MAX ? 1.0 : wrong;
    }
    if (value != 0.0f && std::signbit(value) != std::signbit(rounded)) {
        return wrong;
    }
    const double ulp = std::ldexp(1.0, std::max(std::ilogb(exact) - 23, -149));
    return std::abs(value - exact) / ulp;
}

// A double-accurate sin(pi x), cos(pi x) of a float.
double exact_sinpi(double x)
{
    const double r = std::remainder(x, 2.0);
    const double folded = std::abs(r) > 0.5 ? std::copysign(1.0, r) - r : r;
    const double value = std::isfinite(x) ? std::sin(M_PI * folded) : nan;
    return value == 0.0 ? std::copysign(0.0, x) : value;
}
double exact_cospi(double x)
{
    const double a = std::abs(std::remainder(x, 2.0));
    return a < 0.25 ? std::cos(M_PI * a) : a == 0.5 ? 0.0 : std::sin(M_PI * (0.5 - a));
}

struct Unary {
    const char* name;
    float (*ours)(float);
    double (*exact)(double);
    double bound;  // ulp, as the function's comment says
    float low;     // where most calls fall: sampled densely besides
    float high;
};

#define OURS(name) [](float x) { return math_##name(x); }
#define LIBRARY(name) [](double x) { return std::name(x); }
const Unary unary[] = {
    {"sin", OURS(sin), LIBRARY(sin), 2.0, -10.0f, 10.0f},
    {"cos", OURS(cos), LIBRARY(cos), 2.0, -10.0f, 10.0f},
    {"tan", OURS(tan), LIBRARY(tan), 3.75, -10.0f, 10.0f},
    {"sinpi", OURS(sinpi), exact_sinpi, 2.0, -2.0f, 2.0f},
    {"cospi", OURS(cospi), exact_cospi, 2.0, -2.0f, 2.0f},
    {"asin", OURS(asin), LIBRARY(asin), 2.5, -1.0f, 1.0f},
    {"acos", OURS(acos), LIBRARY(acos), 1.5, -1.0f, 1.0f},
    {"exp", OURS(exp), LIBRARY(exp), 1.0, -104.0f, 89.0f},
    {"exp2", OURS(exp2), LIBRARY(exp2), 1.25, -150.0f, 128.0f},
    {"log", OURS(log), LIBRARY(log), 1.0, 0.5f, 2.0f},
    {"log2", OURS(log2), LIBRARY(log2), 1.75, 0.5f, 2.0f},
    {"cbrt", OURS(cbrt), LIBRARY(cbrt), 1.0, -8.0f, 8.0f},
};

class UnaryFunction : public testing::TestWithParam<Unary> {};

TEST_P(UnaryFunction, IsWithinItsBoundOverAllFloats)
{
    const Unary& f = GetParam();
    double worst = 0.0;
    float worst_at = 0.0f;
    const auto measure = [&](float x) {
        const double error = ulp_error(f.ours(x), f.exact(x));
        worst_at = error > worst ? x : worst_at;
        worst = std::max(worst, error);
    };
    std::ranges::for_each(float_patterns(1009), measure);
    std::ranges::for_each(special_floats, measure);
    for (int i = 0; i <= 1'000'000; ++i) {
        measure(f.low + (f.high - f.low) * static_cast<float>(i) * 1e-6f);
    }
    std::printf("%s: %.2f ulp at %.9g\n", f.name, worst, worst_at);
    EXPECT_LE(worst, f.bound) << "at " << worst_at << ": " << f.ours(worst_at) << " for "
                              << f.exact(worst_at);
}

INSTANTIATE_TEST_SUITE_P(Elementary, UnaryFunction, testing::ValuesIn(unary),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Elementary, SineAndCosineStayInRange)
{
    for (float x : float_patterns(4093)) {
        if (std::isfinite(x)) {
            ASSERT_LE(std::abs(math_sin(x)), 1.0f) << x;
            ASSERT_LE(std::abs(math_cos(x)), 1.0f) << x;
            ASSERT_LE(std::abs(math_sinpi(x)), 1.0f) << x;
            ASSERT_LE(std::abs(math_cospi(x)), 1.0f) << x;
        }
    }
}

// The floats closest to multiples of a right angle, which cancel most of a reduction's digits.
TEST(Elementary, SineIsAccurateWhereAnglesCancel)
{
    for (float x : {3.14159274f, 11.0f, 355.0f, 6381956970095103.0f * 2.168404345e+18f, 16367173.0f,
                    5.3319339e10f, 1.22925e32f, 3.4028235e38f}) {
        EXPECT_LE(ulp_error(math_sin(x), std::sin(static_cast<double>(x))), 2.0) << x;
        EXPECT_LE(ulp_error(math_cos(x), std::cos(static_cast<double>(x))), 2.0) << x;
    }
}

TEST(Elementary, PowerIsWithinItsBound)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-150.0, 129.0);
    double worst = 0.0;
    const auto measure = [&](float x, float y) {
        const double error = ulp_error(math_pow(x, y), std::pow(double(x), double(y)));
        EXPECT_LE(error, 1.5) << x << " ^ " << y << " = " << math_pow(x, y);
        worst = std::max(worst, error);
        return error <= 1.5;
    };
    for (float x : float_patterns(4093)) {
        // So that the result spreads over all finite floats; then whole exponents.
        const double log2_x = std::log2(std::abs(double(x)));
        ASSERT_TRUE(measure(std::abs(x), static_cast<float>(exponent(random) / log2_x)));
        ASSERT_TRUE(measure(x, static_cast<float>(static_cast<int>(random() % 41) - 20)));
    }
    const FloatPairs pairs = float_pairs(4093);
    for (std::size_t i = 0; i < pairs.a.size(); ++i) {
        ASSERT_TRUE(measure(pairs.a[i], pairs.b[i]));
    }
    std::printf("pow: %.2f ulp\n", worst);
}

TEST(Elementary, AngleOfVectorIsWithinItsBound)
{
    double worst = 0.0;
    const FloatPairs pairs = float_pairs(1009);
    for (std::size_t i = 0; i < pairs.a.size(); ++i) {
        const float y = pairs.a[i];
        const float x = pairs.b[i];
        const double error = ulp_error(math_atan2(y, x), std::atan2(double(y), double(x)));
        ASSERT_LE(error, 2.5) << y << ", " << x << ": " << math_atan2(y, x);
        worst = std::max(worst, error);
    }
    std::printf("atan2: %.2f ulp\n", worst);
}

// Annex F by example; the library agrees, and both tests above hold over these too.
TEST(Elementary, SpecialValuesAreThoseOfC99)
{
    struct Known {
        float value;
        float expected;
    };
    const Known known[] = {
        {math_sin(-0.0f), -0.0f},
        {math_sin(infinity), nan},
        {math_tan(-0.0f), -0.0f},
        {math_sinpi(-3.0f), -0.0f},
        {math_cospi(2.5f), 0.0f},
        {math_acos(1.0f), 0.0f},
        {math_asin(1.5f), nan},
        {math_exp(-infinity), 0.0f},
        {math_exp2(-149.0f), 1.0e-45f},
        {math_exp2(10.0f), 1024.0f},
        {math_log(-0.0f), -infinity},
        {math_log(1.0f), 0.0f},
        {math_log(-1.0f), nan},
        {math_log2(1.0e-45f), -149.0f},
        {math_cbrt(-27.0f), -3.0f},
        {math_atan2(-0.0f, -0.0f), -3.14159274f},
        {math_atan2(0.0f, 0.0f), 0.0f},
        {math_atan2(infinity, -infinity), 2.35619449f},
        {math_pow(nan, 0.0f), 1.0f},
        {math_pow(1.0f, nan), 1.0f},
        {math_pow(-1.0f, infinity), 1.0f},
        {math_pow(-0.0f, -3.0f), -infinity},
        {math_pow(-0.0f, -2.0f), infinity},
        {math_pow(-0.0f, 3.0f), -0.0f},
        {math_pow(-2.0f, 0.5f), nan},
        {math_pow(-2.0f, 3.0f), -8.0f},
        {math_pow(-infinity, 3.0f), -infinity},
        {math_pow(-infinity, -3.0f), -0.0f},
        {math_pow(0.5f, -infinity), infinity},
        {math_pow(2.0f, -infinity), 0.0f},
    };
    for (const Known& k : known) {
        EXPECT_TRUE(is_same(k.value, k.expected))
            << "entry " << (&k - known) << ": " << k.value << " for " << k.expected;
    }
}

TEST(SharedMath, GivesTheSameBitsVectorised)
{
    const FloatPairs pairs = float_pairs(4099);
    const int count = static_cast<int>(pairs.a.size());
    std::vector<std::uint32_t> plain(pairs.a.size());
    std::vector<std::uint32_t> vectorised(pairs.a.size());
    ASSERT_EQ(loops_debug::loop_count, loops_vector::loop_count);
    for (int f = 0; f < loops_debug::loop_count; ++f) {
        loops_debug::loops[f].run(pairs.a.data(), pairs.b.data(), plain.data(), count);
        loops_vector::loops[f].run(pairs.a.data(), pairs.b.data(), vectorised.data(), count);
        const auto [p, v] = std::ranges::mismatch(plain, vectorised);
        const auto i = p - plain.begin();
        EXPECT_TRUE(p == plain.end())
            << loops_debug::loops[f].name << "(" << pairs.a[i] << ", " << pairs.b[i] << "): bits "
            << std::hex << *p << " one by one, " << *v << " vectorised";
    }
}

}  // namespace
