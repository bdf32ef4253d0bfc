#include "host/scene/picture.hpp"

#include "host/scene/scene_error.hpp"

#include <OpenImageIO/imageio.h>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>

namespace diptych {
namespace {

namespace fs = std::filesystem;

const fs::path scenes = fs::path(DIPTYCH_SHARED) / "scenes";
constexpr size_t limit = size_t(1) << 24;

template<typename T>
fs::path written(const std::string& name, int channels, OIIO::TypeDesc type,
                 const std::vector<T>& values, int width)
{
    const fs::path file = fs::path(testing::TempDir()) / name;
    OIIO::ImageSpec spec(width, int(values.size()) / channels / width, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    auto output = OIIO::ImageOutput::create(file.string());
    output->open(file.string(), spec);
    output->write_image(OIIO::BaseTypeFromC<T>::value, values.data());
    output->close();
    return file;
}

std::vector<std::uint8_t> bytes_of(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

using Bytes = std::vector<std::uint8_t>;

TEST(Picture, Spreads_one_to_four_channels)
{
    const auto read = [](int channels, const Bytes& values) {
        return read_picture(written("channels.png", channels, OIIO::TypeDesc::UINT8, values, 1),
                            "p", limit)
            .bytes;
    };
    EXPECT_EQ(read(1, {7}), (Bytes{7, 7, 7, 255}));
    EXPECT_EQ(read(2, {7, 9}), (Bytes{7, 7, 7, 9}));
    EXPECT_EQ(read(3, {1, 2, 3}), (Bytes{1, 2, 3, 255}));
    EXPECT_EQ(read(4, {1, 2, 3, 0}), (Bytes{1, 2, 3, 0})) << "straight alpha";
}

TEST(Picture, Files_and_bytes_of_them_are_the_same)
{
    const fs::path file =
        written("same.png", 3, OIIO::TypeDesc::UINT8, Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9}, 3);
    const Picture a = read_picture(file, "p", limit), b = read_picture(bytes_of(file), "p", limit);
    EXPECT_EQ(a.width, 3);
    EXPECT_EQ(a.height, 1);
    EXPECT_EQ(a.bytes, b.bytes);
}

TEST(Picture, Sixteen_bits_and_floats_stay_precise)
{
    const Picture p = read_picture(
        written("deep.png", 1, OIIO::TypeDesc::UINT16, std::vector<std::uint16_t>{1, 65535}, 1),
        "p", limit);
    EXPECT_TRUE(p.is_integer);
    EXPECT_FALSE(p.is_8_bit());
    EXPECT_FLOAT_EQ(p.floats[0], 1 / 65535.0f);
    EXPECT_EQ(p.floats[4], 1);
    EXPECT_EQ(p.floats[3], 1);
}

TEST(Picture, Floats_that_are_no_radiance_are_replaced)
{
    const float inf = std::numeric_limits<float>::infinity();
    const Picture p = read_picture(written("bad.exr", 3, OIIO::TypeDesc::FLOAT,
                                           std::vector<float>{inf, 1, 2, -1, NAN, 900, 3, 4, 5}, 1),
                                   "p", limit);
    EXPECT_FALSE(p.is_integer);
    EXPECT_EQ(p.bad_texels, 3u);
    EXPECT_EQ(p.floats[0], 900) << "infinity becomes the largest";
    EXPECT_EQ(p.floats[4], 0);
    EXPECT_EQ(p.floats[5], 0);
    EXPECT_EQ(p.floats[6], 900);
}

TEST(Picture, Limits_are_checked_before_decoding)
{
    const fs::path file = written("big.png", 3, OIIO::TypeDesc::UINT8, Bytes(300, 0), 10);
    EXPECT_NO_THROW(read_picture(file, "p", 100));
    try {
        read_picture(file, "wall", 99);
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "wall: an image of 10 x 10 pixels and 4 channels is beyond the "
                                   "limit of 99 pixels; use a smaller image or raise the limit");
    }
}

TEST(Picture, Srgb_decodes_as_the_standard_says)
{
    EXPECT_EQ(srgb_decode(0), 0);
    EXPECT_NEAR(srgb_decode(1), 1, 1e-7);
    EXPECT_NEAR(srgb_decode(0.5f), 0.21404114, 1e-7);
    EXPECT_NEAR(srgb_decode(0.04f), 0.04 / 12.92, 1e-9);
    for (int k = 0; k < 256; ++k)
        EXPECT_EQ(srgb_decode_byte(std::uint8_t(k)), srgb_decode(float(k) / 255));
}

// Reads every image of a folder from memory and by name; counts those that can be read.
size_t readable(const std::string& folder, size_t& files)
{
    size_t count = 0;
    files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(scenes / folder)) {
        std::string extension = entry.path().extension().string();
        for (char& c : extension) {
            c = char(std::tolower(c));
        }
        if (!entry.is_regular_file() || extension.empty() || extension == ".txt" ||
            extension == ".json" || extension == ".license" || extension == ".readme" ||
            extension == ".rst") {
            continue;
        }
        SCOPED_TRACE(entry.path().string());
        ++files;
        const auto attempt = [&](const auto& source) {
            try {
                const Picture p = read_picture(source, "image", limit);
                const size_t values = 4 * size_t(p.width) * size_t(p.height);
                EXPECT_EQ(p.is_8_bit() ? p.bytes.size() : p.floats.size(), values);
                for (const float v : p.floats) {
                    if (!(v >= 0) || std::isinf(v)) {
                        ADD_FAILURE() << v;
                        break;
                    }
                }
                return true;
            } catch (const SceneError& error) {
                const std::string message = error.what();
                EXPECT_EQ(message.find('\n'), std::string::npos) << message;
                EXPECT_NE(message.find("; "), std::string::npos) << message;
                return false;
            }
        };
        count += attempt(entry.path());
        attempt(bytes_of(entry.path()));
    }
    return count;
}

TEST(Picture, Reads_every_sound_image_and_survives_the_others)
{
    if (!fs::is_directory(scenes)) {
        GTEST_SKIP() << "no folder " << scenes << " with real images";
    }
    size_t files = 0;
    EXPECT_EQ(readable("tex-PngSuite", files), files);
    EXPECT_GT(files, 150u);
    EXPECT_GE(readable("tex-exr-kinds", files), 5u);
    for (const char* folder :
         {"hostile-png", "hostile-jpeg-open", "hostile-exr-open", "hostile-oiio-open"}) {
        EXPECT_LT(readable(folder, files), files) << folder;
        EXPECT_GT(files, 10u);
    }
}

}  // namespace
}  // namespace diptych
