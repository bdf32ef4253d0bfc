#include "host/image/image.hpp"
#include "host/image/picture_guard.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace diptych::image {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

// Libraries report over several lines and repeat the path; ours is one line that starts with it.
std::string reason(const std::string& path, std::string text)
{
    for (size_t at; (at = text.find(path)) != std::string::npos;)
        text.replace(at, path.size(), "it");
    for (char& c : text)
        if (c < ' ' || c > '~') c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "no reason given" : text;
}

// Where the stored pixels lie in the picture that a viewer shows.
struct Window {
    int64_t x = 0, y = 0;           // of the first stored pixel, in the picture
    int64_t width = 0, height = 0;  // of the picture
};

uint64_t shown_pixels(const ImageSpec& spec)
{
    return uint64_t(spec.full_width) * uint64_t(spec.full_height);
}

// Checked before anything is allocated. No encoder squeezes more than some thousand bytes into one,
// so a small file with a huge header is refused whatever the limits say.
void check_size(const std::string& path, const ImageSpec& spec, const ReadLimits& limits)
{
    if (spec.width < 1 || spec.height < 1 || spec.full_width < 1 || spec.full_height < 1 ||
        spec.nchannels < 1)
        refuse_picture(
            path, fmt::format("its header gives {} x {} pixels of {} channels; the file is corrupt",
                              spec.width, spec.height, spec.nchannels));
    const uint64_t stored = uint64_t(spec.width) * uint64_t(spec.height);
    const uint64_t pixels = std::max(stored, shown_pixels(spec));
    if (pixels > limits.pixels || pixels > limits.values / uint64_t(spec.nchannels))
        refuse_picture(
            path,
            fmt::format(
                "{} x {} pixels of {} channels are more than the {} pixels or {} values allowed",
                std::max(spec.width, spec.full_width), std::max(spec.height, spec.full_height),
                spec.nchannels, limits.pixels, limits.values));
    constexpr uint64_t LARGEST_RATIO = 4000, STORED_FREELY = 64u << 20, SHOWN_FREELY = 1u << 30;
    std::error_code error;
    const uint64_t file_bytes = fs::file_size(path, error);
    const auto is_bomb = [&](uint64_t count, uint64_t freely) {
        const uint64_t bytes = count * spec.pixel_bytes(true);
        return bytes > freely && !error && bytes / LARGEST_RATIO > file_bytes;
    };
    if (is_bomb(stored, STORED_FREELY) || is_bomb(shown_pixels(spec), SHOWN_FREELY))
        refuse_picture(
            path, fmt::format("its header announces {} x {} pixels, but the file has only {} bytes",
                              std::max(spec.width, spec.full_width),
                              std::max(spec.height, spec.full_height), file_bytes));
    if (spec.deep)
        refuse_picture(path, "holds deep pixels, which are not supported; flatten it first");
    if (spec.depth > 1) refuse_picture(path, "holds a volume, not a picture");
}

Window window_of(const ImageSpec& spec)
{
    return {int64_t(spec.x) - spec.full_x, int64_t(spec.y) - spec.full_y, spec.full_width,
            spec.full_height};
}

struct ChannelName {
    std::string layer;
    std::string channel;
};

// "x.y.R" is channel R of layer "x.y". In a further part, which has a name of its own, plain
// channels belong to it.
ChannelName split_name(const std::string& name, const std::string& part)
{
    const size_t dot = name.rfind('.');
    if (dot != std::string::npos) return {name.substr(0, dot), name.substr(dot + 1)};
    if (!part.empty()) return {part, name};
    static const char* const beauty[] = {"R", "G", "B", "A", "Y", "I"};
    if (std::find(std::begin(beauty), std::end(beauty), name) != std::end(beauty))
        return {"", name};
    if (name == "Z") return {"depth", name};
    return {name, ""};
}

bool is_whole_number(const ImageSpec& spec, int channel)
{
    return spec.channelformat(channel) == TypeDesc::UINT;
}

// Where each channel of the file goes.
struct Slot {
    size_t layer;
    size_t channel;
};

