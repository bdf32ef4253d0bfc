// What is written can be read back, by us and by others; and nothing half-written is ever seen.
#include "host/image/image.hpp"
#include "tests/host/image/scratch_folder.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <random>
#include <stdexcept>
#include <sys/resource.h>
#include <thread>

using namespace diptych::image;
namespace fs = std::filesystem;

static std::vector<float> noise(size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& v : values)
        v = std::exp2(float(random() % 2000) / 50 - 20) * (random() % 8 ? 1.0f : -1.0f);
    return values;
}

static Picture every_layer(int width, int height)
{
    const size_t n = size_t(width) * height;
    Picture picture;
    picture.width = width;
    picture.height = height;
    std::vector<uint32_t> ids(n);
    for (size_t i = 0; i < n; ++i) ids[i] = uint32_t(i * 2654435761u);
    picture.layers = {beauty_layer(noise(4 * n, 1)), albedo_layer(noise(3 * n, 2)),
                      normal_layer(noise(3 * n, 3)), depth_layer(noise(n, 4)),
                      id_layer("object_id", ids),    id_layer("material_id", ids),
                      id_layer("sample_count", ids), standard_error_layer(noise(3 * n, 5))};
    picture.metadata = {{"samples", "64"}, {"commandLine", "diptych render \"a b.glb\" -o x.exr"}};
    return picture;
}

TEST(Exr, HoldsEveryLayerExactly)
{
    const ScratchFolder folder;
    const Picture written = every_layer(37, 70);  // more rows than one band
    write_picture(folder / "all.exr", written);
    const Picture read = read_picture(folder / "all.exr");
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 70);
    EXPECT_EQ(read.encoding, Encoding::Linear);
    ASSERT_EQ(read.layers.size(), written.layers.size());
    for (const Layer& layer : written.layers) {
        const Layer* other = find_layer(read, layer.name);
        ASSERT_TRUE(other) << layer.name;
        EXPECT_EQ(other->channels, layer.channels);
        EXPECT_EQ(other->pixels, layer.pixels) << layer.name;
        EXPECT_EQ(other->ids, layer.ids) << layer.name;
    }
    for (const auto& [name, value] : written.metadata) EXPECT_EQ(read.metadata.at(name), value);
}

TEST(Exr, HalfKeepsElevenBitsAndTheRangeButNotDepthOrIds)
{
    const ScratchFolder folder;
    Picture written = every_layer(16, 16);
    written.layers[0].pixels[0] = 1e9f;
    written.layers[0].pixels[1] = -1e9f;
    write_picture(folder / "half.exr", written, {.half = true});
    const Picture read = read_picture(folder / "half.exr");
    EXPECT_EQ(beauty_of(read).pixels[0], 65504.0f);
    EXPECT_EQ(beauty_of(read).pixels[1], -65504.0f);
    for (size_t i = 2; i < written.layers[0].pixels.size(); ++i) {
        const float v = written.layers[0].pixels[i];
        if (std::abs(v) >= 65504) continue;
        ASSERT_NEAR(beauty_of(read).pixels[i], v, std::max(std::abs(v) * 0x1p-11f, 0x1p-25f));
    }
    EXPECT_EQ(find_layer(read, "depth")->pixels, written.layers[3].pixels);
    EXPECT_EQ(find_layer(read, "object_id")->ids, written.layers[4].ids);
    EXPECT_LT(fs::file_size(folder / "half.exr"), 16u * 16 * 4 * 17);
}

