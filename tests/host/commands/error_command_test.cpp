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

TEST(ErrorCommand, ATimeLimitEndsByTheClockWithAPicture)
{
    const TestFolder folder;
    const Outcome outcome = run_diptych({"render", "--size", "64x64", "--time", "0.5s", "--refresh",
                                         "0.1s", "-o", folder / "a.png"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("ended: the time is over"), std::string::npos) << outcome.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.png"});
}

}  // namespace
