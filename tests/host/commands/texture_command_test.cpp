// `diptych texture` as users meet it, and a node alone in a picture.
#include "tests/debugger/textured_scene.hpp"
#include "tests/host/commands/program.hpp"

#include "host/image/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <set>

using namespace diptych;

namespace {

const std::string shaded = R"(// Grey by height.
//
// scale (float, 1/m, above 0; default 2): how fast it grows
// tint (float3, linear Rec.709; default [1, 0.5, 0.25]): at the top
float3 shaded(float scale, float3 tint, const float* weights)
{
    const float open = readOcclusion("upper", scale);
    const float2 uv = readAttr("TexCoord0");
    return tint * (uv.y * scale * weights[0] * open);
}
)";

class TextureCommandLine : public testing::Test {
protected:
    TextureCommandLine() { folder_.write("shaded.c", shaded); }
    Outcome texture(std::vector<std::string> words,
                    std::map<std::string, std::string> environment = {}) const
    {
        words.insert(words.begin(), "texture");
        return run_diptych(words,
                           {.seconds = 200, .environment = environment, .folder = folder_.path()});
    }
    image::Picture preview(std::vector<std::string> more) const
    {
        std::vector<std::string> words = {"preview", "--size",  "64x32",     "--samples", "4",
                                          "-o",      "out.exr", "--backend", "twin"};
        words.insert(words.begin() + 1, more.begin(), more.end());
        const Outcome outcome = texture(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return image::read_picture(folder_ / "out.exr");
    }
    TestFolder folder_;
};

TEST_F(TextureCommandLine, HelpNamesOptionsAndExitCodes)
{
    EXPECT_NE(texture({"--help"}).out.find("Exit codes"), std::string::npos);
    EXPECT_NE(texture({"preview", "--help"}).out.find("--set"), std::string::npos);
    EXPECT_NE(texture({"cost", "--help"}).out.find("--backends"), std::string::npos);
    EXPECT_NE(run_diptych({"debug", "--help"}).out.find("Exit codes"), std::string::npos);
    for (const char* command : {"check", "show", "preview", "cost"}) {
        const Outcome refused = texture({command, "shaded.c", "--nonsense"});
        EXPECT_EQ(refused.exit_code, 2) << refused.text();
        EXPECT_NE(refused.err.find("--nonsense"), std::string::npos) << refused.err;
    }
}

TEST_F(TextureCommandLine, CheckSaysGoodOrWhatIsWrongAndWhere)
{
    const Outcome good = texture({"check", "shaded.c"});
    EXPECT_EQ(good.exit_code, 0) << good.text();
    EXPECT_EQ(good.err, "");
    EXPECT_NE(good.out.find("shaded.c: good: float3 shaded(float scale, float3 tint, float[]"),
              std::string::npos)
        << good.out;

    folder_.write("bad.c", "float bad(float x)\n{\n    return malloc(x);\n}\n");
    const Outcome bad = texture({"check", "bad.c"});
    EXPECT_EQ(bad.exit_code, 2) << bad.text();
    EXPECT_EQ(bad.out, "");
    EXPECT_EQ(bad.err.find("bad.c:3:"), 0u) << bad.err;
    EXPECT_NE(bad.err.find("error: "), std::string::npos) << bad.err;

    const Outcome missing = texture({"check", "nowhere.c"});
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_NE(missing.err.find("nowhere.c"), std::string::npos) << missing.err;
    EXPECT_EQ(texture({"check", "marble"}).exit_code, 0) << "of the library";
}

TEST_F(TextureCommandLine, ShowTellsArgumentsAttributesRequestsAndChangedLines)
{
    const Outcome shown = texture({"show", "shaded.c"});
    EXPECT_EQ(shown.exit_code, 0) << shown.text();
    for (const char* words : {"shaded.c:5: float3 shaded", "default 2; how fast it grows",
                              "default [1, 0.5, 0.25]; at the top", "float[]", "TexCoord0",
                              "above the surface, up to argument scale", "of 10 lines"})
        EXPECT_NE(shown.out.find(words), std::string::npos) << words << "\n" << shown.out;
    const Outcome code = texture({"show", "shaded.c", "--code", "opencl"});
    EXPECT_NE(code.out.find("#line"), std::string::npos) << code.text();
}

TEST_F(TextureCommandLine, PreviewShowsTheValuesThatAreSet)
{
    const auto mean_of = [](const image::Picture& picture, int channel) {
        double sum = 0;
        const std::vector<float>& pixels = image::beauty_of(picture).pixels;
        for (size_t k = size_t(channel); k < pixels.size(); k += 4) sum += pixels[k];
        return sum / (picture.width * picture.height);
    };
    const image::Picture dark = preview({"shaded.c", "--set", "tint=[0, 0, 0]"});
    const image::Picture red = preview({"shaded.c", "--set", "tint=[1, 0, 0]"});
    EXPECT_GT(mean_of(red, 0), mean_of(dark, 0) * 1.1);
    EXPECT_NEAR(mean_of(red, 2), mean_of(dark, 2), mean_of(dark, 2) * 0.02);

    const Outcome guessed = texture({"preview", "shaded.c", "--size", "16x8", "--samples", "1"});
    EXPECT_NE(guessed.err.find("argument weights"), std::string::npos) << guessed.text();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "preview.png"));
}

