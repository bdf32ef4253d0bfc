// What is done to PNG and JPEG files before a decoder sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace diptych {

struct ImageSize {
    size_t width = 0;
    size_t height = 0;
};

// The size that a PNG or JPEG header announces; 0 x 0 if there is none. OpenImageIO allocates for
// the whole of a progressive JPEG as soon as it opens it, too late to refuse a bomb.
ImageSize png_size(std::span<const std::uint8_t> png);
ImageSize jpeg_size(std::span<const std::uint8_t> jpeg);

// The same PNG or JPEG image without colour profiles, Exif, comments and the like: glTF says to
// ignore them, and the code that would parse them has crashed on broken ones. What does not follow
// its format is left as it is, for the decoder to refuse.
std::vector<std::uint8_t> png_without_metadata(std::span<const std::uint8_t> png);
std::vector<std::uint8_t> jpeg_without_metadata(std::span<const std::uint8_t> jpeg);

}  // namespace diptych
