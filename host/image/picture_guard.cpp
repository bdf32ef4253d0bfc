#include "host/image/picture_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace diptych::image {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

// Bytes with bounds: reading past the end is an error of the file.
struct Reader {
    const Bytes& bytes;
    const std::string& where;
    bool big_endian = true;

    uint64_t number(size_t at, int size) const
    {
        if (at > bytes.size() || bytes.size() - at < size_t(size))
            refuse_picture(where, "is cut short");
        uint64_t value = 0;
        for (int k = 0; k < size; ++k)
            value = value << 8 | bytes[at + (big_endian ? k : size - 1 - k)];
        return value;
    }
};

void check_pixels(const std::string& where, uint64_t width, uint64_t height,
                  const ReadLimits& limits)
{
    if (width == 0 || height == 0)
        refuse_picture(where, fmt::format("its header gives {} x {} pixels", width, height));
    if (height > limits.pixels / width)
        refuse_picture(where, fmt::format("{} x {} pixels are more than the {} allowed", width,
                                          height, limits.pixels));
}

// The cyclic redundancy check of PNG (ISO 3309), bit by bit for each of the 256 bytes.
uint32_t crc_of(const unsigned char* data, size_t size)
{
    static const std::array<uint32_t, 256> table = [] {
        std::array<uint32_t, 256> t{};
        for (uint32_t n = 0; n < 256; ++n) {
            t[n] = n;
            for (int bit = 0; bit < 8; ++bit) t[n] = (t[n] >> 1) ^ (t[n] & 1 ? 0xedb88320u : 0u);
        }
        return t;
    }();
    uint32_t crc = ~0u;
    for (size_t i = 0; i < size; ++i) crc = table[(crc ^ data[i]) & 255] ^ (crc >> 8);
    return ~crc;
}

void check_png_header(const Reader& file, size_t data, size_t size, const ReadLimits& limits)
{
    if (size != 13) refuse_picture(file.where, "is corrupt (its PNG header has the wrong size)");
    check_pixels(file.where, file.number(data, 4), file.number(data + 4, 4), limits);
    const int depth = file.bytes[data + 8], kind = file.bytes[data + 9];
    const bool known =
        kind == 0   ? depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16
        : kind == 3 ? depth == 1 || depth == 2 || depth == 4 || depth == 8
                    : (kind == 2 || kind == 4 || kind == 6) && (depth == 8 || depth == 16);
    if (!known)
        refuse_picture(file.where,
                       fmt::format("is corrupt (PNG colour type {} with {} bits)", kind, depth));
}

// Header, palette, transparency and pixels, each with a right checksum; nothing else.
Bytes guard_png(const Bytes& bytes, const std::string& where, const ReadLimits& limits)
{
    const Reader file{bytes, where};
    Bytes kept(bytes.begin(), bytes.begin() + 8);
    bool has_pixels = false, has_palette = false, needs_palette = false;
    for (size_t at = 8;;) {
        const size_t size = file.number(at, 4);
        (void)file.number(at + 8 + size, 4);  // the whole chunk is there
        const std::string type(bytes.begin() + long(at) + 4, bytes.begin() + long(at) + 8);
        if ((at == 8) != (type == "IHDR"))
            refuse_picture(where, "is corrupt (its PNG header is out of place)");
        const bool critical = type == "IHDR" || type == "PLTE" || type == "IDAT" || type == "IEND";
        if (!critical && (type[0] & 32) == 0)
            refuse_picture(where, "is corrupt (PNG chunk of an unknown kind)");
        if (critical || type == "tRNS") {
            if (crc_of(&bytes[at + 4], size + 4) != file.number(at + 8 + size, 4))
                refuse_picture(
                    where, fmt::format("is corrupt (wrong checksum of its PNG chunk {})", type));
            kept.insert(kept.end(), bytes.begin() + long(at), bytes.begin() + long(at + 12 + size));
        }
        if (type == "IHDR")
            check_png_header(file, at + 8, size, limits), needs_palette = bytes[at + 17] == 3;
        has_palette |= type == "PLTE";
        has_pixels |= type == "IDAT";
        if (type == "IEND") break;
        at += 12 + size;
    }
    if (!has_pixels || (needs_palette && !has_palette))
        refuse_picture(where, "is corrupt (no pixels or no palette)");
    return kept;
}

