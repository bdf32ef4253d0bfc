// A glTF file opened: its checked model, and its buffers and images, read when they are asked for.
#pragma once

#include "host/scene/picture.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace diptych {

// Under this name among the attributes the model holds indices that come from a sparse accessor
// without a buffer view, which the parser would refuse as indices.
inline constexpr const char* implied_indices_key = "_INDICES";

// An image file in memory.
struct StoredImage {
    StoredImage() = default;
    StoredImage(StoredImage&&) = default;  // a moved vector keeps its bytes where they are
    StoredImage& operator=(StoredImage&&) = default;

    std::span<const std::uint8_t> bytes;  // of `storage`, or of the document's buffers
    std::vector<std::uint8_t> storage;
    std::string where;  // for errors
};

// The chunks of a .glb file, or the text of a .gltf file.
struct GltfContainer {
    std::string text;
    std::vector<std::uint8_t> binary;
    bool has_binary = false;
};
// Told apart by the first bytes. Throws SceneError.
GltfContainer open_gltf(const std::filesystem::path& file);

class GltfDocument {
public:
    // Reads .gltf and .glb, told apart by their first bytes. URIs may not leave the file's folder
    // unless `allow_outside`. Throws SceneError.
    GltfDocument(const std::filesystem::path& file, bool allow_outside);

    // Without buffers and images, which are had from the functions below. Indices and declared
    // sizes in it have been checked (gltf_check.hpp).
    const tinygltf::Model& model() const { return model_; }

    std::span<const std::uint8_t> buffer_view(int view);
    // Image `image` of the file as it is stored; `user` names who uses it in errors.
    StoredImage stored_image(int image, const std::string& user);
    // The extension DIPTYCH_procedural_texture as it stands in the file, unchecked: that of the
    // document, and that of each material; null where there is none.
    const nlohmann::json& textures() const { return textures_; }
    const nlohmann::json& textures_of(int material) const;
    int material_count() const { return int(material_textures_.size()); }
    // The file that a relative URI names; it may not leave the folder unless allowed.
    std::filesystem::path resolved(const std::string& uri, const std::string& where) const;
    void release_buffers() { buffers_.clear(); }

    // About extensions that are used but not simulated, animations, skins, morph targets.
    const std::vector<std::string>& notices() const { return notices_; }

private:
    struct Source {
        std::string uri;
        size_t byte_length = 0;
        int buffer_view = -1;
    };

    void parse(const std::string& text);
    const std::vector<std::uint8_t>& buffer(int index);

    std::filesystem::path folder_;
    bool allow_outside_;
    tinygltf::Model model_;
    nlohmann::json textures_;
    std::vector<nlohmann::json> material_textures_;
    std::vector<std::string> notices_;
    std::vector<Source> buffer_sources_;
    std::vector<Source> image_sources_;
    std::map<int, std::vector<std::uint8_t>> buffers_;
    std::vector<std::uint8_t> binary_chunk_;
    bool has_binary_chunk_ = false;
};

// Values of an accessor as floats, `components` an element (a VEC3 read as 4 gets `fill` last);
// normalised, strided and sparse ones resolved. `where` names the use in errors.
std::vector<float> accessor_floats(GltfDocument& document, int accessor, int components, float fill,
                                   const std::string& where);
// Of a SCALAR accessor of an unsigned type.
std::vector<unsigned> accessor_indices(GltfDocument& document, int accessor,
                                       const std::string& where);

}  // namespace diptych
