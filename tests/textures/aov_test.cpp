// `diptych render --aov NODE`: what texture nodes give at the first hit, as layers of the EXR.
#include "tests/debugger/textured_scene.hpp"
#include "tests/host/commands/program.hpp"

#include "host/image/image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

using namespace diptych;
using nlohmann::json;

namespace {

// Two squares, the left one painted; beside its nodes some that no material reads.
void write_scene(const TestFolder& folder)
{
    write_painted_scene(folder);
    folder.write("more.c",
                 "float height(float scale) { return scale * readAttr(\"WorldPos\").y; }\n"
                 "float2 both(float a, float scale)\n{\n    return make_float2(a, scale);\n}\n"
                 "float pole(float scale) { return scale / (scale - 1.0f); }\n");
    folder.write("open.c", "float open(float scale) { return readOcclusion(\"both\", scale); }\n");
    std::ifstream in(folder / "scene.gltf");
    json scene = json::parse(in);
    json& extension = scene["extensions"]["DIPTYCH_procedural_texture"];
    extension["sources"].push_back({{"uri", "more.c"}});
    extension["sources"].push_back({{"uri", "open.c"}});
    const auto add = [&](const char* name, const char* function, const json& arguments) {
        extension["nodes"].push_back({{"name", name},
                                      {"source", name == std::string("open") ? 2 : 1},
                                      {"function", function},
                                      {"arguments", arguments}});
    };
    add("height", "height", {{"scale", -3}});
    add("both", "both", {{"a", {{"node", "height"}}}, {"scale", 7}});
    add("pole", "pole", {{"scale", 1}});
    add("open", "open", {{"scale", 0.25}});
    folder.write("scene.gltf", scene.dump());
}

class Aovs : public testing::TestWithParam<std::string> {
protected:
    Aovs() { write_scene(folder_); }

