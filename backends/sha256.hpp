// SHA-256 (FIPS 180-4), for cache keys and for the hashes of pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace diptych {

class Sha256 {
public:
    void add(const void* data, size_t bytes);
    void add(std::string_view text) { add(text.data(), text.size()); }

    // The digest of all that was added, as 64 hexadecimal digits. Adding more afterwards is wrong.
    std::string finish();

private:
    void add_block(const unsigned char* block);

    std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> block_ = {};
    size_t filled_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace diptych
