// Renders that are asked for an error or a time, as a user asks.
#include "host/image/image.hpp"
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>

namespace {

using namespace diptych;

TEST(ErrorCommand, EndsByItselfSaysHowSureItIsAndShowsWhere)
{
    const TestFolder folder;
    const Outcome outcome = run_diptych({"render", "--size", "96x64", "--error", "2.5", "--audit",
                                         "--json", "-", "-o", folder / "out.exr"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("ended: the target is reached"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("asked for 2.5 JND, predicted"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("audit: "), std::string::npos) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["error"]["unfinished_blocks"], 0);
    EXPECT_LE(report["error"]["block_p95"].get<double>(), 2.5);
    // found by other samples: not far from what the film's own say
    EXPECT_LT(report["audit"]["rms_low"].get<double>(), 2 * report["error"]["rms"].get<double>());
    EXPECT_GT(report["audit"]["rms_high"].get<double>(),
              0.5 * report["error"]["rms"].get<double>());
    EXPECT_EQ(report["audit"]["share_false"], 0);

    const image::Picture picture = image::read_picture(folder / "out.exr");
    EXPECT_NE(image::find_layer(picture, "predicted_error"), nullptr);
    EXPECT_NE(image::find_layer(picture, "standard_error"), nullptr);
    const image::Layer* counts = image::find_layer(picture, "sample_count");
    ASSERT_NE(counts, nullptr);
    EXPECT_GT(std::set<uint32_t>(counts->ids.begin(), counts->ids.end()).size(), 1u);
}

TEST(ErrorCommand, WithoutAValueAimsAtOne)
{
    const Outcome outcome = run_diptych(
        {"render", "--size", "32x32", "--samples", "64", "--error", "-o", "/dev/null/x.exr"});
    EXPECT_EQ(outcome.exit_code, 2) << "the folder is checked, after the flags are read";
    const TestFolder folder;
    const Outcome limited = run_diptych(
        {"render", "--size", "32x32", "--samples", "64", "-o", folder / "a.png", "--error"});
    EXPECT_EQ(limited.exit_code, 0) << limited.text();
    EXPECT_NE(limited.err.find("the samples are used up"), std::string::npos) << limited.err;
    EXPECT_NE(limited.err.find("above 1 JND"), std::string::npos) << limited.err;
}

// In the words of who asked, not rounded to the scheduler's unit.
TEST(ErrorCommand, OutOfReachNothingIsPredictedAndThatIsSaid)
{
    const TestFolder folder;
    const Outcome outcome = run_diptych({"render", "--size", "16x16", "--samples", "128", "--error",
                                         "0.01", "--audit", "--json", "-", "-o", folder / "a.png"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("are above 0.01 JND"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("none was predicted to be; no block was predicted below it"),
              std::string::npos)
        << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["error"]["target"], 0.01);
    EXPECT_TRUE(report["audit"]["share_covered"].is_null());
    EXPECT_TRUE(report["audit"]["share_false"].is_null());
}

// Wherever the samples of the audit come from.
TEST(ErrorCommand, AnAuditBearsOutWhatOpenCLAndSeveralDevicesPredict)
{
    const std::vector<std::vector<std::string>> devices = {{"--backend", "opencl"},
                                                           {"--device", "0,cpu"}};
    for (const std::vector<std::string>& device : devices) {
        SCOPED_TRACE(device.back());
        const TestFolder folder;
        std::vector<std::string> words = {"render", "--size",        "64x48",  "--error",
                                          "3",      "--audit",       "--json", "-",
                                          "-o",     folder / "a.png"};
        words.insert(words.end(), device.begin(), device.end());
        const Outcome outcome = run_diptych(words);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        const auto report = nlohmann::json::parse(outcome.out);
        const double rms = report["error"]["rms"];
        EXPECT_EQ(report["error"]["unfinished_blocks"], 0);
        EXPECT_LT(report["audit"]["rms_low"].get<double>(), 2 * rms);
        EXPECT_GT(report["audit"]["rms_high"].get<double>(), 0.5 * rms);
        EXPECT_EQ(report["audit"]["share_false"], 0);
    }
}

TEST(ErrorCommand, AnAuditSaysWhatItNeeds)
{
    const auto refusal = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", "--size", "16x16", "--audit", "-o", "/tmp/a.png"});
        const Outcome outcome = run_diptych(words);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
        return outcome.err;
    };
    const std::string limited = refusal({"--samples", "64", "--error", "1"});
    EXPECT_NE(limited.find("128 are needed: give --samples 128 or more\n"), std::string::npos)
        << limited;
    EXPECT_NE(refusal({"--samples", "64"}).find("128 or more, or --error or --time"),
              std::string::npos);
    EXPECT_NE(refusal({"--samples", "256", "--one-sequence"}).find("leave out --one-sequence"),
              std::string::npos);
    EXPECT_NE(refusal({"--samples", "256", "--pixel", "1,1"}).find("leave out --pixel"),
              std::string::npos);
}

// What is done for one exposure is not for another.
TEST(ErrorCommand, AnotherExposureGoesOnFromTheCheckpoint)
{
    const TestFolder folder;
    const auto render = [&](const char* exposure) {
        const Outcome outcome = run_diptych(
            {"render", "--size", "48x32", "--error", "3", "--exposure", exposure, "--checkpoint",
             folder / "a.checkpoint", "--json", "-", "-o", folder / "a.exr"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return nlohmann::json::parse(outcome.out);
    };
    const auto dark = render("-4"), bright = render("1"), again = render("1");
    EXPECT_EQ(dark["error"]["unfinished_blocks"], 0);
    EXPECT_GT(bright["paths"].get<long long>(), 0);
    EXPECT_EQ(bright["error"]["unfinished_blocks"], 0);
    EXPECT_EQ(again["paths"], 0) << "all is done";
    EXPECT_EQ(again["sha256"]["beauty"], bright["sha256"]["beauty"]);
}

// The end is not in sight when the first decision falls.
TEST(ErrorCommand, ProgressDoesNotReachTheEndAtTheFirstDecision)
{
    const TestFolder folder;
    const Outcome outcome =
        run_diptych({"render", "--size", "64x48", "--error", "0.7", "-o", folder / "a.png"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    std::vector<int> percents;
    for (const std::string& line : outcome.err_lines())
        if (line.find(" Mrays/s  ") != std::string::npos) percents.push_back(std::stoi(line));
    ASSERT_GT(percents.size(), 2u) << outcome.err;
    for (size_t k = 1; k + 1 < percents.size(); ++k) EXPECT_LT(percents[k], 100) << outcome.err;
    EXPECT_LT(percents[0], 50) << outcome.err;
}

TEST(ErrorCommand, OneSequenceIsLessNoisyAndKnowsNoError)
{
    const TestFolder folder;
    const auto render = [&](int samples, int seed, std::vector<std::string> words) {
        const std::string path = folder / "picture.exr";
        words.insert(words.begin(), {"render", "--size", "32x32", "-o", path, "--samples",
                                     std::to_string(samples), "--seed", std::to_string(seed)});
        const Outcome outcome = run_diptych(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return image::read_picture(path);
    };
    const image::Picture truth = render(4096, 9, {"--one-sequence"});
    const auto square_error = [&](const image::Picture& picture) {
        const std::vector<float>&a = image::beauty_of(picture).pixels,
              &b = image::beauty_of(truth).pixels;
        double sum = 0;
        for (size_t k = 0; k < a.size(); ++k) sum += double(a[k] - b[k]) * double(a[k] - b[k]);
        return sum;
    };
    double one_error = 0, eight_error = 0;
    for (int seed = 1; seed <= 4; ++seed) {  // a single one's error moves by a fifth
        const image::Picture one = render(256, seed, {"--one-sequence"});
        const image::Picture eight = render(256, seed, {});
        EXPECT_EQ(image::find_layer(one, "standard_error"), nullptr);
        EXPECT_NE(image::find_layer(eight, "standard_error"), nullptr);
        one_error += square_error(one);
        eight_error += square_error(eight);
    }
    EXPECT_LT(one_error, 0.8 * eight_error);
    for (const char* flag : {"--error", "--audit"})
        EXPECT_EQ(run_diptych({"render", "--size", "32x32", "--samples", "256", "--one-sequence",
                               flag, "-o", folder / "a.png"})
                      .exit_code,
                  2)
            << flag;
}

TEST(ErrorCommand, ATimeLimitEndsByTheClockWithAPicture)
{
    const TestFolder folder;
    const Outcome outcome = run_diptych({"render", "--size", "64x64", "--time", "0.5s", "--refresh",
                                         "0.1s", "--json", "-", "-o", folder / "a.png"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("ended: the time is over"), std::string::npos) << outcome.err;
    const double seconds = nlohmann::json::parse(outcome.out)["render"];
    EXPECT_GT(seconds, 0.25) << "the time is used";
    EXPECT_LT(seconds, 5) << "and kept, as far as a busy machine lets it";
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.png"});
}

}  // namespace
