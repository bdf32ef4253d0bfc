// The program as it is installed, run from elsewhere: it finds its texture tool and library.
#include "tests/debugger/textured_scene.hpp"
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

using namespace diptych;

namespace {

TEST(Installed, RunsATextureOfTheLibraryOnBothPanels)
{
    const TestFolder folder;
    const std::string prefix = folder / "prefix";
    const Outcome installed =
        run_program({DIPTYCH_CMAKE, "--install", DIPTYCH_BUILD, "--prefix", prefix});
    ASSERT_EQ(installed.exit_code, 0) << installed.text();
    std::filesystem::create_directories(folder / "elsewhere");
    write_painted_scene(folder);
    for (const std::string backend : {"cpu", "opencl"}) {
        const Outcome outcome =
            run_program({prefix + "/bin/diptych", "render", "../scene.gltf", "--texture",
                         "plain.baseColor=marble", "--samples", "1", "--size", "32x16", "--quiet",
                         "--backend", backend, "--generated-dir", "code", "-o", backend + ".png"},
                        {.seconds = 200,
                         .environment = {{"DIPTYCH_CACHE_DIR", folder / "cache"},
                                         {"DIPTYCH_TEXTURE_TOOL", ""},
                                         {"DIPTYCH_TEXTURE_LIBRARY", ""}},
                         .folder = folder / "elsewhere"});
        if (outcome.err.find("no OpenCL") != std::string::npos) continue;
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        EXPECT_TRUE(std::filesystem::exists(folder / ("elsewhere/" + backend + ".png")));
        std::ifstream in(folder / (backend == "cpu" ? "elsewhere/code/functions.hpp"
                                                    : "elsewhere/code/functions.cl"));
        const std::string code{std::istreambuf_iterator<char>(in),
                               std::istreambuf_iterator<char>()};
        EXPECT_NE(code.find(prefix + "/share/diptych/textures/marble.c"), std::string::npos)
            << "the library is taken from elsewhere";
    }
}

}  // namespace
