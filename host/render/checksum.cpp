#include "host/render/checksum.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace diptych {
namespace {

constexpr std::uint64_t prime_1 = 0x9e3779b185ebca87u;
constexpr std::uint64_t prime_2 = 0xc2b2ae3d27d4eb4fu;
constexpr std::uint64_t prime_3 = 0x165667b19e3779f9u;
constexpr std::uint64_t prime_4 = 0x85ebca77c2b2ae63u;
constexpr std::uint64_t prime_5 = 0x27d4eb2f165667c5u;

template<class Word>
Word word_at(const unsigned char* from)
{
    Word word;
    std::memcpy(&word, from, sizeof word);
    return word;
}

std::uint64_t mixed(std::uint64_t lane, std::uint64_t word)
{
    return std::rotl(lane + word * prime_2, 31) * prime_1;
}

void take_stripe(std::array<std::uint64_t, 4>& lanes, const unsigned char* stripe)
{
    for (size_t k = 0; k < 4; ++k)
        lanes[k] = mixed(lanes[k], word_at<std::uint64_t>(stripe + 8 * k));
}

}  // namespace

void Checksum::add(const void* data, size_t bytes)
{
    const auto* from = static_cast<const unsigned char*>(data);
    bytes_ += bytes;
    if (filled_ > 0) {
        const size_t taken = std::min(bytes, rest_.size() - filled_);
        std::memcpy(rest_.data() + filled_, from, taken);
        filled_ += taken;
        from += taken;
        bytes -= taken;
        if (filled_ < rest_.size()) return;
        take_stripe(lanes_, rest_.data());
        filled_ = 0;
    }
    std::array<std::uint64_t, 4> lanes = lanes_;
    for (; bytes >= 32; bytes -= 32, from += 32) take_stripe(lanes, from);
    lanes_ = lanes;
    if (bytes > 0) std::memcpy(rest_.data(), from, bytes);
    filled_ = bytes;
}

std::uint64_t Checksum::value() const
{
    std::uint64_t hash = lanes_[2] + prime_5;
    if (bytes_ >= 32) {
        hash = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) +
               std::rotl(lanes_[3], 18);
        for (const std::uint64_t lane : lanes_) hash = (hash ^ mixed(0, lane)) * prime_1 + prime_4;
    }
    hash += bytes_;
    const unsigned char* from = rest_.data();
    size_t left = filled_;
    for (; left >= 8; left -= 8, from += 8)
        hash = std::rotl(hash ^ mixed(0, word_at<std::uint64_t>(from)), 27) * prime_1 + prime_4;
    if (left >= 4) {
        hash = std::rotl(hash ^ word_at<std::uint32_t>(from) * prime_1, 23) * prime_2 + prime_3;
        left -= 4;
        from += 4;
    }
    for (; left > 0; --left, ++from) hash = std::rotl(hash ^ *from * prime_5, 11) * prime_1;
    hash = (hash ^ hash >> 33) * prime_2;
    hash = (hash ^ hash >> 29) * prime_3;
    return hash ^ hash >> 32;
}

}  // namespace diptych