// The names and types that viewers look for, seen through another reader.
TEST(Exr, HasTheStandardChannelNamesInItsFirstPart)
{
    const ScratchFolder folder;
    write_picture(folder / "names.exr", every_layer(8, 8));
    const auto input = OIIO::ImageInput::open(folder / "names.exr");
    ASSERT_TRUE(input);
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(std::vector<std::string>(spec.channelnames.begin(), spec.channelnames.begin() + 5),
              (std::vector<std::string>{"R", "G", "B", "A", "Z"}));
    for (const char* name : {"albedo.R", "albedo.B", "normal.X", "normal.Z", "standard_error.G"})
        EXPECT_EQ(spec.channelformat(spec.channelindex(name)), OIIO::TypeDesc::FLOAT) << name;
    for (const char* name : {"object_id", "material_id", "sample_count"})
        EXPECT_EQ(spec.channelformat(spec.channelindex(name)), OIIO::TypeDesc::UINT) << name;
    EXPECT_EQ(spec.alpha_channel, 3);
    EXPECT_EQ(spec.z_channel, 4);
    EXPECT_FALSE(input->seek_subimage(1, 0)) << "one part";
}

TEST(Files, AreTheSameBytesForTheSamePicture)
{
    const ScratchFolder folder;
    const Picture picture = every_layer(33, 29);
    const char* const names[] = {"a.exr", "a.png", "a.jpg", "a.tif"};
    for (const char* name : names) write_picture(folder / name, picture);
    std::this_thread::sleep_for(
        std::chrono::milliseconds(1100));  // file formats love to note the second
    for (const char* name : names) {
        const std::string other =
            fs::path(name).replace_filename("b").replace_extension(fs::path(name).extension());
        write_picture(folder / other, picture);
        EXPECT_TRUE(bytes_of(folder / name) == bytes_of(folder / other)) << name;
    }
}

static Picture flat(std::vector<float> rgba, int width, int height)
{
    Picture picture;
    picture.width = width;
    picture.height = height;
    std::vector<float> pixels;
    for (int i = 0; i < width * height; ++i) pixels.insert(pixels.end(), rgba.begin(), rgba.end());
    picture.layers.push_back(beauty_layer(pixels));
    return picture;
}

static std::vector<float> first_pixel(const std::string& path)
{
    const Picture picture = read_picture(path);
    const Layer& beauty = beauty_of(picture);
    return {beauty.pixels.begin(), beauty.pixels.begin() + long(beauty.channels.size())};
}

TEST(Png, EncodesKnownValues)
{
    const ScratchFolder folder;
    // 0.2158605 is the linear value of sRGB 128/255.
    const Picture picture = flat({0.2158605f, 1, -1, 1}, 3, 2);
    write_picture(folder / "eight.png", picture);
    EXPECT_EQ(first_pixel(folder / "eight.png"), (std::vector<float>{128 / 255.0f, 1, 0}));
    write_picture(folder / "sixteen.png", picture, {.sixteen_bit = true});
    EXPECT_NEAR(first_pixel(folder / "sixteen.png")[0], 128 / 255.0f, 0.51 / 65535);
    write_picture(folder / "brighter.tif", flat({0.053965125f, 0, 0, 1}, 3, 2), {.exposure = 2});
    EXPECT_EQ(first_pixel(folder / "brighter.tif")[0], 128 / 255.0f);
    EXPECT_EQ(read_picture(folder / "brighter.tif").encoding, Encoding::Display);
    write_picture(folder / "grey.jpg", flat({0.2158605f, 0.2158605f, 0.2158605f, 1}, 8, 8));
    EXPECT_NEAR(first_pixel(folder / "grey.jpg")[1], 128 / 255.0f, 1.5 / 255);
}

TEST(Png, AlphaIsUnassociatedAndOnlyThereWhenAskedFor)
{
    const ScratchFolder folder;
    const Picture picture = flat({0.1079303f, 0, 0, 0.5f}, 2, 2);  // half of sRGB 128/255
    write_picture(folder / "alpha.png", picture, {.alpha = true});
    EXPECT_EQ(first_pixel(folder / "alpha.png"),
              (std::vector<float>{128 / 255.0f, 0, 0, 128 / 255.0f}));
    write_picture(folder / "opaque.png", picture);
    EXPECT_EQ(first_pixel(folder / "opaque.png").size(), 3u);
    write_picture(folder / "nothing.png", flat({0, 0, 0, 0}, 2, 2), {.alpha = true});
    EXPECT_EQ(first_pixel(folder / "nothing.png"), (std::vector<float>{0, 0, 0, 0}));
}