// Tables, frame and scans, JFIF and Adobe markers (they tell the colour space); no profiles, no
// tags, no comments. Garbage between markers is skipped, as decoders do.
Bytes guard_jpeg(const Bytes& bytes, const std::string& where, const ReadLimits& limits)
{
    constexpr int MOST_SCANS = 200;  // encoders make ten; thousands are an attack on time
    const Reader file{bytes, where};
    Bytes kept = {0xff, 0xd8};
    int scans = 0;
    for (size_t at = 2; at < bytes.size();) {
        const auto marker = std::find(bytes.begin() + long(at), bytes.end(), 0xff);
        size_t code = size_t(marker - bytes.begin()) + 1;
        while (code < bytes.size() && bytes[code] == 0xff) ++code;
        if (code >= bytes.size()) break;
        const int kind = bytes[code];
        at = code + 1;
        if (kind == 0xd9) break;
        if (kind == 0 || kind == 1 || (kind >= 0xd0 && kind <= 0xd8)) continue;
        const size_t size = file.number(at, 2);
        const size_t end = at + size;
        if (size < 2 || end > bytes.size())
            refuse_picture(where, "is cut short or corrupt (JPEG marker beyond the end)");
        const bool frame =
            kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 && kind != 0xcc;
        if (frame) check_pixels(where, file.number(at + 5, 2), file.number(at + 3, 2), limits);
        const bool metadata = kind == 0xfe || (kind >= 0xe1 && kind <= 0xef && kind != 0xee);
        size_t keep_until = metadata ? code : end;
        if (kind == 0xda) {
            if (++scans > MOST_SCANS) refuse_picture(where, "is a JPEG of too many scans");
            while (keep_until + 1 < bytes.size() &&
                   (bytes[keep_until] != 0xff || bytes[keep_until + 1] == 0 ||
                    (bytes[keep_until + 1] & 0xf8) == 0xd0))
                ++keep_until;
            if (keep_until + 1 == bytes.size()) keep_until = bytes.size();
        }
        if (!metadata) {
            kept.push_back(0xff);
            kept.insert(kept.end(), bytes.begin() + long(code), bytes.begin() + long(keep_until));
        }
        at = std::max(end, keep_until);
    }
    if (scans == 0) refuse_picture(where, "is corrupt (a JPEG without pixels)");
    kept.insert(kept.end(), {0xff, 0xd9});
    return kept;
}

// Renames the tags whose contents other parsers would be fed to numbers that mean nothing.
Bytes guard_tiff(Bytes bytes, const std::string& where)
{
    const bool big_endian = bytes[0] == 'M';
    const Reader file{bytes, where, big_endian};
    const bool big = file.number(2, 2) == 43;
    const size_t directory = file.number(big ? 8 : 4, big ? 8 : 4);
    const uint64_t count = file.number(directory, big ? 8 : 2);
    const size_t first = directory + (big ? 8 : 2), entry = big ? 20 : 12;
    for (uint64_t k = 0; k < count; ++k) {
        const size_t at = first + k * entry;
        const uint64_t tag = file.number(at, 2);
        static const int unwanted[] = {700,   33723, 34377, 34665,
                                       34675, 34853};  // XMP, IPTC, Photoshop, Exif, ICC, GPS
        if (std::find(std::begin(unwanted), std::end(unwanted), int(tag)) == std::end(unwanted))
            continue;
        bytes[at + (big_endian ? 1 : 0)] += 1;
    }
    return bytes;
}

const char* reader_of(const Bytes& start)
{
    const auto begins = [&](std::string_view magic) {
        return start.size() >= magic.size() &&
               std::memcmp(start.data(), magic.data(), magic.size()) == 0;
    };
    using namespace std::string_view_literals;
    if (begins("\x76\x2f\x31\x01"sv)) return "openexr";
    if (begins("\x89PNG\r\n\x1a\n"sv)) return "png";
    if (begins("\xff\xd8\xff"sv)) return "jpeg";
    if (begins("II\x2a\0"sv) || begins("MM\0\x2a"sv) || begins("II\x2b\0"sv) ||
        begins("MM\0\x2b"sv))
        return "tiff";
    if (begins("#?RADIANCE"sv) || begins("#?RGBE"sv)) return "hdr";
    return nullptr;
}

Bytes guard_bytes(const std::string& reader, Bytes bytes, const std::string& where,
                  const ReadLimits& limits)
{
    if (reader == "png") return guard_png(bytes, where, limits);
    if (reader == "jpeg") return guard_jpeg(bytes, where, limits);
    if (reader == "tiff") return guard_tiff(std::move(bytes), where);
    return bytes;
}

const char* known_reader(const Bytes& start, const std::string& where)
{
    if (start.empty()) refuse_picture(where, "is an empty file");
    const char* reader = reader_of(start);
    if (!reader)
        refuse_picture(
            where, "is no EXR, HDR, PNG, JPEG or TIFF picture, or is corrupt from its first bytes");
    return reader;
}

Bytes read_bytes(const std::string& path, uint64_t most)
{
    std::ifstream file(path, std::ios::binary);
    std::error_code error;
    Bytes bytes(std::min<uint64_t>(fs::file_size(path, error), most));
    if (error || !file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
        refuse_picture(path, "cannot be read; check that it is a file and yours to read");
    return bytes;
}

}  // namespace

void refuse_picture(const std::string& where, const std::string& what)
{
    const bool is_advised = what.find(';') != std::string::npos;
    throw std::runtime_error(where + ": " + what + (is_advised ? "" : "; replace the file"));
}

GuardedFile guard_picture(const std::string& path, const ReadLimits& limits)
{
    std::error_code error;
    if (!fs::exists(path, error)) refuse_picture(path, "no such file; check the path");
    if (!fs::is_regular_file(path, error)) refuse_picture(path, "is not a file; name a picture");
    const char* reader = known_reader(read_bytes(path, 16), path);
    const std::string name = reader;
    if (name == "openexr" || name == "hdr") return {reader, {}};
    return {reader, guard_bytes(name, read_bytes(path, ~uint64_t(0)), path, limits)};
}

GuardedFile guard_picture(std::vector<unsigned char> bytes, const std::string& where,
                          const ReadLimits& limits)
{
    const char* reader = known_reader(bytes, where);
    return {reader, guard_bytes(reader, std::move(bytes), where, limits)};
}

}  // namespace diptych::image
