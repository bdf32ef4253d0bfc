// Writes small glTF files for tests: a document to edit and a buffer to fill.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace diptych {

inline std::string base64(const std::vector<std::uint8_t>& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (size_t k = 0; k < 3; ++k) {
            bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        }
        for (size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
        }
    }
    return text;
}

// A folder of one test, empty at its start.
inline std::filesystem::path test_folder()
{
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const auto folder = std::filesystem::path(testing::TempDir()) / "diptych_scene" /
                        info->test_suite_name() / info->name();
    static std::filesystem::path made;
    if (made != folder) {
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder);
        made = folder;
    }
    return folder;
}

inline std::filesystem::path write_file(const std::string& name, const std::string& text)
{
    const auto file = test_folder() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

struct GltfText {
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::uint8_t> bytes;

    // Appends values as a buffer view of their own, or with a stride.
    template<typename T>
    int add_view(const std::vector<T>& values, int stride = 0)
    {
        while (bytes.size() % 4 != 0) {
            bytes.push_back(0);
        }
        const size_t offset = bytes.size(), size = values.size() * sizeof(T);
        bytes.resize(offset + size);
        std::memcpy(bytes.data() + offset, values.data(), size);
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
        if (stride > 0) {
            view["byteStride"] = stride;
        }
        return push("bufferViews", view);
    }

    template<typename T>
    int add_accessor(const std::vector<T>& values, const std::string& type, int component_type,
                     size_t count)
    {
        return push("accessors", {{"bufferView", add_view(values)},
                                  {"componentType", component_type},
                                  {"count", count},
                                  {"type", type}});
    }

    int push(const std::string& array, const nlohmann::json& value)
    {
        document[array].push_back(value);
        return int(document[array].size()) - 1;
    }

    // A mesh of one primitive, shown by a node of its own.
    nlohmann::json& add_mesh(const nlohmann::json& attributes)
    {
        const int mesh = push("meshes", {{"primitives", {{{"attributes", attributes}}}}});
        const int node = push("nodes", {{"mesh", mesh}});
        if (!document.contains("scenes")) {
            document["scenes"] = {{{"nodes", {}}}};
        }
        document["scenes"][0]["nodes"].push_back(node);
        return document["meshes"].back()["primitives"][0];
    }

    // The triangle (0,0,0) (1,0,0) (0,1,0), unless other positions are given.
    nlohmann::json& add_triangle(const std::vector<float>& positions = {0, 0, 0, 1, 0, 0, 0, 1, 0})
    {
        return add_mesh(
            {{"POSITION", add_accessor(positions, "VEC3", 5126, positions.size() / 3)}});
    }

    std::string text() const
    {
        nlohmann::json result = document;
        if (!bytes.empty()) {
            result["buffers"] = {
                {{"byteLength", bytes.size()},
                 {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        }
        return result.dump();
    }

    std::filesystem::path write(const std::string& name = "scene.gltf") const
    {
        return write_file(name, text());
    }
};

}  // namespace diptych