TEST_F(TextureCommandLine, PreviewRefusesWhatMakesNoSense)
{
    const auto expect_refusal = [&](const std::vector<std::string>& more, const char* names) {
        std::vector<std::string> words = {"preview", "shaded.c"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = texture(words);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        EXPECT_NE(outcome.err.find(names), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "preview.png"));
    };
    expect_refusal({"--set", "colour=[1,1,1]"}, "scale, tint, weights");
    expect_refusal({"--set", "tint=[1,1]"}, "tint");
    expect_refusal({"--set", "tint=red"}, "JSON");
    expect_refusal({"--set", "scale=\"high\""}, "float");
    expect_refusal({"--slot", "colour"}, "baseColor");
    expect_refusal({"--size", "0x4"}, "--size");
    expect_refusal({"-o", "out.bmp"}, "out.bmp");
}

TEST_F(TextureCommandLine, PreviewNamesACopyOlderThanAnEdit)
{
    const auto lines = [&](const std::string& flag) {
        const Outcome outcome =
            texture({"preview", "shaded.c", "--set", "weights=[1]", "--size", "32x16", "--samples",
                     "1", "-o", "out.exr", "--backend", "twin", flag, "code"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return outcome.err_lines();
    };
    const std::vector<std::string> usual = lines("--generated-dir");
    EXPECT_EQ(lines("--use-generated"), usual);
    folder_.write("shaded.c", shaded + "// edited\n");
    std::vector<std::string> wanted = usual;
    wanted.push_back("notice: --use-generated: code/functions.hpp: made before the last edit of " +
                     (folder_ / "shaded.c") +
                     ", and runs as it is; for that edit write it anew with --generated-dir");
    EXPECT_EQ(lines("--use-generated"), wanted);
}

TEST_F(TextureCommandLine, CostMeasuresBackendsAndComparesTheirValues)
{
    const Outcome outcome = texture({"cost", "shaded.c", "--backends", "cpu,twin,double"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    for (const char* backend : {"cpu ", "twin ", "double "}) {
        const size_t at = outcome.out.find(std::string("\n") + backend);
        ASSERT_NE(at, std::string::npos) << outcome.text();
        double texture = 0, constant = 0, rays = 0;
        EXPECT_EQ(
            std::sscanf(outcome.out.c_str() + at, "\n%*s %lf %lf %lf", &texture, &constant, &rays),
            3)
            << outcome.text();
        EXPECT_GT(texture, constant) << outcome.text();
        EXPECT_GT(constant, 0);
        EXPECT_GT(rays, 0);
    }
    EXPECT_NE(outcome.out.find("sm_80"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("gfx900"), std::string::npos) << outcome.out;
    EXPECT_EQ(texture({"cost", "shaded.c", "--backends", "abacus"}).exit_code, 2);
}

// OpenCL is measured without twin, and the card says for what reason it has nothing to compare to.
TEST_F(TextureCommandLine, CostSaysWhyTwinGivesNoValues)
{
    const auto row = [&](const std::map<std::string, std::string>& environment) {
        const Outcome outcome = texture({"cost", "shaded.c", "--backends", "opencl"}, environment);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        const size_t at = outcome.out.find("\nopencl ");
        return at == std::string::npos
                   ? outcome.text()
                   : outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
    };
    const std::string compared = row({});
    if (compared.find("not measured: ") != std::string::npos) GTEST_SKIP() << compared;
    EXPECT_TRUE(compared.ends_with("none, bit for bit")) << compared;
    for (const auto& [environment, wanted] :
         {std::pair<std::map<std::string, std::string>, std::string>{
              {{"PATH", folder_ / "empty"}},
              "procedural textures: no C++ compiler (g++, c++ or clang++) on the PATH, and this "
              "backend needs one; install it, set DIPTYCH_CXX, or use --backend opencl"},
          {{{"DIPTYCH_CXX", "/bin/false"}},
           "DIPTYCH_CXX: /bin/false: ends with exit code 1 and without a message of the generated "
           "code; name a C++20 compiler, or unset it"}}) {
        const std::string alone = row(environment);
        EXPECT_TRUE(alone.ends_with("  not compared: " + wanted)) << alone;
    }
}

// As the texture computes it at the middle of a pixel: see painted_source.
TEST_F(TextureCommandLine, SoloShowsTheRawValueOfANode)
{
    write_painted_scene(folder_);
    const auto pixel = [&](const std::string& node, const std::string& place) {
        std::vector<std::string> words = {"render",  "scene.gltf", "--solo",  node,
                                          "--pixel", place,        "--quiet", "--samples",
                                          "64",      "--backend",  "twin"};
        words.insert(words.end(), painted_view.begin(), painted_view.end());
        const Outcome outcome = run_diptych(words, {.seconds = 200, .folder = folder_.path()});
        std::array<double, 3> value{};
        const size_t at = outcome.out.find(": ");
        EXPECT_TRUE(at != std::string::npos &&
                    std::sscanf(outcome.out.c_str() + at, ": %lf %lf %lf", &value[0], &value[1],
                                &value[2]) == 3)
            << outcome.text();
        return value;
    };
    // One pixel is 2 * 2 tan(20 degrees) / 20 m wide at the squares.
    const double step = 4 * std::tan(20 * 3.14159265358979 / 180) / 20;
    const double x = 1 + (12.5 - 20) * step, y = 0.5 - (8.5 - 10) * step;
    const auto wave = [&](double scale) { return std::pow(std::sin(x * scale), 2); };
    const std::array<double, 3> paint = pixel("paint", "12,8");
    EXPECT_NEAR(paint[0], 0.5 * wave(7), 0.02);
    EXPECT_NEAR(paint[1], 0.75 * y, 0.003);
    EXPECT_NEAR(paint[2], 0.25, 1e-6);
    EXPECT_NEAR(pixel("left", "12,8")[0], wave(2), 0.02);
    EXPECT_EQ(pixel("paint", "30,8"), (std::array<double, 3>{0, 0, 0})) << "another material";
    EXPECT_EQ(pixel("paint", "0,0"), (std::array<double, 3>{0, 0, 0})) << "no surface";
}

// The paper's figure 2: materials' pages name the regions of their arguments and the programs.
TEST_F(TextureCommandLine, TX_6_MemoryShowsPagesRegionsAndPrograms)
{
    write_painted_scene(folder_);
    const Outcome shown = texture({"memory", folder_ / "scene.gltf"});
    ASSERT_EQ(shown.exit_code, 0) << shown.text();
    for (const char* text :
         {"material painted: runs the program on page", "material plain\n", "region on page",
          "arguments of node paint on painted: userProc in ", "float3    tint", "[0.5,0.75,1.0]",
          "program of painted", "run node left", "run node paint"})
        EXPECT_NE(shown.out.find(text), std::string::npos) << text << "\n" << shown.out;

    const Outcome written = texture({"memory", folder_ / "scene.gltf", "--json", "-"});
    const nlohmann::json memory = nlohmann::json::parse(written.out);
    ASSERT_EQ(memory.at("materials").size(), 2u);
    ASSERT_EQ(memory.at("regions").size(), 2u);
    ASSERT_EQ(memory.at("programs").size(), 1u);
    EXPECT_EQ(memory["materials"][0]["program_page"], memory["programs"][0]["page"]);
    EXPECT_FALSE(memory["materials"][1].contains("program_page"));
    EXPECT_EQ(memory["programs"][0]["steps"].size(), 2u);
    std::set<int> pages;  // nothing lies on a page of something else
    for (const auto& region : memory["regions"])
        for (int k = 0; k < region["pages"]; ++k)
            EXPECT_TRUE(pages.insert(int(region["page"]) + k).second);
    EXPECT_TRUE(pages.insert(int(memory["programs"][0]["page"])).second);
    EXPECT_GE(*pages.begin(), 2);
    EXPECT_LT(*pages.rbegin(), memory["pages"]);
    for (const auto& step : memory["programs"][0]["steps"])
        EXPECT_EQ(pages.count(int(step["region"]) / int(memory["page_words"])), 1u);
    EXPECT_EQ(texture({"memory"}).exit_code, 2);
}

}  // namespace
