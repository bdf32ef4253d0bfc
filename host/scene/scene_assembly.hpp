// How SceneBuilder::finish() turns descriptions into the buffers of SceneData: one pass, each step
// using what the steps before it derived.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <set>

namespace diptych {

// Stands in for the material of parts that name none: the default of glTF.
inline constexpr const char* default_material_name = "(default material)";

class SceneAssembly {
public:
    explicit SceneAssembly(SceneBuilder& builder) : builder_(builder) {}
    SceneData run();

private:
    // Facts about a picture that outlive its texels' packing; colours linear.
    struct PictureFacts {
        int image_linear = -1;  // index in SceneData::images for each use
        int image_srgb = -1;
        float lowest_alpha = 1;
        std::array<double, 3> mean_srgb{};  // of the decoded colours, when used as sRGB
    };

    // scene_assembly.cpp: geometry
    void tell_what_was_repaired();
    void survey_placements();
    void survey_materials();
    void check_part(const std::string& where, const MeshPart& part) const;
    void prepare_part(const std::string& where, MeshPart& part);
    void reserve_geometry();
    void append_mesh(SceneBuilder::Mesh& mesh, const Transform& to_world);
    void append_vertices(const MeshPart& part, const Transform& to_world);
    void append_triangles(const MeshPart& part, int first_vertex, bool is_mirrored);
    void assemble_geometry();

    // view_assembly.cpp
    void assemble_bounds();
    void assemble_camera();
    CameraInput framing_camera() const;

    // material_assembly.cpp
    void assemble_images();
    int pack_picture(const Picture& picture, bool is_srgb, int shared_texels);
    void assemble_materials();
    Material packed_material(const MaterialInput& input);
    int add_slot(const TextureUse& use, bool is_srgb);
    int add_image_slot(const TextureUse& use, bool is_srgb, int stored_set);
    bool can_be_transparent(const MaterialInput& input) const;
    void assemble_effects();

    // texture_assembly.cpp
    class TexturePages;
    void survey_textures();
    void assemble_textures();
    void assemble_aovs(TexturePages& pages);

    // emitter_power.cpp
    void estimate_emitters();

    // light_assembly.cpp
    void assemble_lights();
    void add_triangle_lights(std::vector<double>& powers);
    void add_punctual_lights(std::vector<double>& powers);

    // A material's slots, by SLOT_*.
    static std::array<const TextureUse*, SLOT_COUNT> slots_of(const MaterialInput& material);
    bool is_used(int material) const { return material_used_[size_t(material)]; }
    const TextureUse* normal_texture(const MeshPart& part) const;
    bool is_merged(const SceneBuilder::Placement& placement) const;

    SceneBuilder& builder_;
    SceneData data_;
    std::vector<int> placement_counts_;  // by mesh
    std::vector<char> material_used_;
    std::vector<char> material_colored_;  // some mesh with vertex colours uses it
    std::array<int, 8> uv_slots_{};       // stored set of each of the mesh's, or -1
    int uv_set_count_ = 0;
    bool any_normals_ = false;
    bool any_normal_map_ = false;
    bool any_tangents_ = false;  // asked for by textures
    bool any_colors_ = false;
    size_t repaired_normals_ = 0;
    size_t repaired_uvs_ = 0;
    std::vector<char> node_used_;  // by some material in use, directly or through others
    unsigned attributes_ = 0;      // that the textures in use ask for
    std::vector<PictureFacts> pictures_;
    std::vector<std::array<double, 3>> mean_emission_;  // by material; painted ones: estimated
    double environment_power_ = 0;  // luminance of its radiance, over all directions; 0 without
};

inline double luminance(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

}  // namespace diptych