// One layer for each name and kind of number, in the order of the file.
std::vector<Slot> make_layers(const ImageSpec& spec, const std::string& part,
                              std::vector<Layer>& layers)
{
    std::vector<Slot> slots;
    std::vector<bool> whole;
    const size_t first = layers.size();
    for (int c = 0; c < spec.nchannels; ++c) {
        const ChannelName name = split_name(spec.channel_name(c), part);
        size_t k = first;
        while (k < layers.size() &&
               (layers[k].name != name.layer || whole[k - first] != is_whole_number(spec, c)))
            ++k;
        if (k == layers.size()) {
            layers.push_back({name.layer, {}, {}, {}});
            whole.push_back(is_whole_number(spec, c));
        }
        slots.push_back({k, layers[k].channels.size()});
        layers[k].channels.push_back(name.channel);
    }
    return slots;
}

void allocate(Layer& layer, bool whole, const Window& window)
{
    const size_t count = size_t(window.width) * window.height * layer.channels.size();
    if (whole)
        layer.ids.assign(count, 0);
    else
        layer.pixels.assign(count, 0.0f);
}

// Reads one stored row or band of rows: floats for everything, and the exact value for unsigned
// channels, which a conversion to float would scale to 0..1.
class BandReader {
public:
    BandReader(const std::string& path, ImageInput& input, int part, const ImageSpec& spec)
        : path_(path), input_(input), part_(part), spec_(spec)
    {
        for (int c = 0; c < spec.nchannels; ++c) {
            has_whole_ |= is_whole_number(spec, c);
            offsets_.push_back(spec.pixel_bytes(0, c, true));
            is_half_.push_back(spec.channelformat(c) == TypeDesc::HALF);
        }
        pixel_bytes_ = has_whole_ ? spec.pixel_bytes(true) : spec.nchannels * sizeof(float);
    }

    int rows() const { return spec_.tile_width ? spec_.tile_height : 64; }

    void read(int begin, int end)
    {
        bytes_.resize(size_t(spec_.width) * (end - begin) * pixel_bytes_);
        const TypeDesc type = has_whole_ ? TypeDesc::UNKNOWN : TypeDesc::FLOAT;  // as stored
        const int y0 = spec_.y + begin, y1 = spec_.y + end, x1 = spec_.x + spec_.width;
        const bool good =
            spec_.tile_width
                ? input_.read_tiles(part_, 0, spec_.x, x1, y0, y1, spec_.z, spec_.z + 1, 0,
                                    spec_.nchannels, type, bytes_.data())
                : input_.read_scanlines(part_, 0, y0, y1, spec_.z, 0, spec_.nchannels, type,
                                        bytes_.data());
        if (!good)
            refuse_picture(path_,
                           "corrupt or cut short (" + reason(path_, input_.geterror()) + ")");
    }

    float number(size_t pixel, int c) const
    {
        if (!has_whole_) return value<float>(pixel * pixel_bytes_ + c * sizeof(float));
        const size_t at = pixel * pixel_bytes_ + offsets_[c];
        return is_half_[c] ? float(value<half>(at)) : value<float>(at);
    }

    uint32_t whole(size_t pixel, int c) const
    {
        return value<uint32_t>(pixel * pixel_bytes_ + offsets_[c]);
    }

private:
    template<class T>
    T value(size_t at) const
    {
        T result;
        std::memcpy(&result, bytes_.data() + at, sizeof result);
        return result;
    }

    const std::string& path_;
    ImageInput& input_;
    int part_;
    const ImageSpec& spec_;
    bool has_whole_ = false;
    size_t pixel_bytes_ = 0;
    std::vector<size_t> offsets_;  // of each channel in a pixel as stored
    std::vector<bool> is_half_;
    std::vector<char> bytes_;
};

// Puts one stored row in its place, cropped to the picture.
void copy_row(const BandReader& band, size_t first_pixel, int64_t y, const Window& window,
              const ImageSpec& spec, const std::vector<Slot>& slots, Picture& picture)
{
    const int64_t first = std::max<int64_t>(0, -window.x);
    const int64_t last = std::min<int64_t>(spec.width, window.width - window.x);
    for (int c = 0; c < spec.nchannels; ++c) {
        Layer& layer = picture.layers[slots[c].layer];
        const size_t stride = layer.channels.size();
        const bool whole = is_whole_number(spec, c);
        for (int64_t x = first; x < last; ++x) {
            const size_t to = size_t(y * window.width + window.x + x) * stride + slots[c].channel;
            if (whole)
                layer.ids[to] = band.whole(first_pixel + size_t(x), c);
            else
                layer.pixels[to] = band.number(first_pixel + size_t(x), c);
        }
    }
}

