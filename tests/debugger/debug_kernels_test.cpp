// --debug-kernels: gdb stops in a stage, at a line of the file that the GPU compiles, and reads a
// variable by its name.
#include "tests/host/commands/program.hpp"

#include "common/as_cpp/path_rows.hpp"
#include "host/commands/scene_flags.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

using namespace diptych;

namespace {

constexpr int pixel_x = 12, pixel_y = 20;

// "common/stages/evaluate_surface.h:95": where `text` stands in a source file.
std::string place_of(const std::string& file, const std::string& text)
{
    std::ifstream in(std::string(DIPTYCH_SOURCE) + "/" + file);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number)
        if (line.find(text) != std::string::npos) return file + ":" + std::to_string(number);
    return "";
}

// What a render of that one pixel prints under gdb with these commands, run in batch mode.
Outcome under_gdb(const std::vector<std::string>& commands)
{
    std::vector<std::string> words = {"gdb", "-batch", "-nx", "-iex", "set debuginfod enabled off"};
    for (const std::string& command : commands) words.insert(words.end(), {"-ex", command});
    const std::string pixel = std::to_string(pixel_x) + "," + std::to_string(pixel_y);
    for (const std::string& word :
         {std::string("--args"), diptych_program(), std::string("render"), std::string("--backend"),
          std::string("twin"), std::string("--debug-kernels"), std::string("--pixel"), pixel,
          std::string("--samples"), std::string("1"), std::string("--size"), std::string("32x32"),
          std::string("--threads"), std::string("1"), std::string("--quiet")})
        words.push_back(word);
    return run_program(words,
                       {.seconds = 120, .environment = {{"ASAN_OPTIONS", "detect_leaks=0"}}});
}

// Why gdb cannot be used here; empty if it can.
std::string why_no_gdb()
{
    const Outcome version = run_program({"gdb", "--version"});
    if (version.exit_code != 0) return "gdb is not installed";
    const Outcome trial = run_program({"gdb", "-batch", "-nx", "-ex", "run", "--args", "true"});
    if (trial.text().find("exited normally") == std::string::npos)
        return "gdb may not trace programs here: " + trial.text();
    return "";
}

// The position of the pixel's first hit, as the backend itself tells it.
std::vector<double> traced_position()
{
    SceneFlags flags;
    flags.size = "32x32";
    flags.samples = 1;
    SceneData scene = load_from_flags(flags);
    const auto twin = make_backend("twin", BackendOptions{});
    twin->upload(scene);
    const WorkItem item{pixel_x, pixel_y, 0, 0};
    std::vector<double> position;
    twin->trace({{&item, 1}, 1, 0}, [&](const StageState& state) {
        if (state.stage == STAGE_evaluate_surface && state.bounce == 0)
            position = state.planes[row_position];
    });
    return position;
}

TEST(DebugKernels, GdbStopsInAStageAndReadsALocalVariable)
{
    if (const std::string why = why_no_gdb(); !why.empty()) GTEST_SKIP() << why;
    const std::string place =
        place_of("common/stages/evaluate_surface.h", "set_position_error(paths, i");
    ASSERT_FALSE(place.empty());
    const Outcome outcome = under_gdb({"break " + place, "run", "print position"});
    const size_t at = outcome.out.find("$1 = {");
    ASSERT_NE(at, std::string::npos) << outcome.text();
    float seen[3] = {};
    ASSERT_EQ(std::sscanf(outcome.out.c_str() + at, "$1 = {x = %f, y = %f, z = %f}", &seen[0],
                          &seen[1], &seen[2]),
              3)
        << outcome.text();
    const std::vector<double> expected = traced_position();
    ASSERT_EQ(expected.size(), 3u);
    for (size_t c = 0; c < 3; ++c) EXPECT_EQ(seen[c], float(expected[c])) << outcome.text();
}

// As README tells it: by the stage's name, then line by line.
TEST(DebugKernels, GdbStopsAtAStageByItsName)
{
    if (const std::string why = why_no_gdb(); !why.empty()) GTEST_SKIP() << why;
    const Outcome outcome = under_gdb({"break sample_bsdf", "run", "next", "next", "next",
                                       "print throughput", "info locals", "backtrace 1"});
    EXPECT_NE(outcome.out.find("$1 = {x = 1, y = 1, z = 1}"), std::string::npos) << outcome.text();
    EXPECT_NE(outcome.out.find("stages/sample_bsdf.h:"), std::string::npos) << outcome.text();
    EXPECT_NE(outcome.out.find("face_normal = "), std::string::npos) << outcome.text();
}

}  // namespace
