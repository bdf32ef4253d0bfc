#include "host/scene/picture.hpp"

#include "host/scene/image_metadata.hpp"
#include "host/scene/scene_error.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <unistd.h>

namespace diptych {
namespace {

// Its messages are many lines at times; an error here is one.
std::string one_line(std::string text)
{
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') {
            c = ' ';
        }
    }
    while (!text.empty() && text.back() == ' ') {
        text.pop_back();
    }
    return text.empty() ? "the reason is not known" : text;
}

void check_size(const ImageSize& size, int channels, const std::string& where, size_t max_pixels)
{
    if (size.width == 0 || size.height == 0 || channels <= 0) {
        throw SceneError(fmt::format("{}: an image of {} x {} pixels; replace the image", where,
                                     size.width, size.height));
    }
    // The limit is meant for four channels; more of them count as more pixels.
    const double pixels = double(size.width) * double(size.height) * std::max(channels, 4) / 4;
    if (pixels > double(max_pixels)) {
        throw SceneError(fmt::format("{}: an image of {} x {} pixels and {} channels is beyond the "
                                     "limit of {} pixels; use a smaller image or raise the limit",
                                     where, size.width, size.height, channels, max_pixels));
    }
}

void check_spec(const OIIO::ImageSpec& spec, const std::string& where, size_t max_pixels)
{
    if (spec.depth > 1) {
        throw SceneError(where + ": a volume, not an image; replace the image");
    }
    check_size({size_t(std::max(spec.width, 0)), size_t(std::max(spec.height, 0))}, spec.nchannels,
               where, max_pixels);
}

// Channels in the order R, G, B, A, a grey image repeated: where each comes from, -1 for opaque.
std::array<int, 4> channel_order(const OIIO::ImageSpec& spec)
{
    const auto find = [&](const char* name) {
        const auto& names = spec.channelnames;
        const auto at = std::find(names.begin(), names.end(), name);
        return at == names.end() ? -1 : int(at - names.begin());
    };
    const int alpha = spec.alpha_channel >= 0 ? spec.alpha_channel : find("A");
    if (find("R") >= 0 && find("G") >= 0 && find("B") >= 0) {
        return {find("R"), find("G"), find("B"), alpha};
    }
    const int colors = spec.nchannels - (alpha >= 0 ? 1 : 0);
    if (colors >= 3) {
        return {0, 1, 2, alpha};
    }
    const int grey = alpha == 0 ? 1 : 0;
    if (colors == 0) {
        return {alpha, alpha, alpha, alpha};
    }
    return {grey, grey, grey, alpha};
}

template<typename T>
std::vector<T> reordered(std::vector<T>&& values, int channels, const std::array<int, 4>& order,
                         T opaque)
{
    if (channels == 4 && order == std::array{0, 1, 2, 3}) {
        return std::move(values);
    }
    const size_t texels = values.size() / size_t(channels);
    std::vector<T> result(4 * texels);
    for (size_t t = 0; t < texels; ++t) {
        for (size_t c = 0; c < 4; ++c) {
            result[4 * t + c] =
                order[c] < 0 ? opaque : values[t * size_t(channels) + size_t(order[c])];
        }
    }
    return result;
}

// No texel of a scene may be NaN, infinite or negative.
size_t sanitize(std::vector<float>& values)
{
    size_t replaced = 0;
    float largest = 0;
    for (const float v : values) {
        if (std::isfinite(v)) {
            largest = std::max(largest, v);
        }
    }
    for (float& v : values) {
        if (v >= 0 && std::isfinite(v)) {
            continue;
        }
        v = v > 0 ? largest : 0;  // v > 0 is false for NaN
        ++replaced;
    }
    return replaced;
}

Picture read_pixels(OIIO::ImageInput& input, const std::string& where, size_t max_pixels)
{
    const OIIO::ImageSpec spec = input.spec();
    check_spec(spec, where, max_pixels);
    const size_t values = size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels);
    const auto order = channel_order(spec);
    Picture picture;
    picture.width = spec.width;
    picture.height = spec.height;
    picture.is_integer = !spec.format.is_floating_point();
    const auto fail = [&] {
        throw SceneError(fmt::format("{}: cannot be decoded ({}); replace the image", where,
                                     one_line(input.geterror())));
    };
    if (spec.format == OIIO::TypeDesc::UINT8) {
        std::vector<std::uint8_t> bytes(values);
        if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, bytes.data())) {
            fail();
        }
        picture.bytes = reordered<std::uint8_t>(std::move(bytes), spec.nchannels, order, 255);
    } else {
        std::vector<float> floats(values);
        if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, floats.data())) {
            fail();
        }
        picture.floats = reordered<float>(std::move(floats), spec.nchannels, order, 1.0f);
        picture.bad_texels = sanitize(picture.floats);
    }
    return picture;
}

