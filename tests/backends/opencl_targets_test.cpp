// Every program, as flattened and embedded, compiles for GPUs of two makers and as a portable
// module. Needs clang; links OpenCL's functions from libclc where the target has it.
#include "backends/kernel_sources.hpp"

#include "backends/backend.hpp"
#include "backends/textures/texture_source.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace diptych;
namespace fs = std::filesystem;

namespace {

struct Target {
    const char* name;
    const char* flags;
    const char* library;  // of libclc; "": compile only
};
const Target targets[] = {
    {"nvptx64", "-target nvptx64--nvidiacl -S", "nvptx64--nvidiacl.bc"},
    {"amdgcn", "-target amdgcn--amdhsa -nogpulib -mcpu=gfx900 -S", "amdgcn--amdhsa.bc"},
    {"spir64", "-target spir64 -S -emit-llvm", ""},
};

// The program of a stage; the one that holds users' textures with one that adds 1 to an argument.
std::string program_of(Stage stage)
{
    if (stage != STAGE_evaluate_textures) return kernel_source(stage);
    TextureFunction function;
    function.id = "t0";
    function.opencl = "static float4 t0_entry(TextureContext* tx, int region)\n"
                      "{\n"
                      "    return (float4)(tx_argument_float(tx, region, 0) + 1.0f, tx->uv0.x, "
                      "tx->uv0.y, 1.0f);\n"
                      "}\n";
    SceneData scene;
    scene.textures.functions.push_back(function);
    scene.textures.attributes = ~0u;
    return opencl_texture_program(scene, kernel_source(stage));
}

int run(const std::string& command) { return std::system(command.c_str()); }

// "" if there is none.
std::string find_clang()
{
    std::vector<std::string> names = {"clang"};
    for (int version = 22; version >= 14; --version)
        names.push_back("clang-" + std::to_string(version));
    for (const std::string& name : names)
        if (run("command -v " + name + " >/dev/null 2>&1") == 0) return name;
    return "";
}

std::string find_library(const std::string& name)
{
    for (const char* folder : {"/usr/lib/clc", "/usr/share/clc", "/usr/local/lib/clc"})
        if (fs::exists(fs::path(folder) / name)) return fs::path(folder) / name;
    return "";
}

std::string text_of(const fs::path& path)
{
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class OpenclTargets : public testing::TestWithParam<Target> {
protected:
    void SetUp() override
    {
        clang_ = find_clang();
        if (clang_.empty()) GTEST_SKIP() << "no clang on the PATH";
        folder_ = fs::temp_directory_path() / (std::string("diptych-targets-") + GetParam().name);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void compile(Stage stage, unsigned effects)
    {
        const fs::path source = folder_ / (std::string(stage_names[stage]) + ".cl");
        std::ofstream(source) << program_of(stage);
        const std::string library = find_library(GetParam().library);
        const bool links = *GetParam().library && !library.empty();
        const std::string command =
            clang_ + " -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -O1 -Wall -Werror" +
            " -Wno-unused-function -Wno-unknown-warning-option " + GetParam().flags +
            (links ? " -Xclang -mlink-builtin-bitcode -Xclang " + library : "") +
            " -D FAULT=FAULT_none -D GROUP_SIZE=64 -D PAGE_SHIFT=0 -D EFFECTS=" +
            std::to_string(effects) + " " + source.string() + " -o " + (folder_ / "out").string() +
            " 2> " + (folder_ / "log").string();
        EXPECT_EQ(run(command), 0) << command << "\n" << text_of(folder_ / "log");
    }

    std::string clang_;
    fs::path folder_;
};

TEST_P(OpenclTargets, CompileEveryStageWithAllEffectsAndWithNone)
{
    for (int stage = 0; stage < STAGE_COUNT; ++stage)
        for (const unsigned effects : {0u, ~0u >> 1}) compile(Stage(stage), effects);
}

// Each effect without its neighbours in the list: what one uses, it must bring along.
TEST_P(OpenclTargets, CompileEveryStageWithEveryOtherEffect)
{
    if (GetParam().name != std::string("spir64")) GTEST_SKIP() << "one target is enough";
    for (int stage = 0; stage < STAGE_COUNT; ++stage)
        for (const unsigned effects : {0x55555555u, 0x2aaaaaaau}) compile(Stage(stage), effects);
}

INSTANTIATE_TEST_SUITE_P(All, OpenclTargets, testing::ValuesIn(targets),
                         [](const auto& info) { return std::string(info.param.name); });

// The texts must serve on any machine.
TEST(KernelSources, NameFilesRelativeToTheTree)
{
    for (int stage = 0; stage < STAGE_COUNT; ++stage) {
        const std::string source = kernel_source(Stage(stage));
        EXPECT_NE(source.find("#line 1 \"kernels_cl/"), std::string::npos);
        EXPECT_EQ(source.find(" \"/"), std::string::npos) << stage_names[stage];
        EXPECT_NE(source.find("#pragma OPENCL FP_CONTRACT OFF"), std::string::npos);
        EXPECT_EQ(source.find("#if"), std::string::npos);
    }
}

}  // namespace
