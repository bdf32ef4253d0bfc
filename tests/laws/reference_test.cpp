// Pictures of scenes that others rendered: the same light, to the noise.
#include "host/image/image.hpp"
#include "host/render/render.hpp"
#include "host/scene/load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace {

using namespace diptych;

struct Comparison {
    double mean_ratio;    // of all channels
    double relative_rms;  // of the difference, to the reference's mean square
    double own_noise;     // the part of it that our own standard error explains
    double block_rms;     // of the difference of averages over 8 x 8 pixels: noise goes, bias stays
};

// The reference averaged over squares of `factor` pixels; RGB.
std::vector<double> reduced(const image::Picture& picture, int factor)
{
    const image::Layer& beauty = image::beauty_of(picture);
    const size_t channels = beauty.channels.size();
    const int width = picture.width / factor, height = picture.height / factor;
    std::vector<double> out(size_t(width) * size_t(height) * 3);
    for (int y = 0; y < height * factor; ++y)
        for (int x = 0; x < width * factor; ++x)
            for (size_t c = 0; c < 3; ++c)
                out[size_t(y / factor * width + x / factor) * 3 + c] +=
                    beauty.pixels[size_t(y * picture.width + x) * channels + c] /
                    double(factor * factor);
    return out;
}

Comparison compare_with_reference(const std::string& name, int bounces, int factor, int samples)
{
    const std::string folder = std::string(DIPTYCH_SHARED) + "/scenes/" + name + "/";
    const image::Picture reference = image::read_picture(folder + "reference.exr");
    LoadOptions load;
    load.width = reference.width / factor;
    load.height = reference.height / factor;
    SceneData scene = load_scene(folder + name + ".glb", load);
    scene.settings[0].filter = FILTER_BOX;
    scene.settings[0].max_bounces = bounces;
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    RenderOptions options;
    options.samples = samples;
    const RenderResult result = render(*backend, scene, options);
    const image::Picture picture = result.film.picture();
    const std::vector<float>& ours = image::beauty_of(picture).pixels;
    const std::vector<float>& error = image::find_layer(picture, "standard_error")->pixels;
    const std::vector<double> theirs = reduced(reference, factor);

    double sum = 0, their_sum = 0, square = 0, difference = 0, noise = 0;
    for (size_t k = 0; k < theirs.size(); ++k) {
        const double value = ours[k / 3 * 4 + k % 3];
        sum += value, their_sum += theirs[k];
        square += theirs[k] * theirs[k];
        difference += (value - theirs[k]) * (value - theirs[k]);
        noise += double(error[k]) * error[k];
    }
    const int size = 8, columns = load.width / size, rows = load.height / size;
    std::vector<double> blocks(size_t(columns) * size_t(rows) * 3);
    for (int y = 0; y < rows * size; ++y)
        for (int x = 0; x < columns * size; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const size_t p = size_t(y * load.width + x);
                blocks[size_t(y / size * columns + x / size) * 3 + c] +=
                    (ours[p * 4 + c] - theirs[p * 3 + c]) / (size * size);
            }
    double block_difference = 0;
    for (const double block : blocks) block_difference += block * block;
    const double mean_square = square / double(theirs.size());
    return {sum / their_sum, std::sqrt(difference / square), std::sqrt(noise / square),
            std::sqrt(block_difference / double(blocks.size()) / mean_square)};
}

bool is_there(const std::string& name)
{
    return std::filesystem::exists(std::string(DIPTYCH_SHARED) + "/scenes/" + name);
}

TEST(Reference, CornellBox)
{
    if (!is_there("gi-cornell-box")) GTEST_SKIP() << "no " DIPTYCH_SHARED "/scenes/gi-cornell-box";
    const Comparison comparison = compare_with_reference("gi-cornell-box", 29, 4, 128);
    EXPECT_NEAR(comparison.mean_ratio, 1, 0.01);
    // The reference has noise of its own, half again as much as ours at this size.
    EXPECT_LT(comparison.relative_rms, 2 * comparison.own_noise);
    EXPECT_LT(comparison.block_rms, 0.005);
    RecordProperty("mean_ratio", std::to_string(comparison.mean_ratio));
    RecordProperty("relative_rms", std::to_string(comparison.relative_rms));
    RecordProperty("own_noise", std::to_string(comparison.own_noise));
    RecordProperty("block_rms", std::to_string(comparison.block_rms));
}

TEST(Reference, VeachMis)
{
    if (!is_there("gi-veach-mis")) GTEST_SKIP() << "no " DIPTYCH_SHARED "/scenes/gi-veach-mis";
    const Comparison comparison = compare_with_reference("gi-veach-mis", 2, 4, 128);
    EXPECT_NEAR(comparison.mean_ratio, 1, 0.05);  // its spheres are 4 % brighter as triangles
    RecordProperty("mean_ratio", std::to_string(comparison.mean_ratio));
}

}  // namespace
