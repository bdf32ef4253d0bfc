#include "host/scene/gltf_document.hpp"

#include "host/scene/gltf_check.hpp"
#include "host/scene/gltf_extensions.hpp"
#include "host/scene/scene_error.hpp"
#include "host/scene/uri.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fstream>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The first `at_most` bytes of a file, or all.
std::vector<std::uint8_t> read_file(const fs::path& file, const std::string& where,
                                    size_t at_most = SIZE_MAX)
{
    std::error_code error;
    const auto status = fs::status(file, error);
    if (!fs::exists(status)) {
        throw SceneError(where + ": no such file; check the name");
    }
    if (fs::is_directory(status)) {
        throw SceneError(where + ": is a folder; name a file in it");
    }
    if (!fs::is_regular_file(status)) {
        throw SceneError(where + ": is not a regular file; name a file");
    }
    std::ifstream stream(file, std::ios::binary);
    const size_t size = std::min<size_t>(fs::file_size(file, error), at_most);
    if (!stream || error) {
        throw SceneError(where + ": cannot be opened; check its permissions");
    }
    std::vector<std::uint8_t> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    if (size_t(stream.gcount()) != size) {
        throw SceneError(where + ": cannot be read; try again");
    }
    return bytes;
}

unsigned word(const std::vector<std::uint8_t>& bytes, size_t at)
{
    return unsigned(bytes[at]) | unsigned(bytes[at + 1]) << 8 | unsigned(bytes[at + 2]) << 16 |
           unsigned(bytes[at + 3]) << 24;
}

GltfContainer opened_glb(const std::vector<std::uint8_t>& bytes)
{
    if (bytes.size() < 20) {
        throw SceneError("header: the file is truncated; copy it again");
    }
    if (word(bytes, 4) != 2) {
        throw SceneError(
            fmt::format("header: version {} of the container, where 2 is known; export "
                        "it as glTF 2.0",
                        word(bytes, 4)));
    }
    const size_t length = word(bytes, 8);
    if (length > bytes.size() || length < 20) {
        throw SceneError(fmt::format("header: {} bytes announced, {} there; the file is truncated, "
                                     "copy it again",
                                     length, bytes.size()));
    }
    GltfContainer result;
    size_t at = 12;
    for (int chunk = 0; at + 8 <= length; ++chunk) {
        const size_t size = word(bytes, at);
        const unsigned kind = word(bytes, at + 4);
        if (size > length - at - 8) {
            throw SceneError(fmt::format("chunk {}: {} bytes announced, {} there; the file is "
                                         "truncated, copy it again",
                                         chunk, size, length - at - 8));
        }
        const auto first = bytes.begin() + std::ptrdiff_t(at + 8);
        const auto last = first + std::ptrdiff_t(size);
        if (chunk == 0) {
            if (kind != 0x4E4F534A) {
                throw SceneError("chunk 0: is not JSON; repair the file");
            }
            result.text.assign(first, last);
        } else if (kind == 0x004E4942 && !result.has_binary) {
            result.binary.assign(first, last);
            result.has_binary = true;
        }
        at += 8 + size;
    }
    return result;
}

json parsed(const std::string& text)
{
    try {
        return json::parse(text);
    } catch (const json::exception& e) {
        throw SceneError(fmt::format("JSON: {}; repair the file", printable(e.what())));
    }
}

std::vector<std::string> names(const json& document, const char* key)
{
    return document.contains(key) ? document[key].get<std::vector<std::string>>()
                                  : std::vector<std::string>{};
}

void note_motion(const json& document, std::vector<std::string>& notices)
{
    const auto has = [&](const char* key) {
        return document.contains(key) && document[key].is_array() && !document[key].empty();
    };
    if (has("animations")) {
        notices.push_back("animations: ignored, nodes stand as stored");
    }
    if (has("skins")) {
        notices.push_back("skins: ignored, meshes stand as stored");
    }
    if (!has("meshes")) {
        return;
    }
    for (const json& mesh : document["meshes"]) {
        for (const json& primitive : mesh["primitives"]) {
            if (!primitive.contains("targets")) {
                continue;
            }
            notices.push_back("morph targets: ignored, meshes stand as stored");
            return;
        }
    }
}

void hide_implied_indices(json& document)
{
    if (!document.contains("meshes")) {
        return;
    }
    for (json& mesh : document["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.contains("indices")) {
                continue;
            }
            const json index = primitive["indices"];
            if (document["accessors"][index.get<size_t>()].contains("bufferView")) {
                continue;
            }
            primitive["attributes"][implied_indices_key] = index;
            primitive.erase("indices");
        }
    }
}

// The extension for procedural textures of a document or material; null: it has none.
json procedural(const json& holder)
{
    const auto extensions = holder.find("extensions");
    if (extensions == holder.end() || !extensions->is_object()) {
        return nullptr;
    }
    return extensions->value("DIPTYCH_procedural_texture", json());
}

}  // namespace

GltfContainer open_gltf(const fs::path& file)
{
    std::vector<std::uint8_t> bytes = read_file(file, "file");
    if (bytes.empty()) {
        throw SceneError("file: is empty; name a glTF file");
    }
    if (bytes.size() >= 4 && std::equal(bytes.begin(), bytes.begin() + 4, "glTF")) {
        return opened_glb(bytes);
    }
    const auto first = std::find_if(bytes.begin(), bytes.end(), [](std::uint8_t c) {
        return !std::isspace(c) && c != 0xef && c != 0xbb && c != 0xbf;
    });
    if (first == bytes.end() || *first != '{') {
        throw SceneError("file: neither JSON nor a .glb container; name a glTF 2.0 file");
    }
    return {std::string(bytes.begin(), bytes.end()), {}, false};
}

