// The generated code of textures in people's hands, and a machine that cannot compile it.
#include "tests/debugger/textured_scene.hpp"
#include "tests/host/commands/program.hpp"

#include "host/image/image.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace diptych;

namespace {

class GeneratedCode : public testing::TestWithParam<std::string> {
protected:
    GeneratedCode() { write_painted_scene(folder_); }
    Outcome render(const std::vector<std::string>& more, const std::string& picture,
                   std::map<std::string, std::string> environment = {}) const
    {
        std::vector<std::string> words = {
            "render", folder_ / "scene.gltf", "--samples", "1", "--quiet", "--backend", GetParam(),
            "-o",     folder_ / picture};
        words.insert(words.end(), painted_view.begin(), painted_view.end());
        words.insert(words.end(), more.begin(), more.end());
        environment["DIPTYCH_CACHE_DIR"] = folder_ / "cache";
        return run_diptych(words, {.seconds = 200, .environment = environment});
    }
    bool is_usable() const
    {
        return GetParam() != "opencl" ||
               run_diptych({"devices"}).out.find("usable") != std::string::npos ||
               run_diptych({"render", "--size", "8x8", "--samples", "1", "--backend", "opencl",
                            "-o", folder_ / "trial.png"},
                           {.seconds = 200})
                       .exit_code == 0;
    }
    std::vector<float> pixels(const std::string& picture) const
    {
        return image::beauty_of(image::read_picture(folder_ / picture)).pixels;
    }
    std::string file() const
    {
        return GetParam() == "opencl" ? "code/functions.cl" : "code/functions.hpp";
    }
    std::string notice(const std::string& copy) const
    {
        return "--use-generated: " + (folder_ / copy) + ": made before the last edit of " +
               (folder_ / "paint.c") +
               ", and runs as it is; for that edit write it anew with --generated-dir";
    }
    void edit_texture() const
    {
        std::string source = painted_source;
        folder_.write("paint.c", source.replace(source.find("0.25f"), 5, "0.5f"));
    }
    std::string text() const
    {
        std::ifstream in(folder_ / file(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    TestFolder folder_;
};

TEST_P(GeneratedCode, AnEditedCopyRuns)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const std::string code = folder_ / "code";
    ASSERT_EQ(render({"--generated-dir", code}, "a.exr").exit_code, 0);
    const Outcome same = render({"--use-generated", code}, "b.exr");
    ASSERT_EQ(same.exit_code, 0) << same.text();
    EXPECT_EQ(pixels("a.exr"), pixels("b.exr"));

    std::string edited = text();
    const size_t at = edited.find("0.25f");
    ASSERT_NE(at, std::string::npos) << edited;
    folder_.write(file(), edited.replace(at, 5, "0.75f"));
    const Outcome other = render({"--use-generated", code}, "c.exr");
    ASSERT_EQ(other.exit_code, 0) << other.text();
    EXPECT_NE(pixels("a.exr"), pixels("c.exr"));
    EXPECT_EQ(render({}, "d.exr").exit_code, 0);
    EXPECT_EQ(pixels("a.exr"), pixels("d.exr"));
}

TEST_P(GeneratedCode, OtherTexturesAreRefused)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const std::string code = folder_ / "code";
    Outcome refused = render({"--use-generated", code}, "a.exr");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find(file() + ": cannot be read, or is empty; write it with"),
              std::string::npos)
        << refused.err;
    ASSERT_EQ(render({"--generated-dir", code}, "a.exr").exit_code, 0);
    std::string source = painted_source;
    source.replace(source.find("float scale, float3 tint"), 24, "float3 tint, float scale");
    folder_.write("paint.c", source);
    refused = render({"--use-generated", code}, "b.exr");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("does not name the textures of this scene"), std::string::npos)
        << refused.err;
    EXPECT_EQ(refused.err_lines().size(), 1u) << refused.err;
}

TEST_P(GeneratedCode, ACopyThatComputesWithItsLinesHasThoseOfTheTexture)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    std::string source = painted_source;
    folder_.write("paint.c", source.replace(source.find("0.25f"), 5, "0.1f * (float)__LINE__"));
    const std::string code = folder_ / "code";
    const Outcome made = render({"--generated-dir", code}, "a.exr");
    ASSERT_EQ(made.exit_code, 0) << made.text();
    ASSERT_EQ(render({"--use-generated", code}, "b.exr").exit_code, 0);
    EXPECT_EQ(pixels("a.exr"), pixels("b.exr"));
}

// It runs on as it was edited, but not without a word.
TEST_P(GeneratedCode, ACopyOlderThanAnEditOfTheTextureIsNamed)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const auto notices = [&](const std::vector<std::string>& flags, const std::string& picture) {
        std::vector<std::string> words = {"--json", folder_ / "report.json"};
        words.insert(words.end(), flags.begin(), flags.end());
        const Outcome outcome = render(words, picture);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        std::ifstream in(folder_ / "report.json");
        return nlohmann::json::parse(in).at("notices").get<std::vector<std::string>>();
    };
    const std::string sky = "lights: none in the scene; a neutral sky lights it";
    const std::string no_error = "fewer than 128 samples: no standard-error layer";
    const std::vector<std::string> usual = {sky, no_error};
    const std::string code = folder_ / "code";
    EXPECT_EQ(notices({"--generated-dir", code}, "a.exr"), usual);
    EXPECT_EQ(notices({"--use-generated", code}, "b.exr"), usual);
    edit_texture();
    EXPECT_EQ(notices({"--use-generated", code}, "c.exr"),
              (std::vector<std::string>{sky, notice(file()), no_error}));
    EXPECT_EQ(pixels("a.exr"), pixels("c.exr"));
    EXPECT_EQ(notices({"--generated-dir", code}, "d.exr"), usual);
    EXPECT_EQ(notices({"--use-generated", code}, "e.exr"), usual);
    EXPECT_EQ(pixels("d.exr"), pixels("e.exr"));
    EXPECT_NE(pixels("a.exr"), pixels("e.exr"));
}

