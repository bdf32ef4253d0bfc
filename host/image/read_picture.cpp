#include "host/image/image.hpp"
#include "host/image/picture_guard.hpp"

#include <OpenImageIO/filesystem.h>
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

[[noreturn]] void fail(const std::string& path, const std::string& what)
{
    throw std::runtime_error(path + ": " + what);
}

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
    int x = 0, y = 0;           // of the first stored pixel, in the picture
    int width = 0, height = 0;  // of the picture
};

// Checked before anything is allocated. No encoder squeezes more than some thousand bytes into one,
// so a small file with a huge header is refused whatever the limits say.
void check_size(const std::string& path, const ImageSpec& spec, const ReadLimits& limits)
{
    if (spec.width < 1 || spec.height < 1 || spec.full_width < 1 || spec.full_height < 1 ||
        spec.nchannels < 1)
        fail(path,
             fmt::format("its header gives {} x {} pixels of {} channels; the file is corrupt",
                         spec.width, spec.height, spec.nchannels));
    const uint64_t stored = uint64_t(spec.width) * uint64_t(spec.height);
    const uint64_t shown = uint64_t(spec.full_width) * uint64_t(spec.full_height);
    const uint64_t pixels = std::max(stored, shown);
    if (pixels > limits.pixels || pixels > limits.values / uint64_t(spec.nchannels))
        fail(path,
             fmt::format(
                 "{} x {} pixels of {} channels are more than the {} pixels or {} values allowed",
                 std::max(spec.width, spec.full_width), std::max(spec.height, spec.full_height),
                 spec.nchannels, limits.pixels, limits.values));
    constexpr uint64_t LARGEST_RATIO = 20000, ALWAYS_ALLOWED = 64u << 20;
    const uint64_t bytes = stored * spec.pixel_bytes(true);
    std::error_code error;
    const uint64_t file_bytes = fs::file_size(path, error);
    if (bytes > ALWAYS_ALLOWED && !error && bytes / LARGEST_RATIO > file_bytes)
        fail(path,
             fmt::format("its header announces {} x {} pixels, but the file has only {} bytes",
                         spec.width, spec.height, file_bytes));
    if (spec.deep) fail(path, "holds deep pixels, which are not supported; flatten it first");
    if (spec.depth > 1) fail(path, "holds a volume, not a picture");
}

Window window_of(const ImageSpec& spec)
{
    return {spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width, spec.full_height};
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
        for (int c = 0; c < spec.nchannels; ++c) has_whole_ |= is_whole_number(spec, c);
    }

    int rows() const { return spec_.tile_width ? spec_.tile_height : 64; }

    void read(int begin, int end)
    {
        const size_t pixels = size_t(spec_.width) * (end - begin);
        floats_.resize(pixels * spec_.nchannels);
        if (!has_whole_) return read_as(begin, end, TypeDesc::FLOAT, floats_.data());
        native_.resize(pixels * spec_.pixel_bytes(true));
        read_as(begin, end, TypeDesc::UNKNOWN, native_.data());
    }

    float number(size_t pixel, int c) const
    {
        if (!has_whole_) return floats_[pixel * spec_.nchannels + c];
        const char* at = channel_at(pixel, c);
        float value = 0;
        OIIO::convert_types(spec_.channelformat(c), at, TypeDesc::FLOAT, &value, 1);
        return value;
    }

    uint32_t whole(size_t pixel, int c) const
    {
        uint32_t value;
        std::memcpy(&value, channel_at(pixel, c), sizeof value);
        return value;
    }

private:
    const char* channel_at(size_t pixel, int c) const
    {
        return native_.data() + pixel * spec_.pixel_bytes(true) + spec_.pixel_bytes(0, c, true);
    }

    void read_as(int begin, int end, TypeDesc type, void* out)
    {
        const int y0 = spec_.y + begin, y1 = spec_.y + end;
        const bool good =
            spec_.tile_width
                ? input_.read_tiles(part_, 0, spec_.x, spec_.x + spec_.width, y0, y1, spec_.z,
                                    spec_.z + 1, 0, spec_.nchannels, type, out)
                : input_.read_scanlines(part_, 0, y0, y1, spec_.z, 0, spec_.nchannels, type, out);
        if (!good) fail(path_, "corrupt or cut short (" + reason(path_, input_.geterror()) + ")");
    }

    const std::string& path_;
    ImageInput& input_;
    int part_;
    const ImageSpec& spec_;
    bool has_whole_ = false;
    std::vector<float> floats_;
    std::vector<char> native_;
};

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
    const int first_column = std::max(0, -window.x);
    const int last_column = std::min<int64_t>(spec.width, int64_t(window.width) - window.x);
    for (int begin = 0; begin < spec.height; begin += band.rows()) {
        const int end = std::min(spec.height, begin + band.rows());
        band.read(begin, end);
        for (int row = begin; row < end; ++row) {
            const int64_t y = int64_t(window.y) + row;
            if (y < 0 || y >= window.height) continue;
            for (int c = 0; c < spec.nchannels; ++c) {
                Layer& layer = picture.layers[slots[c].layer];
                const size_t stride = layer.channels.size();
                const size_t from = size_t(row - begin) * spec.width;
                const int64_t to =
                    (y * window.width + window.x) * int64_t(stride) + int64_t(slots[c].channel);
                for (int x = first_column; x < last_column; ++x) {
                    const size_t at = size_t(to + int64_t(x) * int64_t(stride));
                    if (is_whole_number(spec, c))
                        layer.ids[at] = band.whole(from + x, c);
                    else
                        layer.pixels[at] = band.number(from + x, c);
                }
            }
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
        fail(path, fmt::format("this OpenImageIO has no reader for {} files", open.file.reader));
    if (!open.file.bytes.empty()) {
        open.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(open.file.bytes.data(),
                                                                      open.file.bytes.size());
        open.input->set_ioproxy(open.memory.get());
    }
    ImageSpec spec, wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // display values stay as they are stored
    if (!open.input->open(path, spec, wishes))
        fail(path, "cannot be read (" + reason(path, open.input->geterror()) + ")");
    return open;
}

Picture read_all(const std::string& path, const ReadLimits& limits)
{
    const OpenPicture opened = open(path, limits);
    ImageInput* const input = opened.input.get();
    Picture picture;
    const ImageSpec first = input->spec();
    // Only an EXR file's further parts are layers of the same picture; elsewhere they are frames,
    // pages and thumbnails.
    const bool parts = std::strcmp(input->format_name(), "openexr") == 0;
    for (int part = 0; part == 0 || (parts && input->seek_subimage(part, 0)); ++part) {
        const ImageSpec spec = input->spec(part);
        if (spec.undefined()) fail(path, "corrupt (" + reason(path, input->geterror()) + ")");
        if (part > 0 && (spec.full_width != first.full_width ||
                         spec.full_height != first.full_height || spec.deep))
            continue;
        check_size(path, spec, limits);
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
        fail(path, "too large for the memory of this machine");
    } catch (const std::length_error&) {
        fail(path, "too large for the memory of this machine");
    }
}

}  // namespace diptych::image