    Outcome render(const std::vector<std::string>& more) const
    {
        std::vector<std::string> words = {"render",  "scene.gltf", "--backend", GetParam(),
                                          "--quiet", "--json",     "out.json"};
        words.insert(words.end(), painted_view.begin(), painted_view.end());
        words.insert(words.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--samples") == more.end())
            words.insert(words.end(), {"--samples", "20"});
        return run_diptych(words, {.seconds = 300, .folder = folder_.path()});
    }
    json report() const
    {
        std::ifstream in(folder_ / "out.json");
        return json::parse(in);
    }
    // Of the layers' pixels, by name.
    json hashes(const std::vector<std::string>& more) const
    {
        const Outcome outcome = render(more);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return report().at("sha256");
    }
    bool is_usable() const
    {
        return GetParam() != "opencl" ||
               run_diptych({"render", "--size", "8x8", "--samples", "1", "--backend", "opencl",
                            "-o", folder_ / "trial.png"},
                           {.seconds = 200})
                       .exit_code == 0;
    }
    TestFolder folder_;
};

TEST_P(Aovs, AreRawValuesOnEverySurfaceThatTheCameraSees)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const Outcome outcome = render({"-o", "out.exr", "--half", "--aov", "paint", "--aov", "height",
                                    "--aov", "both", "--aov", "paint"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    const image::Picture picture = image::read_picture(folder_ / "out.exr");
    const image::Layer* paint = image::find_layer(picture, "aov.paint");
    const image::Layer* height = image::find_layer(picture, "aov.height");
    const image::Layer* both = image::find_layer(picture, "aov.both");
    const image::Layer* albedo = image::find_layer(picture, "albedo");
    const image::Layer* material = image::find_layer(picture, "material_id");
    ASSERT_TRUE(paint && height && both && albedo && material);
    EXPECT_EQ(paint->channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(height->channels, (std::vector<std::string>{"R"}));
    EXPECT_EQ(both->channels, (std::vector<std::string>{"R", "G"}));

    // One pixel is 2 * 2 tan(20 degrees) / 20 m wide at the squares.
    const double step = 4 * std::tan(20 * 3.14159265358979 / 180) / 20;
    const auto at = [](int x, int y) { return size_t(y * 40 + x); };
    for (const int x : {12, 30}) {
        const size_t p = at(x, 8);
        const double wave = std::pow(std::sin((1 + (x + 0.5 - 20) * step) * 7), 2);
        const double y = 0.5 - (8.5 - 10) * step;
        EXPECT_NEAR(paint->pixels[4 * p], 0.5 * wave, 0.04) << x;
        EXPECT_NEAR(paint->pixels[4 * p + 2], 0.25, 1e-6) << "stored as float, on any material";
        EXPECT_EQ(paint->pixels[4 * p + 3], 1.0f);
        EXPECT_NEAR(height->pixels[p], -3 * y, 0.02) << "negative values stay";
        EXPECT_EQ(both->pixels[2 * p], height->pixels[p]) << "a node shared by another";
        EXPECT_EQ(both->pixels[2 * p + 1], 7.0f);
    }
    EXPECT_EQ(paint->pixels[4 * at(0, 0) + 3], 0.0f) << "no surface";
    EXPECT_EQ(height->pixels[at(0, 0)], 0.0f);
    // As a colour the node is the albedo: the same samples, filtered alike.
    ASSERT_EQ(render({"-o", "out.exr", "--aov", "paint"}).exit_code, 0);
    const image::Picture whole = image::read_picture(folder_ / "out.exr");
    int painted = 0;
    for (int y = 6; y < 14; ++y)
        for (int x = 7; x < 18; ++x) {
            const size_t p = at(x, y);
            ASSERT_EQ(image::find_layer(whole, "material_id")->ids[p], 1u);
            for (size_t c = 0; c < 3; ++c)
                EXPECT_EQ(image::find_layer(whole, "aov.paint")->pixels[4 * p + c],
                          image::find_layer(whole, "albedo")->pixels[3 * p + c]);
            ++painted;
        }
    EXPECT_GT(painted, 50);
}

TEST_P(Aovs, ChangeNoBitOfTheOtherLayersAndCostNothingUnasked)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const json plain = hashes({});
    EXPECT_FALSE(report().at("stage_seconds").value("accumulate_aovs", 0.0) > 0);
    EXPECT_EQ(report().at("effects").dump().find("TEXTURE_AOV"), std::string::npos);
    json shown = hashes({"--aov", "open", "--aov", "left"});
    EXPECT_NE(report().at("effects").dump().find("TEXTURE_AOV"), std::string::npos);
    ASSERT_TRUE(shown.contains("aov.open") && shown.contains("aov.left"));
    shown.erase("aov.open");
    shown.erase("aov.left");
    EXPECT_EQ(shown, plain);
    // One node of the command line, and no other texture in the scene.
    folder_.write("alone.c", "float4 alone(float scale) { return make_float4(scale, 2, 3, 4); }\n");
    const json alone = hashes({"--texture", "painted.baseColor=alone.c", "--set", "alone.scale=-5",
                               "--aov", "alone", "--threads", "1"});
    EXPECT_EQ(alone.at("aov.alone"),
              hashes({"--texture", "painted.baseColor=alone.c", "--set", "alone.scale=-5", "--aov",
                      "open", "--aov", "alone", "--threads", "2", "--memory", "64M"})
                  .at("aov.alone"))
        << "whatever runs beside it";
}

TEST_P(Aovs, AreKeptInCheckpointsAndMerged)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const std::vector<std::string> nodes = {"--aov", "paint", "--aov", "height", "--samples", "32"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), nodes.begin(), nodes.end());
        return more;
    };
    const auto pixels = [&](const std::string& name, const char* layer) {
        const image::Picture picture = image::read_picture(folder_ / name);
        const image::Layer* found = image::find_layer(picture, layer);
        EXPECT_TRUE(found) << layer;
        return found ? found->pixels : std::vector<float>{};
    };
    ASSERT_EQ(render(with({"-o", "whole.exr"})).exit_code, 0);
    for (const char* range : {"0..16", "16..32"}) {
        const Outcome part =
            render(with({"--range", range, "--checkpoint", std::string(range) + ".checkpoint"}));
        ASSERT_EQ(part.exit_code, 0) << part.text();
    }
    const Outcome merged =
        run_diptych({"merge", "16..32.checkpoint", "0..16.checkpoint", "-o", "merged.exr"},
                    {.seconds = 60, .folder = folder_.path()});
    ASSERT_EQ(merged.exit_code, 0) << merged.text();
    for (const char* layer : {"aov.paint", "aov.height", "albedo"})
        EXPECT_EQ(pixels("merged.exr", layer), pixels("whole.exr", layer)) << layer;

