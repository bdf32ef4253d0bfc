// Files from strangers: an error of one line or a picture, never a crash, a hang or a huge
// allocation.
#include "host/image/image.hpp"
#include "tests/host/image/scratch_folder.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

using namespace diptych::image;
namespace fs = std::filesystem;

// Empty when the picture was read.
static std::string outcome(const std::string& path, const ReadLimits& limits)
{
    try {
        const Picture picture = read_picture(path, limits);
        const size_t pixels = size_t(picture.width) * picture.height;
        for (const Layer& layer : picture.layers)
            EXPECT_EQ(layer.pixels.size() + layer.ids.size(), pixels * layer.channels.size())
                << path;
        return {};
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
        EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
        EXPECT_GT(message.size(), path.size() + 10) << message;
        return message;
    }
}

struct Expected {
    const char* folder;
    int at_least;    // pictures in it
    int unreadable;  // how many of them must be refused, at least
    int readable;    // and how many must be read, at least
};

class Hostile : public testing::TestWithParam<Expected> {};

TEST_P(Hostile, FolderIsSurvived)
{
    const std::string folder = std::string(DIPTYCH_SHARED) + "/scenes/" + GetParam().folder;
    if (!fs::exists(folder)) GTEST_SKIP() << "no folder " << folder;
    int read = 0, refused = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const bool good =
            outcome(entry.path().string(), {.pixels = 1u << 24, .values = 1u << 24}).empty();
        ++(good ? read : refused);
    }
    EXPECT_GE(read + refused, GetParam().at_least);
    EXPECT_GE(refused, GetParam().unreadable);
    EXPECT_GE(read, GetParam().readable);
}

INSTANTIATE_TEST_SUITE_P(
    Folders, Hostile,
    testing::Values(Expected{"hostile-exr-open", 101, 100, 0}, Expected{"hostile-png", 14, 14, 0},
                    Expected{"hostile-jpeg-open", 33, 15, 5},
                    Expected{"hostile-oiio-open", 24, 10, 6}, Expected{"tex-PngSuite", 161, 0, 161},
                    Expected{"tex-exr-kinds", 7, 1, 6}, Expected{"tex-exr-latlong", 2, 0, 2}));

TEST(Guard, NamesWhatIsWrong)
{
    const ScratchFolder folder;
    const ReadLimits limits;
    EXPECT_NE(outcome(folder / "none.png", limits).find("no such file"), std::string::npos);
    EXPECT_NE(outcome(fs::path(folder / "x").parent_path().string(), limits).find("is not a file"),
              std::string::npos);
    put_bytes(folder / "empty.png", "");
    EXPECT_NE(outcome(folder / "empty.png", limits).find("empty file"), std::string::npos);
    put_bytes(folder / "text.exr", "hello, this is text");
    EXPECT_NE(outcome(folder / "text.exr", limits).find("is no EXR"), std::string::npos);
}

static Picture grey(int width, int height)
{
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.layers.push_back(beauty_layer(std::vector<float>(size_t(width) * height * 4, 0.5f)));
    return picture;
}

TEST(Guard, ChecksTheSizeFromTheHeader)
{
    const ScratchFolder folder;
    for (const char* name : {"x.exr", "x.png", "x.jpg", "x.tif"}) {
        write_picture(folder / name, grey(101, 100));
        EXPECT_EQ(outcome(folder / name, {.pixels = 10100}), "");
        EXPECT_NE(outcome(folder / name, {.pixels = 10099}).find("101 x 100 pixels"),
                  std::string::npos)
            << name;
    }
    EXPECT_NE(outcome(folder / "x.exr", {.values = 40000}).find("4 channels"), std::string::npos);
}

// One stored pixel in a window of 16384 x 16384: within the limits, but nothing that 300 bytes
// hold.
TEST(Guard, RefusesAWindowThatTheFileCannotFill)
{
    const ScratchFolder folder;
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::FLOAT);
    spec.full_width = spec.full_height = 16384;
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(folder / "window.exr", spec));
    const float pixel[4] = {1, 1, 1, 1};
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixel));
    ASSERT_TRUE(output->close());
    EXPECT_NE(
        outcome(folder / "window.exr", {}).find("16384 x 16384 pixels, but the file has only"),
        std::string::npos);
}

// Every file cut at many places, and with each of many bytes changed.
TEST(Guard, SurvivesCutAndDamagedFiles)
{
    const ScratchFolder folder;
    for (const char* name : {"x.exr", "x.png", "x.jpg", "x.tif"}) {
        write_picture(folder / name, grey(40, 40));
        const std::string whole = bytes_of(folder / name);
        int refused = 0;
        for (size_t size = 0; size < whole.size(); size += std::max<size_t>(1, whole.size() / 60)) {
            put_bytes(folder / name, whole.substr(0, size));
            refused += !outcome(folder / name, {.pixels = 1u << 22, .values = 1u << 24}).empty();
        }
        EXPECT_GE(refused, 20) << name;
        for (size_t at = 0; at < whole.size(); at += std::max<size_t>(1, whole.size() / 150)) {
            std::string damaged = whole;
            damaged[at] = char(damaged[at] ^ 0xff);
            put_bytes(folder / name, damaged);
            outcome(folder / name, {.pixels = 1u << 22, .values = 1u << 24});
        }
    }
}
