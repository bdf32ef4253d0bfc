// Asked to stop, a render ends its pass and writes what it has.
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace {

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, EndsThePassWritesThePicturesAndExits130)
{
    const TestFolder folder;
    const Outcome outcome =
        run_diptych({"render", "--size", "512x512", "--samples", "64", "--threads", "1", "--memory",
                     "8M", "-o", folder / "a.exr", "-o", folder / "b.png"},
                    {.seconds = 120, .wait_for = " left", .signal = GetParam()});
    EXPECT_EQ(outcome.signal, 0) << outcome.text();
    EXPECT_EQ(outcome.exit_code, 130) << outcome.text();
    EXPECT_FALSE(outcome.has_timed_out);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "b.png"}));
}

// The picture is there before it is audited; that the audit is not whole is said, and by the code.
TEST(InterruptedAudit, SaysSoAndExits130)
{
    const TestFolder folder;
    const Outcome outcome = run_diptych(
        {"render", "--size", "64x64", "--samples", "512", "--audit", "-o", folder / "a.exr"},
        {.seconds = 120, .wait_for = "blocks are rendered again", .signal = SIGINT});
    EXPECT_EQ(outcome.exit_code, 130) << outcome.text();
    EXPECT_NE(outcome.err.find("audit: broken off after "), std::string::npos) << outcome.text();
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

}  // namespace
