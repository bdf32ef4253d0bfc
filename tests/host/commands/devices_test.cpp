// --device with several entries, as a user gives it. PoCL presents as many devices as it is told.
#include "host/image/image.hpp"
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace {

using namespace diptych;

const std::map<std::string, std::string> two_devices = {{"POCL_DEVICES", "pthread pthread"}};

bool is_there(const std::string& text, const std::map<std::string, std::string>& environment = {})
{
    return run_diptych({"devices"}, {.environment = environment}).out.find(text) !=
           std::string::npos;
}

struct Rendered {
    Outcome outcome;
    std::vector<float> pixels;
};

Rendered render(const TestFolder& folder, std::vector<std::string> flags,
                std::map<std::string, std::string> environment = two_devices)
{
    const std::string out = folder / "out.exr";
    std::filesystem::remove(out);
    std::vector<std::string> words = {"render", "--size", "96x64", "-o", out};
    if (std::ranges::find(flags, "--samples") == flags.end())
        words.insert(words.end(), {"--samples", "32"});
    words.insert(words.end(), flags.begin(), flags.end());
    Rendered rendered{run_diptych(words, {.seconds = 300, .environment = std::move(environment)}),
                      {}};
    if (std::filesystem::exists(out))
        rendered.pixels = image::beauty_of(image::read_picture(out)).pixels;
    return rendered;
}

bool is_same(const Rendered& a, const Rendered& b)
{
    return !a.pixels.empty() && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), 4 * a.pixels.size()) == 0;
}

const std::vector<std::vector<std::string>> uniform_and_adaptive = {
    {}, {"--samples", "256", "--error", "2.5"}};

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& others)
{
    words.insert(words.end(), others.begin(), others.end());
    return words;
}

TEST(Devices, TwoGiveThePictureOfOne)
{
    if (!is_there("--device 1", two_devices)) GTEST_SKIP() << "PoCL does not present two devices";
    const TestFolder folder;
    for (std::vector<std::string> targets : uniform_and_adaptive) {
        const Rendered one = render(folder, with(targets, {"--backend", "opencl"}));
        const Rendered two = render(folder, with(targets, {"--device", "0,1", "--json", "-"}));
        EXPECT_TRUE(is_same(one, two)) << two.outcome.text();
        const auto report = nlohmann::json::parse(two.outcome.out);
        EXPECT_EQ(report["backend"], "opencl");
        ASSERT_EQ(report["devices"].size(), 2u);
        EXPECT_EQ(report["devices"][0]["samples"].get<long long>() +
                      report["devices"][1]["samples"].get<long long>(),
                  report["paths"].get<long long>());
        EXPECT_NE(two.outcome.err.find("% of the samples: opencl ("), std::string::npos);
    }
}

TEST(Devices, PartsGiveThePictureOfTheWhole)
{
    if (!is_there("can be divided")) GTEST_SKIP() << "no device that can be divided";
    const TestFolder folder;
    for (std::vector<std::string> targets : uniform_and_adaptive) {
        const Rendered whole = render(folder, with(targets, {"--backend", "opencl"}), {});
        const Rendered parts = render(folder, with(targets, {"--device", "0/2"}), {});
        EXPECT_TRUE(is_same(whole, parts)) << parts.outcome.text();
        EXPECT_NE(parts.outcome.err.find("part 2 of 2"), std::string::npos) << parts.outcome.err;
    }
}

TEST(Devices, TheProcessorTakesPart)
{
    if (!is_there("--device 0")) GTEST_SKIP() << "no OpenCL device";
    const TestFolder folder;
    const Rendered cpu = render(folder, {});
    const Rendered both = render(folder, {"--device", "cpu,0"});
    ASSERT_EQ(both.outcome.exit_code, 0) << both.outcome.text();
    ASSERT_EQ(both.pixels.size(), cpu.pixels.size());
    size_t apart = 0;  // D2: the same paths but for a few rays in a thousand
    for (size_t k = 0; k < cpu.pixels.size(); ++k)
        apart += std::abs(both.pixels[k] - cpu.pixels[k]) > 1e-3f * (1 + std::abs(cpu.pixels[k]));
    EXPECT_LT(double(apart), 0.02 * double(cpu.pixels.size()));
}