// The reader for an image that begins with these bytes. Only formats that scenes have reason to
// hold: some of OpenImageIO's other readers crash on broken files (TGA does).
std::string reader_for(std::span<const std::uint8_t> b)
{
    const auto starts = [&](std::initializer_list<int> magic, size_t at = 0) {
        return b.size() >= at + magic.size() &&
               std::equal(magic.begin(), magic.end(), b.begin() + std::ptrdiff_t(at),
                          [](int m, std::uint8_t x) { return m == x; });
    };
    if (starts({0x89, 'P', 'N', 'G'})) {
        return "png";
    }
    if (starts({0xff, 0xd8, 0xff})) {
        return "jpeg";
    }
    if (starts({'R', 'I', 'F', 'F'}) && starts({'W', 'E', 'B', 'P'}, 8)) {
        return "webp";
    }
    if (starts({0x76, 0x2f, 0x31, 0x01})) {
        return "openexr";
    }
    if (starts({'#', '?'})) {
        return "hdr";
    }
    return "";
}

bool is_ktx2(std::span<const std::uint8_t> b)
{
    return b.size() >= 7 && b[0] == 0xab && std::equal(b.begin() + 1, b.begin() + 7, "KTX 20");
}

// libpng writes its complaints to standard error, where an error of ours is one line and a warning
// about a colour profile is noise. Nothing else can be told to it through OpenImageIO. Silent as
// long as any thread holds one.
class QuietStandardError {
public:
    QuietStandardError()
    {
        const std::lock_guard lock(mutex_);
        if (holders_++ > 0) {
            return;
        }
        const int nothing = open("/dev/null", O_WRONLY);
        saved_ = nothing < 0 ? -1 : dup(STDERR_FILENO);
        if (saved_ >= 0) {
            dup2(nothing, STDERR_FILENO);
        }
        if (nothing >= 0) {
            close(nothing);
        }
    }
    ~QuietStandardError()
    {
        const std::lock_guard lock(mutex_);
        if (--holders_ > 0 || saved_ < 0) {
            return;
        }
        dup2(saved_, STDERR_FILENO);
        close(saved_);
    }
    QuietStandardError(const QuietStandardError&) = delete;
    QuietStandardError& operator=(const QuietStandardError&) = delete;

private:
    static inline std::mutex mutex_;
    static inline int holders_ = 0;
    static inline int saved_ = -1;
};

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, const std::string& where)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw SceneError(where + ": cannot be opened; check its name and permissions");
    }
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Picture read_picture(const std::filesystem::path& file, const std::string& where, size_t max_pixels)
{
    return read_picture(read_bytes(file, where), where, max_pixels);
}

Picture read_picture(std::span<const std::uint8_t> bytes, const std::string& where,
                     size_t max_pixels)
{
    if (is_ktx2(bytes)) {
        throw SceneError(where + ": is a KTX2 image (KHR_texture_basisu), which cannot be read; "
                                 "export it with PNG or JPEG images");
    }
    const std::string reader = reader_for(bytes);
    if (reader.empty()) {
        throw SceneError(where + ": its first bytes are of no image format that is read here; use "
                                 "PNG, JPEG, WebP, OpenEXR or Radiance HDR");
    }
    std::vector<std::uint8_t> bare;
    if (reader == "png") {
        check_size(png_size(bytes), 4, where, max_pixels);
        bare = png_without_metadata(bytes);
    } else if (reader == "jpeg") {
        check_size(jpeg_size(bytes), 4, where, max_pixels);
        bare = jpeg_without_metadata(bytes);
    }
    const auto stored = bare.empty() ? bytes : std::span<const std::uint8_t>(bare);

    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(stored.data()), stored.size());
    void* proxy = &memory;
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);  // glTF: straight alpha
    hints.attribute("oiio:reorient", 0);
    hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const QuietStandardError quiet;
    auto input = OIIO::ImageInput::create(reader);
    OIIO::ImageSpec spec;
    if (!input || !input->open("memory", spec, hints)) {
        throw SceneError(fmt::format("{}: cannot be decoded ({}); replace the image", where,
                                     one_line(input ? input->geterror() : OIIO::geterror())));
    }
    return read_pixels(*input, where, max_pixels);
}

float srgb_decode(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f
                               : float(std::pow((double(encoded) + 0.055) / 1.055, 2.4));
}

float srgb_decode_byte(std::uint8_t encoded)
{
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (size_t k = 0; k < values.size(); ++k) {
            values[k] = srgb_decode(float(k) / 255);
        }
        return values;
    }();
    return table[encoded];
}

}  // namespace diptych