TEST(Png, NeverShowsANaN)
{
    const ScratchFolder folder;
    write_picture(folder / "nan.png", flat({NAN, INFINITY, -INFINITY, NAN}, 2, 2), {.alpha = true});
    EXPECT_EQ(first_pixel(folder / "nan.png").size(), 4u);
}

static std::string message_of(const std::function<void()>& action)
{
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

TEST(Writing, RefusesWhatCannotWorkBeforeAnythingIsRendered)
{
    const ScratchFolder folder;
    EXPECT_NE(message_of([&] { check_writable(folder / "x.bmp"); }).find(".exr, .png"),
              std::string::npos);
    EXPECT_NE(message_of([&] { check_writable(folder / "x"); }).find("unknown picture format"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] { check_writable(folder / "no/such/x.png"); }).find("cannot be written"),
        std::string::npos);
    EXPECT_NE(message_of([&] { check_writable("/proc/x.png"); }).find("/proc/x.png: "),
              std::string::npos);
    fs::create_directory(folder / "folder.png");
    EXPECT_NE(message_of([&] { check_writable(folder / "folder.png"); }).find("is a folder"),
              std::string::npos);
    EXPECT_EQ(message_of([&] { check_writable(folder / "fine.EXR"); }), "");
    EXPECT_EQ(folder.files(), 1);
}

TEST(Writing, RefusesLayersOfTheWrongSize)
{
    const ScratchFolder folder;
    Picture picture = flat({1, 1, 1, 1}, 4, 4);
    picture.layers[0].pixels.pop_back();
    EXPECT_NE(message_of([&] { write_picture(folder / "x.exr", picture); }).find("63 values, 64"),
              std::string::npos);
    picture.width = 0;
    EXPECT_NE(message_of([&] { write_picture(folder / "x.exr", picture); }).find("0 x 4"),
              std::string::npos);
    EXPECT_EQ(folder.files(), 0);
}

// A disk that fills up, played by a limit on the size of files.
class SmallDisk {
public:
    explicit SmallDisk(rlim_t bytes)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_;
};

TEST(Writing, KeepsTheOldFileWhenTheDiskIsFull)
{
    const ScratchFolder folder;
    for (const char* name : {"x.exr", "x.png", "x.jpg", "x.tif"}) {
        put_bytes(folder / name, "old");
        std::string message;
        {
            const SmallDisk disk(2000);
            message = message_of([&] { write_picture(folder / name, every_layer(128, 128)); });
        }
        EXPECT_NE(message.find("could not be written whole (File too large); make room"),
                  std::string::npos)
            << name << ": " << message;
        EXPECT_EQ(bytes_of(folder / name), "old");
    }
    EXPECT_EQ(folder.files(), 4);
}

// Data window inside and beyond the display window: what a viewer shows.
TEST(Exr, IsReadAsItsDisplayWindow)
{
    const ScratchFolder folder;
    OIIO::ImageSpec spec(4, 3, 1, OIIO::TypeDesc::FLOAT);  // stored: x -1..2, y 1..3
    spec.x = -1;
    spec.y = 1;
    spec.full_width = 3;
    spec.full_height = 3;
    spec.channelnames = {"Y"};
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(folder / "window.exr", spec));
    const float values[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values));
    ASSERT_TRUE(output->close());
    const Picture picture = read_picture(folder / "window.exr");
    EXPECT_EQ(picture.width, 3);
    EXPECT_EQ(beauty_of(picture).pixels, (std::vector<float>{0, 0, 0, 2, 3, 4, 6, 7, 8}));
}
