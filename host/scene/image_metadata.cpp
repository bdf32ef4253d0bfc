#include "host/scene/image_metadata.hpp"

#include <algorithm>
#include <cstddef>

namespace diptych {
namespace {

void append(std::vector<std::uint8_t>& result, std::span<const std::uint8_t> part)
{
    result.insert(result.end(), part.begin(), part.end());
}

// Profiles, Exif, XMP and comments; JFIF (APP0) and Adobe's colour transform (APP14) matter.
bool is_metadata_segment(int marker)
{
    return (marker > 0xe0 && marker <= 0xef && marker != 0xee) || marker == 0xfe;
}

}  // namespace

std::vector<std::uint8_t> png_without_metadata(std::span<const std::uint8_t> png)
{
    std::vector<std::uint8_t> result;
    size_t at = std::min<size_t>(8, png.size());
    append(result, png.first(at));
    while (png.size() - at >= 12) {
        const auto chunk = png.subspan(at);
        const size_t length = size_t(chunk[0]) << 24 | size_t(chunk[1]) << 16 |
                              size_t(chunk[2]) << 8 | size_t(chunk[3]);
        if (length > chunk.size() - 12) {
            break;
        }
        const bool is_critical = (chunk[4] & 0x20) == 0;
        if (is_critical || std::equal(chunk.begin() + 4, chunk.begin() + 8, "tRNS")) {
            append(result, chunk.first(length + 12));
        }
        at += length + 12;
    }
    append(result, png.subspan(at));
    return result;
}

std::vector<std::uint8_t> jpeg_without_metadata(std::span<const std::uint8_t> jpeg)
{
    std::vector<std::uint8_t> result;
    size_t at = std::min<size_t>(2, jpeg.size());
    append(result, jpeg.first(at));
    // Segments up to the start of the scan (0xda), where compressed data begin.
    while (jpeg.size() - at >= 4 && jpeg[at] == 0xff && jpeg[at + 1] != 0xda) {
        const int marker = jpeg[at + 1];
        if (marker == 0xff) {  // padding
            ++at;
            continue;
        }
        const size_t length = size_t(jpeg[at + 2]) << 8 | size_t(jpeg[at + 3]);
        if (length < 2 || length > jpeg.size() - at - 2) {
            break;
        }
        if (!is_metadata_segment(marker)) {
            append(result, jpeg.subspan(at, length + 2));
        }
        at += length + 2;
    }
    append(result, jpeg.subspan(at));
    return result;
}

}  // namespace diptych
