// The command line as users meet it: help, mistakes, exit codes.
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sys/resource.h>

namespace {

const std::vector<std::string> commands = {"render",   "compare", "explain", "devices",
                                           "selftest", "merge",   "farm",    "watch",
                                           "texture",  "debug",   "study"};

TEST(CommandLine, HelpIsThereForEveryCommandAndNamesExitCodes)
{
    const Outcome all = run_diptych({"--help"});
    EXPECT_EQ(all.exit_code, 0);
    for (const std::string& command : commands) {
        EXPECT_NE(all.out.find(command), std::string::npos) << command;
        const Outcome help = run_diptych({command, "--help"});
        EXPECT_EQ(help.exit_code, 0) << command;
        EXPECT_NE(help.out.find("xit code"), std::string::npos) << command << "\n" << help.out;
        EXPECT_EQ(help.err, "");
    }
    EXPECT_NE(run_diptych({"--version"}).out.find("diptych 0."), std::string::npos);
}

TEST(CommandLine, RenderHelpNamesEveryOption)
{
    const std::string help = run_diptych({"render", "--help"}).out;
    for (const char* flag : {"SCENE",           "--output",       "--backend",   "--device",
                             "--size",          "--samples",      "--seed",      "--threads",
                             "--memory",        "--env",          "--camera",    "--eye",
                             "--target",        "--up",           "--fov",       "--pixel",
                             "--bounces",       "--filter",       "--quiet",     "--strict",
                             "--json",          "--exposure",     "--view",      "--reproducible",
                             "--launch-ms",     "--share",        "--fast-math", "--debug-kernels",
                             "--allow-outside", "--env-rotation", "--env-scale"})
        EXPECT_NE(help.find(flag), std::string::npos) << flag;
}

// One line that begins "diptych: " and the exit code 2.
void expect_refusal(const std::vector<std::string>& arguments, const std::string& names)
{
    const Outcome outcome = run_diptych(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    const std::vector<std::string> lines = outcome.err_lines();
    ASSERT_EQ(lines.size(), 1u) << outcome.text();
    EXPECT_EQ(lines[0].find("diptych: "), 0u) << lines[0];
    EXPECT_NE(lines[0].find(names), std::string::npos) << lines[0];
    EXPECT_EQ(outcome.out, "");
}

// What would be ignored, or replace something, is refused.
TEST(CommandLine, FlagsWithoutEffectAreRefused)
{
    const auto refuse = [](std::vector<std::string> words, const std::string& names) {
        words.insert(words.begin(), {"render", "--size", "8x8", "--samples", "1"});
        expect_refusal(words, names);
    };
    const std::vector<std::string> view = {"--eye", "0,1,3", "--target", "0,1,0"};
    const auto seen = [&](std::vector<std::string> more) {
        more.insert(more.end(), view.begin(), view.end());
        return more;
    };
    refuse({"--camera", "nosuch"}, "--camera");
    refuse({"--scene", "1"}, "--scene");
    refuse({"--fov", "5"}, "--eye");
    refuse({"--up", "1,0,0"}, "--eye");
    refuse(seen({"--camera", "nosuch"}), "--camera nosuch");
    refuse(seen({"--up", "0,0,0"}), "--up 0,0,0");
    refuse({"--fast-math"}, "--backend opencl");
    refuse({"--seed", "-1"}, "4294967295");
    refuse({"--half"}, ".exr");
    refuse({"--half", "-o", "a.png", "-o", "b.tif"}, ".exr");
    refuse({"--16bit", "-o", "a.exr", "-o", "b.jpg"}, ".png and .tif");
    refuse({"-o", "a.png", "-o", "./a.png"}, "two outputs");
    refuse({"-o", "a.png", "--json", "a.png"}, "two outputs");
    for (const char* flag : {"--json", "--env", "--camera", "--device", "--checkpoint", "-o"})
        refuse({flag, ""}, "is empty");
    expect_refusal({"render", ""}, "SCENE");
    const Outcome cost =  // a command without --backend knows where it means something
        run_diptych({"texture", "cost", "checker", "--backends", "cpu", "--fast-math"});
    EXPECT_EQ(cost.exit_code, 0) << cost.text();
    expect_refusal({"compare", "a.exr", "b.exr", "--manifest", "m.json"}, "leave out A, B");
    expect_refusal({"compare", "--manifest", "m.json", "--metric", "rmse", "--max", "0"}, "--max");
    expect_refusal({"compare", "--manifest", "/tmp"}, "is a folder");
}

TEST(CommandLine, WhatCannotBePrintedIsAnError)
{
    const Outcome full = run_program({"sh", "-c", diptych_program() + " --help > /dev/full"});
    const Outcome devices = run_program({"sh", "-c", diptych_program() + " devices > /dev/full"});
    EXPECT_EQ(devices.exit_code, 2) << devices.text();
    EXPECT_NE(devices.err.find("standard output"), std::string::npos) << devices.text();
    EXPECT_EQ(full.exit_code, 2) << full.text();
}

TEST(CommandLine, AReportOnStandardOutputIsAlone)
{
    const Outcome one = run_diptych(
        {"render", "--size", "8x8", "--samples", "1", "--pixel", "3,3", "--quiet", "--json", "-"});
    EXPECT_EQ(one.exit_code, 0) << one.text();
    EXPECT_EQ(one.out.find('{'), 0u) << one.out;
    EXPECT_NE(one.err.find("pixel 3,3: "), std::string::npos) << one.err;
}

TEST(CommandLine, AReportHoldsTheNoticesOfTheTerminal)
{
    const auto missing = [](const char* samples, std::vector<std::string> more) {
        more.insert(more.begin(), {"render", "--size", "8x8", "--samples", samples, "--json", "-",
                                   "-o", std::filesystem::temp_directory_path() / "notices.exr"});
        const Outcome outcome = run_diptych(more);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        const std::string tail = "no standard-error layer";
        const std::string notices = outcome.out.substr(outcome.out.find("\"notices\""));
        EXPECT_EQ(outcome.err.find(tail) == std::string::npos,
                  notices.find(tail) == std::string::npos)
            << outcome.text();
        const size_t end = notices.find(tail);
        const size_t begin = notices.rfind('"', end);
        return end == std::string::npos ? "" : notices.substr(begin + 1, end - begin - 1);
    };
    EXPECT_EQ(missing("16", {}), "fewer than 128 samples: ");
    EXPECT_EQ(missing("128", {"--one-sequence"}), "--one-sequence: ");
    EXPECT_EQ(missing("128", {}), "");
}

TEST(CommandLine, MistakesAreToldInOneLine)
{
    expect_refusal({}, "--help");
    expect_refusal({"paint"}, "paint");
    for (const std::string& command : commands)
        expect_refusal({command, "--nonsense"}, "see diptych " + command + " --help");
    for (const char* command : {"render", "compare", "explain", "devices", "selftest"})
        expect_refusal({command, "--nonsense"}, "--nonsense");  // others ask for their scene first
    expect_refusal({"render", "--error", "0"}, "from 0.01 to 100");
    expect_refusal({"render", "--time", "0"}, "give seconds above 0");
    expect_refusal({"render", "--unbiased"}, "add --error");
    expect_refusal({"render", "--memory", "1K", "--threads", "2"}, "raise it or lower --threads");
    expect_refusal({"render", "--share", "95"},
                   "--share: of the blocks below which error? add --error");
    expect_refusal({"render", "--share", "95", "--unbiased", "--error"},
                   "--share: --unbiased decides for each block before any is done");
    expect_refusal({"render", "--share", "0", "--error"}, "--share");
    expect_refusal({"render", "--share", "101", "--error"}, "--share");
    expect_refusal({"render", "--threads", "many"}, "--threads");
    expect_refusal({"render", "--threads", "-1"}, "--threads");
    expect_refusal({"render", "--samples"}, "--samples");
    expect_refusal({"compare"}, "");
    expect_refusal({"compare", "a.exr", "b.exr", "--seed", "3"}, "--backends");
    expect_refusal({"compare", "--backends", "cpu"}, "--backends");
    expect_refusal({"compare", "--backends", "cpu,twin", "--bound", "wide"}, "--bound");
    expect_refusal({"selftest", "--backend", "twin"}, "twin");
    expect_refusal({"render", "--backend", "abacus", "--quiet"}, "abacus");
    expect_refusal({"render", "--debug-kernels"}, "--debug-kernels");
    expect_refusal({"render", "--device", "abacus", "--quiet"}, "abacus");
    expect_refusal({"render", "--backend", "cpu", "--device", "0", "--quiet"}, "--device");
    expect_refusal({"render", "--memory", "99999999G"}, "give at most 512T");
    expect_refusal({"farm", "--tasks", "2", "--samples", "64", "-o", "a.exr", "--error"},
                   "--error");
    expect_refusal({"farm", "--tasks", "2", "--samples", "64", "-o", "a.exr", "--size", "big"},
                   "big");
}

TEST(CommandLine, DevicesAlwaysAnswers)
{
    const Outcome outcome = run_diptych({"devices"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.out.find("cpu"), std::string::npos);
    const Outcome bare =
        run_diptych({"devices"}, {.environment = {{"OCL_ICD_VENDORS", "/nowhere"}}});
    EXPECT_EQ(bare.exit_code, 0) << bare.text();
    EXPECT_NE(bare.out.find("OpenCL"), std::string::npos) << bare.out;
}

TEST(CommandLine, SelftestPassesTheProcessor)
{
    const Outcome outcome = run_diptych({"selftest", "--backend", "cpu"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.out.find("sample_bsdf"), std::string::npos);
    EXPECT_EQ(outcome.out.find("FAILED"), std::string::npos) << outcome.out;
}

TEST(CommandLine, ExplainsTheDemo)
{
    const Outcome outcome = run_diptych({"explain"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.out.find("material lamp"), std::string::npos) << outcome.out;
}

TEST(CommandLine, CompareNamesBothBackends)
{
    const Outcome outcome = run_diptych(
        {"compare", "--backends", "cpu,twin", "--size", "32x32", "--samples", "2", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.out.find("of 1024 pixels differ"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
}

TEST(CommandLine, OnePixelHasTheValueOfThePicture)
{
    const auto pixel = [](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", "--size",  "32x32",   "--samples",
                                          "3",      "--quiet", "--pixel", "12,20"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run_diptych(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        EXPECT_EQ(outcome.out.find("pixel 12,20: "), 0u) << outcome.text();
        return outcome.out;
    };
    const std::string twin = pixel({"--backend", "twin"});
    EXPECT_EQ(pixel({"--backend", "twin", "--debug-kernels"}), twin);
    EXPECT_EQ(pixel({"--backend", "twin", "--threads", "1", "--memory", "1M"}), twin);
}

// What the picture takes beside the film counts too, and the program's own limit (ulimit -v).
TEST(CommandLine, FilmsThatDoNotFitWithTheirPicturesAreRefusedBeforeTheWork)
{
    const std::vector<std::string> words = {"render", "--samples", "1",     "--memory",
                                            "16M",    "-o",        "a.exr", "--size"};
    const auto render = [&](const std::string& size) {
        std::vector<std::string> all = words;
        all.push_back(size);
        return run_diptych(all);
    };
    rlimit old = {};
    getrlimit(RLIMIT_AS, &old);
    const rlimit limit = {3ul << 30, old.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
    const Outcome fits = render("64x64"), large = render("5000x4000");  // a film of 1.8 GiB
    setrlimit(RLIMIT_AS, &old);
    std::filesystem::remove("a.exr");
    EXPECT_EQ(fits.exit_code, 0) << fits.text();
    EXPECT_EQ(large.exit_code, 2) << large.text();
    EXPECT_NE(large.err.find("the picture made of it need 3967 MiB, there are"), std::string::npos)
        << large.text();
}

}  // namespace
