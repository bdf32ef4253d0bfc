// Arguments that leave nothing out: bit patterns at a prime stride through all 2^32, and partners.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

inline constexpr float special_floats[] = {0.0f,
                                           -0.0f,
                                           1.0f,
                                           -1.0f,
                                           0.5f,
                                           -0.5f,
                                           2.0f,
                                           -2.0f,
                                           3.0f,
                                           -3.0f,
                                           1.0e-45f,
                                           -1.0e-45f,
                                           1.17549435e-38f,
                                           16777215.0f,
                                           16777216.0f,
                                           2147483648.0f,
                                           -2147483648.0f,
                                           3.4028235e38f,
                                           -3.4028235e38f,
                                           std::numeric_limits<float>::infinity(),
                                           -std::numeric_limits<float>::infinity(),
                                           std::numeric_limits<float>::quiet_NaN()};

// Every stride-th float.
inline std::vector<float> float_patterns(std::uint64_t stride)
{
    std::vector<float> values;
    for (std::uint64_t bits = 0; bits <= 0xffffffffu; bits += stride) {
        values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    }
    return values;
}

struct FloatPairs {
    std::vector<float> a;
    std::vector<float> b;
};

// Each stride-th float with, in turn, any other, one near it in size, and a small multiple of 1/4;
// then all pairs of special values.
inline FloatPairs float_pairs(std::uint64_t stride)
{
    FloatPairs pairs;
    std::mt19937 random(20240607);
    for (float a : float_patterns(stride)) {
        const std::uint32_t bits = random();
        const float near_a = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a) ^ (bits >> 8));
        const float quarters = static_cast<float>(static_cast<int>(bits >> 25) - 64) / 4;
        const float choices[] = {std::bit_cast<float>(bits), near_a, quarters};
        pairs.b.push_back(choices[pairs.a.size() % 3]);
        pairs.a.push_back(a);
    }
    for (float a : special_floats) {
        for (float b : special_floats) {
            pairs.a.push_back(a);
            pairs.b.push_back(b);
        }
    }
    return pairs;
}
