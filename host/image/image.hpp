// Pictures in memory and on disk. Nothing here knows the renderer: OpenImageIO reads and encodes,
// this folder decides how layers are named, what a display picture shows, and that no half-written
// file is ever seen.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace diptych::image {

// One named group of channels, pixel by pixel, rows from the top: `pixels` for quantities, `ids`
// for whole numbers (object and material ids, sample counts). Exactly one of the two is filled,
// width * height * channels.size() long. The beauty layer has the empty name; others are stored as
// "name.channel", or plain "name" for an empty channel.
struct Layer {
    std::string name;
    std::vector<std::string> channels;
    std::vector<float> pixels;
    std::vector<uint32_t> ids;
};

// What a colour value of 1 means.
enum class Encoding {
    Linear,   // scene-linear Rec.709: EXR, HDR, float TIFF
    Display,  // sRGB-encoded 0..1: PNG, JPEG, 8- and 16-bit TIFF
};

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Layer> layers;
    std::map<std::string, std::string> metadata;  // EXR only; "DateTime" is stored as capDate
    Encoding encoding = Encoding::Linear;
};

// Layers in the order and with the channel names that other programs expect. Values as described at
// each.
Layer beauty_layer(std::vector<float> rgba);  // R,G,B,A: radiance, alpha associated
Layer albedo_layer(std::vector<float> rgb);   // albedo.R,G,B
Layer normal_layer(std::vector<float> xyz);   // normal.X,Y,Z: shading normal, world space
Layer depth_layer(
    std::vector<float> distances);  // Z: the one reserved name for depth in an OpenEXR file
Layer standard_error_layer(std::vector<float> rgb);   // standard_error.R,G,B: of the beauty's mean
Layer predicted_error_layer(std::vector<float> jnd);  // predicted_error: visible error, see manual
Layer id_layer(std::string name, std::vector<uint32_t>);  // object_id, material_id, sample_count
// aov.NODE.R, G, B, A, or the first of these: raw numbers of a texture node, never stored as half.
Layer node_layer(const std::string& node, int channels, std::vector<float> values);
bool is_node_layer(const Layer& layer);

// The layer of that name, or null.
const Layer* find_layer(const Picture& picture, const std::string& name);
const Layer& beauty_of(const Picture& picture);  // throws when there is none

// How scene-linear radiance becomes display values (view_transform.hpp).
enum class View { Standard, Neutral, Filmic };

struct WriteOptions {
    bool half = false;  // EXR: colours and normals as half; depth and nodes stay float, ids uint
    bool sixteen_bit = false;  // PNG and TIFF
    bool alpha = false;  // PNG and TIFF: with the alpha channel, unassociated; otherwise opaque, as
                         // the beauty is
    float exposure = 0;  // stops; PNG, JPEG, TIFF only
    View view = View::Standard;
};

// Encodes by extension: exr holds every layer and the metadata; png, jpg, jpeg, tif, tiff show the
// beauty layer. The same input gives the same bytes. The file appears whole or not at all: it is
// encoded in memory and written by write_file_whole. Throws
// std::runtime_error (path: what; what to do).
void write_picture(const std::string& path, const Picture& picture,
                   const WriteOptions& options = {});

// The same picture to all of the paths; where some cannot be written, the others are before an
// error is thrown that names each.
void write_pictures(const std::vector<std::string>& paths, const Picture& picture,
                    const WriteOptions& options = {});

// Likewise, of outputs of several kinds: `write` throws std::runtime_error for one.
void write_each(const std::vector<std::string>& paths,
                const std::function<void(const std::string&)>& write);

// Its extension is one that write_picture knows; one of a format that holds layers, and halves; one
// of a format that can hold display colours in 16 bits.
bool is_picture_name(const std::string& path);
bool holds_layers(const std::string& path);
bool holds_sixteen_bits(const std::string& path);

// Its extension is one of a picture format that can be read or written somewhere, but not here.
bool is_foreign_picture_name(const std::string& path);

// Throws now what write_picture would throw after the rendering: unknown extension, no such folder,
// not writable, not a file.
void check_writable(const std::string& path);
void check_file_writable(const std::string& path);  // of any kind: by write_file_whole

// Puts bytes at a path, whole or not at all (whole_file.hpp, which also has texts that may go to a
// pipe).
void write_file_whole(const std::string& path, std::string_view bytes);

struct ReadLimits {
    uint64_t pixels = 1ull << 28;  // 16384 x 16384
    uint64_t values = 1ull << 31;  // pixels x channels
};

// Every channel of every part that covers the same window, grouped into layers: "x.R" goes to layer
// "x", R, G, B, A to the beauty, Z to "depth". What the file stores outside its display window is
// cropped, what it lacks is zero. Sizes are checked from the header, before anything is allocated.
// Throws std::runtime_error with one line for any file that cannot be read whole.
Picture read_picture(const std::string& path, const ReadLimits& limits = {});

}  // namespace diptych::image
