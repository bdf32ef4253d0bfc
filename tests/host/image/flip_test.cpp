// ꟻLIP against the values of the authors' own program, and its laws.
#include "host/image/flip.hpp"
#include "host/image/image.hpp"
#include "host/image/metrics.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <random>

using namespace diptych::image;

static const std::string TRUTH = DIPTYCH_SHARED "/truth/flip/";

static Colors load(const std::string& file)
{
    return colors_of(read_picture(TRUTH + file), "", file);
}

static FlipResult evaluate(const nlohmann::json& row)
{
    const Colors reference = load(row["reference"]), test = load(row["test"]);
    const bool hdr = row["kind"] == "HDR";
    EXPECT_EQ(hdr, reference.encoding == Encoding::Linear);
    const auto flip = hdr ? flip_hdr : flip_ldr;
    return flip(reference.values, test.values, reference.width, reference.height, row["ppd"]);
}

TEST(Flip, AgreesWithTheAuthorsProgram)
{
    if (!std::filesystem::exists(TRUTH)) GTEST_SKIP() << "no folder " << TRUTH;
    const nlohmann::json truth = nlohmann::json::parse(std::ifstream(TRUTH + "values.json"));
    ASSERT_GE(truth.size(), 20u);
    for (const auto& [name, row] : truth.items()) {
        SCOPED_TRACE(name);
        const FlipResult result = evaluate(row);
        EXPECT_NEAR(result.mean, row["mean"].get<double>(), 1e-4);
        EXPECT_NEAR(result.median, row["median"].get<double>(), 1e-3);
        EXPECT_NEAR(result.p99, row["p99"].get<double>(), 1e-3);
        EXPECT_NEAR(result.max, row["max"].get<double>(), 1e-3);
        if (row["kind"] != "HDR") continue;
        EXPECT_NEAR(result.start_exposure, row["exposures"][0].get<double>(), 1e-4);
        EXPECT_NEAR(result.stop_exposure, row["exposures"][1].get<double>(), 1e-4);
        EXPECT_EQ(result.exposures, row["exposures"][2].get<int>());
    }
}

static std::vector<float> noise(int pixels, unsigned seed, float scale)
{
    std::mt19937 random(seed);
    std::vector<float> values(size_t(pixels) * 3);
    for (float& v : values) v = scale * float(random() >> 8) * 0x1p-24f;
    return values;
}

TEST(Flip, IsZeroForEqualPicturesAndSymmetricForDisplayOnes)
{
    const auto a = noise(40 * 30, 1, 1), b = noise(40 * 30, 2, 1);
    EXPECT_EQ(flip_ldr(a, a, 40, 30, FLIP_PIXELS_PER_DEGREE).max, 0.0);
    EXPECT_EQ(flip_hdr(a, a, 40, 30, FLIP_PIXELS_PER_DEGREE).max, 0.0);
    const FlipResult ab = flip_ldr(a, b, 40, 30, FLIP_PIXELS_PER_DEGREE);
    EXPECT_GT(ab.mean, 0.01);
    EXPECT_EQ(ab.map, flip_ldr(b, a, 40, 30, FLIP_PIXELS_PER_DEGREE).map);
}

// Turning the picture by a quarter must turn the map: no filter prefers a direction, and no band
// edge shows.
TEST(Flip, TurnsWithThePicture)
{
    const int width = 37, height = 150;
    const auto a = noise(width * height, 3, 1), b = noise(width * height, 4, 1);
    const auto turned = [&](const std::vector<float>& v) {
        std::vector<float> out(v.size());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c)
                    out[3 * (size_t(x) * height + y) + c] = v[3 * (size_t(y) * width + x) + c];
        return out;
    };
    const FlipResult upright = flip_ldr(a, b, width, height, 30);
    const FlipResult lying = flip_ldr(turned(a), turned(b), height, width, 30);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            ASSERT_NEAR(upright.map[size_t(y) * width + x], lying.map[size_t(x) * height + y], 2e-4)
                << x << "," << y;
}

TEST(Flip, HdrDoesNotDependOnTheUnitOfRadiance)
{
    const auto a = noise(32 * 32, 5, 4), b = noise(32 * 32, 6, 4);
    auto a_dim = a, b_dim = b;
    for (float& v : a_dim) v /= 1024;
    for (float& v : b_dim) v /= 1024;
    const FlipResult bright = flip_hdr(a, b, 32, 32, 67.02),
                     dim = flip_hdr(a_dim, b_dim, 32, 32, 67.02);
    EXPECT_NEAR(bright.mean, dim.mean, 1e-5);
    EXPECT_NEAR(dim.start_exposure - bright.start_exposure, 10, 1e-4);
}

TEST(Flip, TakesBlackAndMostlyBlackReferences)
{
    const std::vector<float> black(3 * 64, 0.0f);
    auto spot = black;
    spot[0] = spot[1] = spot[2] = 5;
    EXPECT_EQ(flip_hdr(black, black, 8, 8, 67.02).mean, 0.0);
    const FlipResult against_black = flip_hdr(black, spot, 8, 8, 67.02);
    EXPECT_GT(against_black.max, 0.1);
    EXPECT_EQ(against_black.exposures, 23);
    EXPECT_GT(flip_hdr(spot, black, 8, 8, 67.02).max, 0.1);
}

TEST(Flip, RefusesImpossibleViewingDistances)
{
    const std::vector<float> pixel(3, 0.5f);
    EXPECT_THROW(flip_ldr(pixel, pixel, 1, 1, 0), std::runtime_error);
    EXPECT_THROW(flip_ldr(pixel, pixel, 1, 1, std::nan("")), std::runtime_error);
    EXPECT_EQ(flip_ldr(pixel, pixel, 1, 1, 1).mean, 0.0);
}
