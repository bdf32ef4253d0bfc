// Image files without what a renderer does not read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace diptych {

// The same PNG or JPEG image without colour profiles, Exif, comments and the like: glTF says to
// ignore them, and the code that would parse them has crashed on broken ones. What does not follow
// its format is left as it is, for the decoder to refuse.
std::vector<std::uint8_t> png_without_metadata(std::span<const std::uint8_t> png);
std::vector<std::uint8_t> jpeg_without_metadata(std::span<const std::uint8_t> jpeg);

}  // namespace diptych
