#include "host/live/line_reader.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

namespace {

using Lines = std::vector<std::string>;

TEST(LineReader, GivesWholeLinesAndNeverWaits)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const auto type = [&](const std::string& text) {
        return write(ends[1], text.data(), text.size()) == ssize_t(text.size());
    };
    diptych::LineReader reader(ends[0]);
    EXPECT_EQ(reader.lines(), Lines{});
    ASSERT_TRUE(type("a.b=1\n\n  c.d=[2, 3]\t\r\ne.f"));
    EXPECT_EQ(reader.lines(), (Lines{"a.b=1", "c.d=[2, 3]"}));
    EXPECT_EQ(reader.lines(), Lines{});
    ASSERT_TRUE(type("=4"));
    close(ends[1]);
    EXPECT_EQ(reader.lines(), Lines{"e.f=4"});
    EXPECT_EQ(reader.descriptor(), -1);
    EXPECT_EQ(reader.lines(), Lines{});
    close(ends[0]);
}

}  // namespace
