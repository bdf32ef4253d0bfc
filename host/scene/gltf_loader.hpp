// From a glTF document to a SceneBuilder, in three steps, a file each: nodes (gltf_nodes.cpp) say
// what is placed where; materials (gltf_materials.cpp) and meshes (gltf_meshes.cpp) are read as far
// as something placed uses them.
#pragma once

#include "host/scene/gltf_document.hpp"
#include "host/scene/model.hpp"

namespace diptych {

class TextureReader;

class GltfLoader {
public:
    GltfLoader(GltfDocument& document, const LoadOptions& options, SceneBuilder& scene)
        : document_(document), model_(document.model()), options_(options), scene_(scene)
    {
    }
    void run();
    // Its geometry alone, for read_model().
    std::vector<ModelPlacement> run_for_model();

private:
    struct NodePlacement {
        int mesh;
        Transform to_world;
        std::string name;
    };
    struct NodeCamera {
        int camera;
        Transform to_world;
        std::string name;
    };

    // gltf_nodes.cpp
    std::vector<int> scene_roots();
    void refuse_cycles() const;
    void visit_nodes();
    void visit_node(int node, const Transform& to_world);
    void add_instances(int node, const Transform& to_world);
    void add_node_light(int light, const Transform& to_world);
    void choose_camera();
    std::string node_name(int node) const;

    // gltf_materials.cpp
    void add_materials();
    MaterialInput material_input(int material) const;
    TextureUse texture_use(int texture, int uv_set, const tinygltf::ExtensionMap& extensions) const;
    void read_images();
    int image_of(int texture) const;
    int used_image(int texture, const std::string& user) const;
    void decode(const std::vector<StoredImage>& images);

    // gltf_textures.cpp
    void add_textures();
    TextureInput texture_input(const nlohmann::json& value, const TextureReader& reader,
                               const std::string& where, int depth) const;

    // gltf_meshes.cpp
    void add_meshes();
    std::vector<MeshPart> mesh_parts(int mesh);
    bool read_part(const tinygltf::Primitive& primitive, const std::string& where, MeshPart& part);
    bool read_uv_set(const tinygltf::Primitive& primitive, size_t set, const std::string& where,
                     MeshPart& part);
    void read_uvs(const tinygltf::Primitive& primitive, const std::string& where, MeshPart& part);
    void read_colors(const tinygltf::Primitive& primitive, const std::string& where,
                     MeshPart& part);
    void tell_what_was_skipped();

    GltfDocument& document_;
    const tinygltf::Model& model_;
    const LoadOptions& options_;
    SceneBuilder& scene_;
    std::vector<NodePlacement> placements_;
    std::vector<NodeCamera> cameras_;
    std::vector<MaterialInput> materials_;  // images still numbered as in the file
    std::vector<TextureNode> texture_nodes_;
    std::vector<int> mesh_numbers_;  // in the builder; -1: not placed
    std::vector<char> node_visited_;
    bool reads_all_uvs_ = false;  // sets 0 and 1, whether or not the materials do
    size_t nodes_of_two_parents_ = 0;
    size_t points_and_lines_ = 0;
    size_t without_positions_ = 0;
    size_t bad_colors_ = 0;
    size_t missing_uv_sets_ = 0;
};

// A number of an extension object that was checked to be one.
inline double number_of(const tinygltf::Value& object, const char* key, double fallback)
{
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

}  // namespace diptych
