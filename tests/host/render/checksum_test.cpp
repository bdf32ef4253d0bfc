#include "host/render/checksum.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using diptych::Checksum;

std::uint64_t sum_of(const std::string& text)
{
    Checksum sum;
    sum.add(text.data(), text.size());
    return sum.value();
}

// XXH64 with seed 0, as the reference implementation gives it.
TEST(Checksum, GivesTheSpecificationsValues)
{
    EXPECT_EQ(sum_of(""), 0xef46db3751d8e999u);
    EXPECT_EQ(sum_of("a"), 0xd24ec4f1a98c6e5bu);
    EXPECT_EQ(sum_of("abc"), 0x44bc2cf5ad770999u);
    EXPECT_EQ(sum_of("Call me Ishmael. Some years ago--never mind how long precisely-"),
              0x02a2e85470d6fd96u);
}

TEST(Checksum, DoesNotCareHowTheBytesArrive)
{
    std::string text;
    for (int k = 0; k < 1000; ++k) text += char(k * 7);
    for (const size_t step : {1u, 3u, 31u, 32u, 33u, 100u}) {
        Checksum sum;
        for (size_t at = 0; at < text.size(); at += step)
            sum.add(text.data() + at, std::min(step, text.size() - at));
        EXPECT_EQ(sum.value(), sum_of(text)) << step;
    }
}

TEST(Checksum, NoticesEveryBit)
{
    const std::string text(77, 'x');
    for (size_t bit = 0; bit < 8 * text.size(); ++bit) {
        std::string other = text;
        other[bit / 8] = char(other[bit / 8] ^ 1 << bit % 8);
        EXPECT_NE(sum_of(other), sum_of(text)) << bit;
    }
}

}  // namespace
