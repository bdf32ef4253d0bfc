// Stands between a stranger's file and the decoders: five formats, recognised by their first bytes;
// sizes checked before a decoder allocates; and of PNG, JPEG and TIFF only the parts that make the
// picture, since profiles and tags that nobody here needs are what most often crashes a reader
// (OpenImageIO 2.4: corrupt ICC profiles, palettes of BMP and TGA files, progressive JPEG bombs).
#pragma once

#include "host/image/image.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace diptych::image {

// What OpenImageIO is given: the name of its reader, and the bytes to read. No bytes: read the file
// itself.
struct GuardedFile {
    const char* reader = nullptr;
    std::vector<unsigned char> bytes;
};

// Throws std::runtime_error. what: with what to do after a semicolon, if that is not to replace the
// file.
[[noreturn]] void refuse_picture(const std::string& where, const std::string& what);

// Throws std::runtime_error (path: what; what to do) for anything that is not one of the five
// formats, is cut short where that shows, or exceeds the limits.
GuardedFile guard_picture(const std::string& path, const ReadLimits& limits = {});

// The same for a picture in memory; `where` names it in errors. Here bytes are always filled.
GuardedFile guard_picture(std::vector<unsigned char> bytes, const std::string& where,
                          const ReadLimits& limits = {});

}  // namespace diptych::image
