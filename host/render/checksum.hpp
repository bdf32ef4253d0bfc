// XXH64 (the xxHash specification, 0.1.1): a checksum as fast as memory, against decay and not
// against malice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace diptych {

class Checksum {
public:
    void add(const void* data, size_t bytes);
    // Of all that was added so far.
    std::uint64_t value() const;

private:
    std::array<std::uint64_t, 4> lanes_ = {0x60ea27eeadc0b5d6u, 0xc2b2ae3d27d4eb4fu, 0,
                                           0x61c8864e7a143579u};
    std::array<unsigned char, 32> rest_ = {};
    size_t filled_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace diptych