    const Outcome other = render({"--aov", "height", "--samples", "32", "--range", "0..16",
                                  "--checkpoint", "0..16.checkpoint"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.err.find("layers of texture nodes (paint height and height)"),
              std::string::npos)
        << other.err;
}

TEST_P(Aovs, FaultsOfANodeThatOnlyALayerReadsAreNamed)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const Outcome outcome = render({"-o", "out.exr", "--aov", "pole"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("the first in node pole"), std::string::npos) << outcome.err;
    const image::Picture picture = image::read_picture(folder_ / "out.exr");
    for (const float value : image::find_layer(picture, "aov.pole")->pixels) EXPECT_EQ(value, 0.0f);
    EXPECT_EQ(render({"-o", "out.exr", "--aov", "pole", "--strict"}).exit_code, 2);
}

INSTANTIATE_TEST_SUITE_P(Backends, Aovs, testing::Values("cpu", "twin", "double", "opencl"),
                         [](const auto& info) { return info.param; });

class AovCommandLine : public testing::Test {
protected:
    AovCommandLine() { write_scene(folder_); }
    Outcome render(std::vector<std::string> more) const
    {
        std::vector<std::string> words = {"render", "--samples", "9", "--quiet", "-o", "out.exr"};
        words.insert(words.end(), painted_view.begin(), painted_view.end());
        words.insert(words.end(), more.begin(), more.end());
        return run_diptych(words, {.seconds = 200, .folder = folder_.path()});
    }
    TestFolder folder_;
};

TEST_F(AovCommandLine, AnUnknownNodeIsRefusedWithTheNamesThereAre)
{
    const Outcome unknown = render({"scene.gltf", "--aov", "paint", "--aov", "pint"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.err.find("--aov: \"pint\" names no texture node; there are 6: left, paint, "
                               "height, both, pole, open; name one of these"),
              std::string::npos)
        << unknown.err;
    EXPECT_EQ(unknown.err_lines().size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
    const Outcome demo = render({"--aov", "paint"});
    EXPECT_EQ(demo.exit_code, 2);
    EXPECT_NE(demo.err.find("--aov"), std::string::npos) << demo.err;
    EXPECT_NE(run_diptych({"render", "--help"}).out.find("--aov"), std::string::npos);
}

TEST_F(AovCommandLine, OpenclHasTheTwinsBits)
{
    std::vector<std::map<std::string, std::vector<float>>> layers;
    for (const char* backend : {"twin", "opencl"}) {
        const Outcome outcome = render({"scene.gltf", "--backend", backend, "--aov", "paint",
                                        "--aov", "open", "--aov", "both"});
        if (outcome.err.find("no OpenCL") != std::string::npos) GTEST_SKIP() << outcome.err;
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        layers.emplace_back();
        for (const image::Layer& layer : image::read_picture(folder_ / "out.exr").layers)
            layers.back()[layer.name] = layer.pixels;
    }
    EXPECT_EQ(layers[0], layers[1]);
    EXPECT_TRUE(layers[0].count("aov.open"));
}

}  // namespace
