// Images as the loader reads them, before they are packed into the scene's texel buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace diptych {

// RGBA, row 0 on top: 8 bit, or float when the file had more than 8 bits. One of the two vectors
// holds 4 * width * height values. 16-bit values are scaled to 0..1 and still encoded as the file
// had them.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;
    std::vector<float> floats;
    bool is_integer = true;  // false for files of half or float, whose colours are linear
    size_t bad_texels = 0;   // NaN, infinite or negative values, replaced while reading

    bool is_8_bit() const { return floats.empty(); }
};

// Reads an image file, or the bytes of one; `where` names it in errors. The size is checked against
// max_pixels before anything is decoded. Throws SceneError.
Picture read_picture(const std::filesystem::path& file, const std::string& where,
                     size_t max_pixels);
Picture read_picture(std::span<const std::uint8_t> bytes, const std::string& where,
                     size_t max_pixels);

float srgb_decode(float encoded);
float srgb_decode_byte(std::uint8_t encoded);  // the same of encoded / 255, from a table

}  // namespace diptych