void read_part(const std::string& path, ImageInput& input, int part, const ImageSpec& spec,
               Picture& picture)
{
    const Window window = window_of(spec);
    const std::string part_name =
        part > 0 ? spec.get_string_attribute("oiio:subimagename").c_str() : std::string();
    const std::vector<Slot> slots = make_layers(spec, part_name, picture.layers);
    for (int c = 0; c < spec.nchannels; ++c)
        if (slots[c].channel == 0)
            allocate(picture.layers[slots[c].layer], is_whole_number(spec, c), window);

    BandReader band(path, input, part, spec);
    for (int begin = 0; begin < spec.height; begin += band.rows()) {
        const int end = std::min(spec.height, begin + band.rows());
        band.read(begin, end);
        for (int row = begin; row < end; ++row) {
            const int64_t y = window.y + row;
            if (y < 0 || y >= window.height) continue;
            copy_row(band, size_t(row - begin) * spec.width, y, window, spec, slots, picture);
        }
    }
}

// Scene-linear when stored as floating point, or said to be; display values otherwise.
Encoding encoding_of(const ImageSpec& spec)
{
    return spec.format.is_floating_point() ? Encoding::Linear : Encoding::Display;
}

void read_metadata(const ImageSpec& spec, Picture& picture)
{
    for (const auto& attribute : spec.extra_attribs)
        if (attribute.type() == TypeDesc::STRING)
            picture.metadata[attribute.name().string()] = attribute.get_string();
}

// An open file with the memory it reads from.
struct OpenPicture {
    GuardedFile file;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
    std::unique_ptr<ImageInput> input;
};

OpenPicture open(const std::string& path, const ReadLimits& limits)
{
    OpenPicture open{guard_picture(path, limits), nullptr, nullptr};
    open.input = ImageInput::create(open.file.reader);
    if (!open.input)
        refuse_picture(
            path, fmt::format("this OpenImageIO has no reader for {} files", open.file.reader));
    if (!open.file.bytes.empty()) {
        open.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(open.file.bytes.data(),
                                                                      open.file.bytes.size());
        open.input->set_ioproxy(open.memory.get());
    }
    ImageSpec spec, wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // display values stay as they are stored
    if (!open.input->open(path, spec, wishes))
        refuse_picture(path, "cannot be read (" + reason(path, open.input->geterror()) + ")");
    return open;
}

Picture read_all(const std::string& path, const ReadLimits& limits)
{
    const OpenPicture opened = open(path, limits);
    ImageInput* const input = opened.input.get();
    Picture picture;
    ReadLimits left = limits;
    const ImageSpec first = input->spec();
    // Only an EXR file's further parts are layers of the same picture; elsewhere they are frames,
    // pages and thumbnails.
    const bool parts = std::strcmp(input->format_name(), "openexr") == 0;
    for (int part = 0; part == 0 || (parts && input->seek_subimage(part, 0)); ++part) {
        const ImageSpec spec = input->spec(part);
        if (spec.undefined())
            refuse_picture(path, "corrupt (" + reason(path, input->geterror()) + ")");
        if (part > 0 && (spec.full_width != first.full_width ||
                         spec.full_height != first.full_height || spec.deep))
            continue;
        check_size(path, spec, left);
        left.values -= shown_pixels(spec) * uint64_t(spec.nchannels);
        read_part(path, *input, part, spec, picture);
    }
    (void)input->geterror();
    picture.width = first.full_width;
    picture.height = first.full_height;
    picture.encoding = encoding_of(first);
    read_metadata(first, picture);
    return picture;
}

}  // namespace

Picture read_picture(const std::string& path, const ReadLimits& limits)
{
    try {
        return read_all(path, limits);
    } catch (const std::bad_alloc&) {
        refuse_picture(path, "too large for the memory of this machine");
    } catch (const std::length_error&) {
        refuse_picture(path, "too large for the memory of this machine");
    }
}

}  // namespace diptych::image
