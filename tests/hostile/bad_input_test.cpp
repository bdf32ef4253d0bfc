// Each kind of bad input of a render, given to the program itself.
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace {

// A triangle in a data URI; `edit` replaces one part of the text by another.
std::string triangle(const std::string& from = "", const std::string& to = "")
{
    std::string text = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0, "material": 0}]}],
 "materials": [{"pbrMetallicRoughness": {}}],
 "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,)"
                       "AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA="
                       R"("}],
 "bufferViews": [{"buffer": 0, "byteLength": 6}, {"buffer": 0, "byteOffset": 8, "byteLength": 36}],
 "accessors": [{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3",
   "min": [0, 0, 0], "max": [1, 1, 0]}]})";
    if (!from.empty()) {
        const size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    }
    return text;
}

std::string textured(const std::string& image)
{
    return triangle(R"([{"pbrMetallicRoughness": {}}])",
                    R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
 "textures": [{"source": 0}], "images": [{"uri": ")" +
                        image + R"("}])");
}

std::string big_endian(unsigned value)
{
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

// The head of a PNG picture of that size; CRC as for 60000 x 60000 or 0 x 0 does not matter.
std::string png_head(unsigned width, unsigned height)
{
    return std::string("\x89PNG\r\n\x1a\n", 8) + big_endian(13) + "IHDR" + big_endian(width) +
           big_endian(height) + std::string("\x08\x02\0\0\0\0\0\0\0", 9);
}

class BadInput : public testing::Test {
protected:
    // Renders with `more` words; the only picture would be out.exr in out_.
    Outcome render(const std::vector<std::string>& more, const RunOptions& options = {})
    {
        std::vector<std::string> words = {"render", "--quiet", "-o", out_ / "out.exr"};
        words.insert(words.end(), more.begin(), more.end());
        return run_diptych(words, options);
    }

    void expect_refusal(const std::vector<std::string>& words, const std::string& where,
                        const RunOptions& options = {})
    {
        const Outcome outcome = render(words, options);
        SCOPED_TRACE(outcome.text());
        EXPECT_EQ(outcome.exit_code, 2);
        const std::vector<std::string> lines = outcome.err_lines();
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_EQ(lines[0].find("diptych: "), 0u);
        EXPECT_NE(lines[0].find(where), std::string::npos) << where;
        EXPECT_NE(lines[0].find(';'), std::string::npos) << "says what to do";
        EXPECT_TRUE(out_.files().empty());
    }

    void expect_file_refused(const std::string& name, const std::string& bytes)
    {
        SCOPED_TRACE(name);
        expect_refusal({in_.write(name, bytes)}, name);
    }

    const TestFolder in_, out_;
};

TEST_F(BadInput, TheTriangleItselfIsFine)
{
    const Outcome outcome =
        render({in_.write("fine.gltf", triangle()), "--size", "16x16", "--samples", "1"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_EQ(out_.files(), std::vector<std::string>{"out.exr"});
}

TEST_F(BadInput, FilesThatAreNoScene)
{
    expect_refusal({in_ / "absent.gltf"}, "absent.gltf");
    expect_refusal({in_.path().string()}, in_.path().filename().string());
    expect_file_refused("empty.gltf", "");
    expect_file_refused("empty.glb", "");
    expect_file_refused("magic.glb", std::string("gltF\2\0\0\0\x0c\0\0\0", 12));
    expect_file_refused("header.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12));
    const std::string glb = std::string("glTF\2\0\0\0\x00\4\0\0\x00\3\0\0JSON", 20) + triangle();
    expect_file_refused("truncated.glb", glb.substr(0, 200));
    expect_file_refused("noise.gltf", "\x01\x02 not a scene");
    expect_file_refused("scene.obj", "v 0 0 0\n");
}

TEST_F(BadInput, NumbersThatPointNowhere)
{
    expect_file_refused("material.gltf", triangle("\"material\": 0", "\"material\": 9"));
    expect_file_refused("mesh.gltf", triangle("\"mesh\": 0", "\"mesh\": 7"));
    expect_file_refused("accessor.gltf", triangle("\"POSITION\": 1", "\"POSITION\": 5"));
    expect_file_refused("view.gltf", triangle("\"bufferView\": 1", "\"bufferView\": 8"));
    expect_file_refused("index.gltf", triangle("AAABAAIA", "AAABAAkA"));
    expect_file_refused("beyond.gltf", triangle("\"count\": 3, \"type\": \"VEC3\"",
                                                "\"count\": 4, \"type\": \"VEC3\""));
    expect_file_refused("huge.gltf", triangle("\"count\": 3, \"type\": \"VEC3\"",
                                              "\"count\": 4000000000, \"type\": \"VEC3\""));
    expect_file_refused("length.gltf",
                        triangle("\"byteLength\": 44", "\"byteLength\": 4000000000"));
    expect_file_refused("cycle.gltf",
                        triangle("{\"mesh\": 0}", "{\"mesh\": 0, \"children\": [0]}"));
}

TEST_F(BadInput, PositionsThatAreNoNumbers)
{
    expect_file_refused("nan.gltf", triangle("AAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=",
                                             "AAAAAMB/AAAAAAAAAAAAAAAAAACAPwAAAAA="));
    expect_file_refused("infinite.gltf", triangle("AAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=",
                                                  "AAAAgH8/AAAAAAAAAAAAAAAAAACAf39/AAA="));
}

TEST_F(BadInput, ImagesThatCannotBeRead)
{
    expect_file_refused("missing.gltf", textured("no_such.png"));
    in_.write("corrupt.png", png_head(16, 16) + "nonsense");
    expect_file_refused("corrupt.gltf", textured("corrupt.png"));
    in_.write("bomb.png", png_head(60000, 60000));
    expect_file_refused("bomb.gltf", textured("bomb.png"));
    in_.write("zero.png", png_head(0, 16));
    expect_file_refused("zero.gltf", textured("zero.png"));
    in_.write("empty.png", "");
    expect_file_refused("empty.gltf", textured("empty.png"));
    expect_file_refused("outside.gltf", textured("../outside.png"));
}

TEST_F(BadInput, EnvironmentsThatCannotBeRead)
{
    const std::string scene = in_.write("fine.gltf", triangle());
    expect_refusal({scene, "--env", in_ / "absent.hdr"}, "absent.hdr");
    expect_refusal({scene, "--env", in_.write("bad.exr", "v/1\x01 not really")}, "bad.exr");
    expect_refusal({scene, "--env-scale", "-1"}, "--env-scale");
    expect_refusal({scene, "--env-scale", "inf"}, "--env-scale");
    expect_refusal({scene, "--env-rotation", "nan"}, "--env-rotation");
}

TEST_F(BadInput, ABlackEnvironmentIsDarkAndNoError)
{
    const std::string pixel(4, '\0');
    const std::string black =
        in_.write("black.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + pixel);
    for (const char* backend : {"cpu", "twin", "double"}) {
        const Outcome outcome =
            render({"--env", black, "--size", "16x16", "--samples", "1", "--backend", backend});
        EXPECT_EQ(outcome.exit_code, 0) << backend << outcome.text();
    }
}

TEST_F(BadInput, SizesAndSamplesOfNoSense)
{
    for (const char* size : {"0x0", "16x0", "-4x4", "16", "x", "16x16x16", "99999x1", "60000x60000",
                             "1e3x2", "99999999999999999999x1"})
        expect_refusal({"--size", size}, "--size");
    for (const char* samples : {"0", "-1", "999999999"})
        expect_refusal({"--samples", samples}, "--samples");
    expect_refusal({"--samples", "99999999999999999999"}, "--samples");
    for (const char* pixel : {"5", "16,0", "-1,0", "a,b", "1,2,3"})
        expect_refusal({"--size", "16x16", "--pixel", pixel}, "--pixel");
    for (const char* memory : {"0", "-5M", "lots", "nan", "9999999999999G"})
        expect_refusal({"--memory", memory}, "--memory");
    for (const char* bounces : {"-1", "many", "1.5"})
        expect_refusal({"--bounces", bounces}, "--bounces");
    for (const char* fov : {"0", "180", "nan"}) expect_refusal({"--fov", fov}, "--fov");
    expect_refusal({"--eye", "1,2"}, "--eye");
    expect_refusal({"--eye", "1,2,3", "--target", "1,2,3"}, "--target");
    expect_refusal({"--eye", "1,2,3", "--target", "1,nan,3"}, "--target");
    expect_refusal({"--filter", "gauss"}, "--filter");
    expect_refusal({"--view", "sepia"}, "--view");
    expect_refusal({"--exposure", "nan"}, "--exposure");
    expect_refusal({in_.write("fine.gltf", triangle()), "--camera", "7"}, "7");
}

TEST_F(BadInput, TargetsOfNoSense)
{
    for (const char* error : {"0", "-1", "nan", "inf", "1e9", "much"})
        expect_refusal({"--error", error}, "--error");
    for (const char* time : {"0", "0s", "-3s", "nan", "5x", "s", "inf"})
        expect_refusal({"--time", time}, "--time");
    expect_refusal({"--refresh", "0"}, "--refresh");
    expect_refusal({"--preview", "eog"}, "--preview");
    expect_refusal({"--memory", "20K", "--backend", "cpu"}, "--memory");
    expect_refusal({"--memory", "20K", "--backend", "twin"}, "--memory");
    expect_refusal({"--unbiased"}, "--unbiased");
    expect_refusal({"--unbiased", "--error", "1", "--time", "1s"}, "--unbiased");
    expect_refusal({"--unbiased", "--error", "1", "--samples", "64"}, "--samples");
    expect_refusal({"--error", "1", "--pixel", "1,1"}, "--pixel");
    expect_refusal({"--audit", "--samples", "64"}, "--audit");
}

// Refused before anything is rendered: these would take hours.
TEST_F(BadInput, PicturesThatCannotBeWritten)
{
    const auto refuse = [&](const std::string& path) {
        SCOPED_TRACE(path);
        expect_refusal({"--samples", "1000000", "-o", path}, path);
    };
    refuse(out_ / "no/such/folder.exr");
    refuse(out_ / "picture.xyz");
    refuse(out_ / "picture");
    refuse("/proc/diptych.exr");
    refuse(in_.path().string());
    expect_refusal({"--samples", "1000000", "--json", out_ / "no/such/report.json"}, "report.json");
}

TEST_F(BadInput, NoOpenclPlatform)
{
    expect_refusal({"--backend", "opencl"}, "opencl",
                   {.environment = {{"OCL_ICD_VENDORS", "/nowhere"}}});
}

TEST_F(BadInput, TooLittleMemory)
{
    if (run_diptych({"devices"}).out.find("can be used") == std::string::npos)
        GTEST_SKIP() << "no usable OpenCL device";
    expect_refusal({"--backend", "opencl", "--memory", "1K"}, "--memory");
    expect_refusal({"--backend", "opencl", "--device", "99"}, "99");
    expect_refusal({"--backend", "opencl", "--device", "abacus"}, "abacus");
}

// A scene without triangles is no mistake: its background is the picture.
TEST_F(BadInput, NothingToSeeIsNoError)
{
    for (const std::string& scene :
         {in_.write("points.gltf", triangle("\"indices\": 0", "\"mode\": 0")),
          in_.write("lines.gltf", triangle("\"indices\": 0", "\"mode\": 1")),
          in_.write("empty.gltf", R"({"asset": {"version": "2.0"}})"),
          in_.write("no_area.gltf", triangle("AAABAAIA", "AAAAAAIA"))}) {
        const Outcome outcome = run_diptych(
            {"render", scene, "--size", "16x16", "--samples", "1", "-o", out_ / "background.exr"});
        EXPECT_EQ(outcome.exit_code, 0) << scene << outcome.text();
        EXPECT_NE(outcome.err.find("notice: "), std::string::npos) << scene << outcome.text();
    }
}

// Emission beyond what a float holds.
std::string blinding()
{
    return triangle(R"({"pbrMetallicRoughness": {}})",
                    R"({"emissiveFactor": [1, 1, 1], "doubleSided": true,
 "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3e38}}})");
}

TEST_F(BadInput, WhatIsNotFiniteNeverReachesAPicture)
{
    const std::string scene = in_.write("blinding.gltf", blinding());
    const std::vector<std::string> view = {scene,   "--size",    "16x16",    "--samples", "8",
                                           "--eye", "0.3,0.3,2", "--target", "0.3,0.3,0"};
    const Outcome outcome = run_diptych([&] {
        std::vector<std::string> words = {"render", "-o", out_ / "out.exr", "--backend", "twin"};
        words.insert(words.end(), view.begin(), view.end());
        return words;
    }());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("samples were not finite and were dropped, the first at pixel"),
              std::string::npos)
        << outcome.text();
    std::vector<std::string> pixel = view;
    pixel.insert(pixel.end(), {"--pixel", "8,8"});
    EXPECT_EQ(render(pixel).out, "pixel 8,8: 0 0 0\n");
}

TEST_F(BadInput, StrictMakesWhatIsNotFiniteAnError)
{
    const std::string scene = in_.write("blinding.gltf", blinding());
    expect_refusal({scene, "--size", "16x16", "--samples", "8", "--eye", "0.3,0.3,2", "--target",
                    "0.3,0.3,0", "--strict"},
                   "pixel");
}

}  // namespace
