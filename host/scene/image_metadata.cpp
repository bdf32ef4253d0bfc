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

size_t big_endian(std::span<const std::uint8_t> bytes)
{
    size_t value = 0;
    for (const std::uint8_t byte : bytes) {
        value = value << 8 | byte;
    }
    return value;
}

// Calls use(marker, segment) for the segments up to the start of the scan (0xda), where compressed
// data begin, and returns where it stopped.
template<typename Use>
size_t walk_segments(std::span<const std::uint8_t> jpeg, Use use)
{
    size_t at = std::min<size_t>(2, jpeg.size());
    while (jpeg.size() - at >= 4 && jpeg[at] == 0xff && jpeg[at + 1] != 0xda) {
        if (jpeg[at + 1] == 0xff) {  // padding
            ++at;
            continue;
        }
        const size_t length = big_endian(jpeg.subspan(at + 2, 2));
        if (length < 2 || length > jpeg.size() - at - 2) {
            break;
        }
        use(int(jpeg[at + 1]), jpeg.subspan(at, length + 2));
        at += length + 2;
    }
    return at;
}

}  // namespace

ImageSize png_size(std::span<const std::uint8_t> png)
{
    if (png.size() < 24) {
        return {};
    }
    return {big_endian(png.subspan(16, 4)), big_endian(png.subspan(20, 4))};
}

ImageSize jpeg_size(std::span<const std::uint8_t> jpeg)
{
    ImageSize size;
    walk_segments(jpeg, [&](int marker, std::span<const std::uint8_t> segment) {
        const bool is_frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (!is_frame || segment.size() < 9) {
            return;
        }
        size = {big_endian(segment.subspan(7, 2)), big_endian(segment.subspan(5, 2))};
    });
    return size;
}

std::vector<std::uint8_t> png_without_metadata(std::span<const std::uint8_t> png)
{
    std::vector<std::uint8_t> result;
    size_t at = std::min<size_t>(8, png.size());
    append(result, png.first(at));
    while (png.size() - at >= 12) {
        const auto chunk = png.subspan(at);
        const size_t length = big_endian(chunk.first(4));
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
    append(result, jpeg.first(std::min<size_t>(2, jpeg.size())));
    const size_t at = walk_segments(jpeg, [&](int marker, std::span<const std::uint8_t> segment) {
        if (!is_metadata_segment(marker)) {
            append(result, segment);
        }
    });
    append(result, jpeg.subspan(at));
    return result;
}

}  // namespace diptych