TEST(Devices, ThatFailAreDroppedWithANotice)
{
    if (!is_there("--device 1", two_devices)) GTEST_SKIP() << "PoCL does not present two devices";
    const TestFolder folder;
    std::map<std::string, std::string> failing = two_devices;
    failing["DIPTYCH_FAIL_AT"] = "1";
    const Rendered cpu = render(folder, {});
    const Rendered rest = render(folder, {"--device", "0,1,cpu"}, failing);
    EXPECT_TRUE(is_same(cpu, rest)) << rest.outcome.text();
    EXPECT_NE(rest.outcome.err.find("it is dropped"), std::string::npos) << rest.outcome.err;
    const Rendered none = render(folder, {"--device", "0,1", "--quiet"}, failing);
    EXPECT_EQ(none.outcome.exit_code, 2) << none.outcome.text();
    EXPECT_NE(none.outcome.err.find("diptych: no device is left"), std::string::npos);
}

TEST(Devices, AloneThatFailsLeavesWhatItHasDone)
{
    if (!is_there("--device 0")) GTEST_SKIP() << "no OpenCL device";
    const TestFolder folder;
    const std::string file = folder / "c";
    // one sample of each pixel, then one, two, four, eight and eight
    const std::vector<std::string> whole_plan = {"--backend", "opencl",    "--time",
                                                 "1000",      "--samples", "24"};
    const std::vector<std::string> kept =
        with(whole_plan, {"--checkpoint", file, "--every", "1000s"});
    const Rendered whole = render(folder, whole_plan);
    const Rendered broken = render(folder, kept, {{"DIPTYCH_FAIL_AT", "5"}});
    EXPECT_EQ(broken.outcome.exit_code, 2) << broken.outcome.text();
    EXPECT_NE(broken.outcome.err.find("what was done before is in"), std::string::npos)
        << broken.outcome.text();
    EXPECT_FALSE(broken.pixels.empty()) << "the picture is written all the same";
    EXPECT_FALSE(is_same(whole, broken));
    const Rendered resumed = render(folder, kept);
    EXPECT_NE(resumed.outcome.err.find("going on from"), std::string::npos)
        << resumed.outcome.text();
    EXPECT_TRUE(is_same(whole, resumed)) << resumed.outcome.text();
}

TEST(Devices, ACheckpointIsContinuedByOthers)
{
    if (!is_there("--device 1", two_devices)) GTEST_SKIP() << "PoCL does not present two devices";
    const TestFolder folder;
    const Rendered one = render(folder, {"--backend", "opencl", "--samples", "64"});
    const std::string file = folder / "c";
    ASSERT_EQ(render(folder, {"--device", "0,1", "--samples", "48", "--checkpoint", file})
                  .outcome.exit_code,
              0);
    const Rendered more =
        render(folder, {"--backend", "opencl", "--samples", "64", "--checkpoint", file});
    EXPECT_TRUE(is_same(one, more)) << more.outcome.text();
}

TEST(Devices, ListsOfNoSenseAreRefused)
{
    const TestFolder folder;
    const auto expect = [&](std::vector<std::string> flags, const std::string& message) {
        const Outcome outcome = render(folder, std::move(flags)).outcome;
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        EXPECT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
        EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.text();
    };
    expect({"--device", "0,,cpu"}, "an entry is empty");
    expect({"--device", "cpu,"}, "an entry is empty");
    expect({"--device", "cpu,cpu"}, "cpu comes twice");
    expect({"--device", "0,0/2"}, "0 comes twice");
    expect({"--device", "cpu/2,0"}, "cpu is not divided");
    expect({"--device", "0/0"}, "2 or more");
    expect({"--device", "0/1"}, "2 or more");
    expect({"--device", "0,cpu", "--backend", "twin"}, "leave out --backend twin");
    EXPECT_EQ(run_diptych({"selftest", "--device", "0,cpu"}).exit_code, 2);
    if (!is_there("--device 1", two_devices)) GTEST_SKIP() << "PoCL does not present two devices";
    expect({"--device", "0,no such device"}, "no device \"no such device\"");
    expect({"--device", "0,pthread"}, "once more");
    expect({"--device", "0/999"}, "cannot be divided into 999 parts");
}

}  // namespace