GltfDocument::GltfDocument(const fs::path& file, bool allow_outside)
    : folder_(file.has_parent_path() ? file.parent_path() : fs::path(".")),
      allow_outside_(allow_outside)
{
    GltfContainer container = open_gltf(file);
    has_binary_chunk_ = container.has_binary;
    binary_chunk_ = std::move(container.binary);
    parse(container.text);
}

const json& GltfDocument::textures_of(int material) const
{
    return material_textures_.at(size_t(material));
}

void GltfDocument::parse(const std::string& text)
{
    json document;
    {
        const json raw = parsed(text);
        document = checked_gltf(raw);
        notices_ = check_extensions(names(document, "extensionsUsed"),
                                    names(document, "extensionsRequired"));
        note_motion(raw, notices_);
        textures_ = procedural(raw);
        if (raw.contains("materials")) {
            for (const json& material : raw["materials"]) {
                material_textures_.push_back(procedural(material));
            }
        }
    }
    hide_implied_indices(document);
    const auto version = document["asset"]["version"].get<std::string>();
    if (!version.starts_with("2.")) {
        throw SceneError("asset.version: glTF " + printable(version) +
                         ", where 2.0 is known; export it as glTF 2.0");
    }
    const auto take = [&](const char* key, std::vector<Source>& sources) {
        if (!document.contains(key)) {
            return;
        }
        for (const json& entry : document[key]) {
            Source source;
            if (entry.contains("uri")) {
                source.uri = entry["uri"].get<std::string>();
            }
            if (entry.contains("byteLength")) {
                source.byte_length = entry["byteLength"];
            }
            if (entry.contains("bufferView")) {
                source.buffer_view = entry["bufferView"];
            }
            sources.push_back(std::move(source));
        }
        document.erase(key);
    };
    take("buffers", buffer_sources_);
    take("images", image_sources_);

    // The parser proper sees only what was checked above, and nothing that it would have to open.
    const std::string reduced = document.dump(-1, ' ', false, json::error_handler_t::replace);
    std::string error, warning;
    tinygltf::TinyGLTF parser;
    if (!parser.LoadASCIIFromString(&model_, &error, &warning, reduced.c_str(),
                                    unsigned(reduced.size()), "", tinygltf::NO_REQUIRE)) {
        throw SceneError("document: " + printable(error) + "; repair the file");
    }
}

// The file that a relative URI names.
fs::path GltfDocument::resolved(const std::string& uri, const std::string& where) const
{
    const fs::path path = uri_path(uri, where);
    const fs::path file = path.is_absolute() ? path : folder_ / path;
    if (allow_outside_) {
        return file;
    }
    std::error_code error;
    const fs::path home = fs::weakly_canonical(fs::absolute(folder_), error);
    const fs::path real = fs::weakly_canonical(fs::absolute(file), error);
    const auto [at_home, rest] = std::mismatch(home.begin(), home.end(), real.begin(), real.end());
    if (error || path.is_absolute() || at_home != home.end()) {
        throw SceneError(
            fmt::format("{}: {} leaves the scene's folder; pass --allow-outside if you "
                        "trust the scene",
                        where, printable(uri)));
    }
    return file;
}

const std::vector<std::uint8_t>& GltfDocument::buffer(int index)
{
    if (const auto at = buffers_.find(index); at != buffers_.end()) {
        return at->second;
    }
    const Source& source = buffer_sources_[size_t(index)];
    const std::string where = fmt::format("buffers[{}]", index);
    std::vector<std::uint8_t> bytes;
    if (source.uri.empty()) {
        if (index != 0 || !has_binary_chunk_) {
            throw SceneError(where + ": has no data: neither a URI nor a binary chunk; repair the "
                                     "file, or export it without compression");
        }
        bytes = std::move(binary_chunk_);
    } else if (is_data_uri(source.uri)) {
        bytes = data_uri_bytes(source.uri, where);
    } else {
        bytes = read_file(resolved(source.uri, where), where + " (" + printable(source.uri) + ")",
                          source.byte_length);
    }
    if (bytes.size() < source.byte_length) {
        throw SceneError(fmt::format("{}: {} bytes announced, {} there; restore the missing data",
                                     where, source.byte_length, bytes.size()));
    }
    return buffers_[index] = std::move(bytes);
}

std::span<const std::uint8_t> GltfDocument::buffer_view(int index)
{
    const tinygltf::BufferView& view = model_.bufferViews[size_t(index)];
    return std::span(buffer(view.buffer)).subspan(view.byteOffset, view.byteLength);
}

StoredImage GltfDocument::stored_image(int index, const std::string& user)
{
    const Source& source = image_sources_[size_t(index)];
    StoredImage image;
    image.where = fmt::format("images[{}]{}", index, user);
    if (source.buffer_view >= 0) {
        image.bytes = buffer_view(source.buffer_view);
        return image;
    }
    if (source.uri.empty()) {
        throw SceneError(image.where + ": has neither a URI nor a buffer view; repair the file");
    }
    if (is_data_uri(source.uri)) {
        image.storage = data_uri_bytes(source.uri, fmt::format("images[{}]", index));
    } else {
        image.where = fmt::format("images[{}] ({}){}", index, printable(source.uri), user);
        image.storage = read_file(resolved(source.uri, image.where), image.where);
    }
    image.bytes = image.storage;
    return image;
}

}  // namespace diptych