TEST_P(GeneratedCode, ComparisonsAndDebuggersNameAnOlderCopyToo)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const std::string code = folder_ / "code";
    const auto run = [&](std::vector<std::string> words) {
        words.insert(words.begin() + 1, folder_ / "scene.gltf");
        words.insert(words.end(), painted_view.begin(), painted_view.end());
        const Outcome outcome = run_diptych(
            words, {.seconds = 200, .environment = {{"DIPTYCH_CACHE_DIR", folder_ / "cache"}}});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return outcome;
    };
    const auto notices_of_comparison = [&] {
        const Outcome outcome = run({"compare", "--backends", "twin," + GetParam(), "--samples",
                                     "1", "--use-generated", code, "--json", folder_ / "a.json"});
        std::ifstream in(folder_ / "a.json");
        const nlohmann::json report = nlohmann::json::parse(in);
        const auto notices = report.at("notices").get<std::vector<std::string>>();
        for (const std::string& line : notices)
            EXPECT_EQ(std::ranges::count(outcome.err_lines(), "notice: " + line), 1) << outcome.err;
        return notices;
    };
    const auto lines_of_debugger = [&] {
        return run({"debug", "--pixel", "12,8", "--texture", "paint", "--backend", "twin",
                    "--use-generated", code, "--print"})
            .err_lines();
    };
    for (const std::string& backend : {std::string("twin"), GetParam()})
        run({"render", "--backend", backend, "--generated-dir", code, "--samples", "1", "--quiet",
             "-o", folder_ / "a.exr"});
    std::vector<std::string> wanted = notices_of_comparison();
    EXPECT_EQ(lines_of_debugger(), std::vector<std::string>{});
    edit_texture();
    wanted.push_back(notice("code/functions.hpp"));
    if (GetParam() == "opencl") wanted.push_back(notice("code/functions.cl"));
    EXPECT_EQ(notices_of_comparison(), wanted);
    EXPECT_EQ(lines_of_debugger(),
              std::vector<std::string>{"notice: " + notice("code/functions.hpp")});
}

// By the lines of the copy, where the error is to be mended; not by those of the user's file.
TEST_P(GeneratedCode, AnErrorInAnEditedCopyNamesItsLine)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    const std::string code = folder_ / "code";
    ASSERT_EQ(render({"--generated-dir", code}, "a.exr").exit_code, 0);
    std::string edited = text();
    const size_t at = edited.find("0.25f");
    ASSERT_NE(at, std::string::npos) << edited;
    folder_.write(file(), edited.replace(at, 5, "0.25f0"));
    const Outcome refused = render({"--use-generated", code}, "b.exr");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find((folder_ / file()) + ":" +
                               std::to_string(line_of(edited, "0.25f0")) + ":"),
              std::string::npos)
        << refused.err;
    EXPECT_EQ(refused.err.find("paint.c"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.exr"));
    const std::string count = " error generated.";  // PoCL's word, if any
    EXPECT_EQ(refused.err.find(count), refused.err.rfind(count)) << refused.err;
}

// The panels part: one needs a compiler when it runs, the other brings its own.
TEST_P(GeneratedCode, WithoutACompilerOpenclStillRuns)
{
    if (!is_usable()) GTEST_SKIP() << "no OpenCL device";
    std::filesystem::create_directories(folder_ / "empty");
    const Outcome outcome = render({}, "a.exr", {{"PATH", folder_ / "empty"}});
    if (GetParam() == "opencl") {
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return;
    }
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    ASSERT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
    EXPECT_EQ(outcome.err_lines()[0],
              "diptych: procedural textures: no C++ compiler (g++, c++ or clang++) on the PATH, "
              "and this backend needs one; install it, set DIPTYCH_CXX, or use --backend opencl");
}

TEST_P(GeneratedCode, ACompilerThatMakesNothingIsNamed)
{
    if (GetParam() == "opencl") GTEST_SKIP() << "brings its own compiler";
    for (const auto& [program, wanted] :
         {std::pair{"/bin/true", "ends without an error, but made nothing"},
          {"/bin/false", "ends with exit code 1 and without a message"}}) {
        const Outcome outcome = render({}, "a.exr", {{"DIPTYCH_CXX", program}});
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        ASSERT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
        EXPECT_EQ(outcome.err_lines()[0], std::string("diptych: DIPTYCH_CXX: ") + program + ": " +
                                              wanted +
                                              " of the generated code; name a C++20 compiler, or "
                                              "unset it");
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, GeneratedCode, testing::Values("cpu", "twin", "opencl"),
                         [](const auto& info) { return info.param; });

}  // namespace
