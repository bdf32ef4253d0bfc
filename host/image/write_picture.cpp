#include "host/image/image.hpp"
#include "host/image/view_transform.hpp"
#include "host/image/whole_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace diptych::image {
namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

constexpr float LARGEST_HALF = 65504;

struct Format {
    const char* extension;
    std::string_view encoder;
    bool holds_layers;
    bool holds_sixteen_bits;
};
constexpr Format FORMATS[] = {{".exr", "openexr", true, false}, {".png", "png", false, true},
                              {".jpg", "jpeg", false, false},   {".jpeg", "jpeg", false, false},
                              {".tif", "tiff", false, true},    {".tiff", "tiff", false, true}};

[[noreturn]] void fail(const std::string& path, const std::string& what)
{
    throw std::runtime_error(path + ": " + what);
}

std::string small_extension(const std::string& path)
{
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

// Null for a name that is no picture's.
const Format* find_format(const std::string& path)
{
    const std::string extension = small_extension(path);
    for (const Format& format : FORMATS)
        if (extension == format.extension) return &format;
    return nullptr;
}

const Format& format_of(const std::string& path)
{
    if (const Format* format = find_format(path)) return *format;
    fail(path,
         fmt::format("unknown picture format '{}'; use .exr, .png, .jpg, .jpeg, .tif or .tiff",
                     fs::path(path).extension().string()));
}

std::string channel_name(const Layer& layer, const std::string& channel)
{
    if (layer.name == "depth" && channel == "Z") return channel;
    if (layer.name.empty()) return channel;
    return channel.empty() ? layer.name : layer.name + "." + channel;
}

void check_layers(const std::string& path, const Picture& picture)
{
    if (picture.width < 1 || picture.height < 1)
        fail(path, fmt::format("a picture of {} x {} pixels cannot be written", picture.width,
                               picture.height));
    for (const Layer& layer : picture.layers) {
        const size_t expected = size_t(picture.width) * picture.height * layer.channels.size();
        if (layer.pixels.size() + layer.ids.size() != expected || expected == 0)
            fail(path, fmt::format("layer '{}' holds {} values, {} are needed", layer.name,
                                   layer.pixels.size() + layer.ids.size(), expected));
    }
}

// Depth and nodes keep their range and ids their exact value, whatever the colours are stored as.
TypeDesc channel_type(const Layer& layer, const WriteOptions& options)
{
    if (!layer.ids.empty()) return TypeDesc::UINT;
    const bool is_raw = layer.name == "depth" || is_node_layer(layer);
    return options.half && !is_raw ? TypeDesc::HALF : TypeDesc::FLOAT;
}

OIIO::ImageSpec exr_spec(const Picture& picture, const WriteOptions& options)
{
    OIIO::ImageSpec spec(picture.width, picture.height, 0, TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const Layer& layer : picture.layers) {
        for (const std::string& channel : layer.channels) {
            spec.channelnames.push_back(channel_name(layer, channel));
            spec.channelformats.push_back(channel_type(layer, options));
            if (spec.channelnames.back() == "A") spec.alpha_channel = spec.nchannels;
            if (spec.channelnames.back() == "Z") spec.z_channel = spec.nchannels;
            ++spec.nchannels;
        }
    }
    spec.attribute("compression", "zip:1");  // level 4 takes half as long again for 5 % less
    spec.attribute("DateTime", "");          // otherwise OpenImageIO adds the present second
    for (const auto& [name, value] : picture.metadata) spec.attribute(name, value);
    return spec;
}

// One row of the file's own layout: the values of a pixel one after the other, each in its
// channel's type.
void pack_exr_row(const Picture& picture, const WriteOptions& options, int y, char* out)
{
    for (int x = 0; x < picture.width; ++x) {
        for (const Layer& layer : picture.layers) {
            const size_t count = layer.channels.size();
            const size_t first = (size_t(y) * picture.width + x) * count;
            const TypeDesc type = channel_type(layer, options);
            for (size_t c = first; c < first + count; ++c, out += type.size()) {
                if (type == TypeDesc::UINT) std::memcpy(out, &layer.ids[c], 4);
                if (type == TypeDesc::FLOAT) std::memcpy(out, &layer.pixels[c], 4);
                if (type == TypeDesc::HALF) {
                    const half value = std::clamp(layer.pixels[c], -LARGEST_HALF, LARGEST_HALF);
                    std::memcpy(out, &value, 2);
                }
            }
        }
    }
}

OIIO::ImageSpec display_spec(const Picture& picture, const WriteOptions& options,
                             const Format& format, bool alpha)
{
    const std::string_view encoder = format.encoder;
    const bool sixteen = options.sixteen_bit && format.holds_sixteen_bits;
    OIIO::ImageSpec spec(picture.width, picture.height, alpha ? 4 : 3,
                         sixteen ? TypeDesc::UINT16 : TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    // In TIFF it would become an Exif directory, for which libtiff must read back what it wrote;
    // memory here is write-only.
    if (encoder != "tiff") spec.attribute("oiio:ColorSpace", "sRGB");
    // OpenImageIO adds the present second to a TIFF without a date; one of another type is not
    // written at all.
    if (encoder == "tiff") spec.attribute("DateTime", 0);
    if (encoder == "jpeg") spec.attribute("Compression", "jpeg:95");
    if (encoder == "jpeg") spec.attribute("jpeg:subsampling", "4:4:4");
    if (encoder == "tiff") spec.attribute("compression", "zip");
    return spec;
}

// Rows of sRGB values as whole numbers. Alpha is linear coverage: colours are divided by it before
// the view is applied.
void pack_display_row(const Picture& picture, const Layer& layer, const WriteOptions& options,
                      const OIIO::ImageSpec& spec, int y, char* out)
{
    const size_t count = layer.channels.size();
    const float top = spec.format == TypeDesc::UINT16 ? 65535.0f : 255.0f;
    for (int x = 0; x < picture.width; ++x) {
        const float* pixel = &layer.pixels[(size_t(y) * picture.width + x) * count];
        const float coverage = spec.nchannels == 4 ? std::clamp(pixel[3], 0.0f, 1.0f) : 1.0f;
        const float scale = coverage > 0 ? 1 / coverage : 0.0f;
        Rgb color = {pixel[0] * scale, pixel[count > 2 ? 1 : 0] * scale,
                     pixel[count > 2 ? 2 : 0] * scale};
        if (picture.encoding == Encoding::Linear)
            color = display_value(color, options.exposure, options.view);
        const float values[4] = {color[0], color[1], color[2], coverage};
        for (int c = 0; c < spec.nchannels; ++c) {
            const float value = values[c] > 0 ? std::min(values[c], 1.0f) : 0.0f;  // NaN becomes 0
            const auto rounded = uint16_t(value * top + 0.5f);
            if (spec.format == TypeDesc::UINT16)
                std::memcpy(out, &rounded, 2), out += 2;
            else
                *out++ = char(rounded);
        }
    }
}

// Encodes in memory, so that a full disk shows when the bytes are written, whatever the encoder
// makes of it.
template<class PackRow>
std::vector<unsigned char> encode(const std::string& path, const OIIO::ImageSpec& spec,
                                  PackRow&& pack_row)
{
    const std::string encoder(format_of(path).encoder);
    auto output = OIIO::ImageOutput::create(encoder);
    if (!output) fail(path, "this OpenImageIO has no encoder for it (" + OIIO::geterror() + ")");
    OIIO::Filesystem::IOVecOutput memory;
    output->set_ioproxy(&memory);
    if (!output->open(path, spec)) fail(path, "cannot be encoded (" + output->geterror() + ")");

    constexpr int BAND = 64;  // a multiple of the rows in an EXR zip block
    const size_t row_bytes = spec.scanline_bytes(true);
    std::vector<char> band(row_bytes * BAND);
    for (int y = 0; y < spec.height; y += BAND) {
        const int rows = std::min(BAND, spec.height - y);
        for (int r = 0; r < rows; ++r) pack_row(y + r, band.data() + r * row_bytes);
        const TypeDesc type =
            spec.channelformats.empty() ? spec.format : TypeDesc(TypeDesc::UNKNOWN);
        if (!output->write_scanlines(y, y + rows, 0, type, band.data()))
            fail(path, "cannot be encoded (" + output->geterror() + ")");
    }
    if (!output->close()) fail(path, "cannot be encoded (" + output->geterror() + ")");
    return std::move(memory.buffer());
}

std::vector<unsigned char> encode_exr(const std::string& path, const Picture& picture,
                                      const WriteOptions& options)
{
    return encode(path, exr_spec(picture, options),
                  [&](int y, char* out) { pack_exr_row(picture, options, y, out); });
}

std::vector<unsigned char> encode_display(const std::string& path, const Picture& picture,
                                          const WriteOptions& options)
{
    const Layer& layer = beauty_of(picture);
    if (layer.pixels.empty())
        fail(path, "whole-number layers have no colours to show; write them to .exr");
    const Format& format = format_of(path);
    const bool alpha = options.alpha && format.encoder != "jpeg" && layer.channels.size() >= 4;
    const OIIO::ImageSpec spec = display_spec(picture, options, format, alpha);
    return encode(path, spec, [&](int y, char* out) {
        pack_display_row(picture, layer, options, spec, y, out);
    });
}

}  // namespace

void write_picture(const std::string& path, const Picture& picture, const WriteOptions& options)
{
    check_layers(path, picture);
    const auto bytes = format_of(path).holds_layers ? encode_exr(path, picture, options)
                                                    : encode_display(path, picture, options);
    write_file_whole(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void write_pictures(const std::vector<std::string>& paths, const Picture& picture,
                    const WriteOptions& options)
{
    write_each(paths, [&](const std::string& path) { write_picture(path, picture, options); });
}

void write_each(const std::vector<std::string>& paths,
                const std::function<void(const std::string&)>& write)
{
    std::string failures;
    for (const std::string& path : paths) {
        try {
            write(path);
        } catch (const std::runtime_error& error) {
            failures += (failures.empty() ? "" : "; and ") + std::string(error.what());
        }
    }
    if (!failures.empty()) throw std::runtime_error(failures);
}

void write_file_whole(const std::string& path, std::string_view bytes)
{
    WholeFile file(path, Survives::Program);
    file.write(bytes.data(), bytes.size());
    file.put_in_place();
}

bool is_picture_name(const std::string& path) { return find_format(path) != nullptr; }

bool is_foreign_picture_name(const std::string& path)
{
    const std::string extension = small_extension(path);
    if (extension.empty() || find_format(path)) return false;
    // "openexr:exr,sxr,mxr;tiff:tif,..."
    std::string known = OIIO::get_string_attribute("extension_list");
    std::replace_if(
        known.begin(), known.end(), [](char c) { return c == ':' || c == ';'; }, ',');
    return ("," + known + ",").find("," + extension.substr(1) + ",") != std::string::npos;
}

bool holds_layers(const std::string& path)
{
    const Format* format = find_format(path);
    return format && format->holds_layers;
}

bool holds_sixteen_bits(const std::string& path)
{
    const Format* format = find_format(path);
    return format && format->holds_sixteen_bits;
}

void check_writable(const std::string& path)
{
    format_of(path);
    check_file_writable(path);
}

void check_file_writable(const std::string& path) { WholeFile probe(path, Survives::Program); }

}  // namespace diptych::image
