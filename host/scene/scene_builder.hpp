// Scenes from code and from loaders: describe materials, meshes, placements, lights and a camera;
// finish() derives everything else that SceneData holds.
//
//     SceneBuilder scene;
//     const int red = scene.add_material({.base_color = {0.6f, 0.1f, 0.1f, 1}, .specular = 0});
//     const int lamp = scene.add_material({.emission = {5, 5, 5}});
//     scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, red)));
//     scene.place(scene.add_mesh(quad_mesh({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
//     scene.set_camera({.eye = {0, 1, 4}, .target = {0, 1, 0}});
//     const SceneData data = scene.finish();
#pragma once

#include "backends/scene_data.hpp"
#include "host/scene/picture.hpp"
#include "host/scene/scene_error.hpp"
#include "host/scene/transform.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace diptych {

// How a material reads an image. `to_uv` maps the mesh's (u, v, 1) to the image's.
struct TextureUse {
    int image = -1;  // of add_image(), or -1 for none
    int uv_set = 0;
    int wrap_u = WRAP_REPEAT;
    int wrap_v = WRAP_REPEAT;
    int filter = TEXTURE_LINEAR;
    std::array<std::array<double, 3>, 2> to_uv{{{1, 0, 0}, {0, 1, 0}}};
    int node = -1;  // of add_texture_node(), instead of an image: what it computes is read
};

// What an argument of a procedural texture is given: numbers, images or another node's result.
struct TextureInput {
    std::vector<double> numbers{};     // element after element, component after component
    std::vector<TextureUse> images{};  // one, or those of an array
    bool is_linear = false;            // images: values, not colours in sRGB
    int node = -1;
};

// One node of the graph: a function with its arguments.
struct TextureNode {
    std::string name{};
    int function = 0;  // of add_texture_function()
    std::map<std::string, TextureInput> arguments{};
    std::map<std::string, std::string> values{};  // the same in JSON, where they come from there
};

// For all procedural textures of a scene.
struct TextureSettings {
    int occlusion_rays = 16;        // of each request
    double occlusion_distance = 0;  // where a request asks none; 0: a tenth of the scene's radius
    double time = 0;                // seconds
};

// The metallic-roughness material of glTF with its defaults, except that metallic is 0.
struct MaterialInput {
    std::string name{};
    std::array<float, 4> base_color{1, 1, 1, 1};  // linear, alpha
    float metallic = 0;
    float roughness = 1;
    float specular = 1;  // 0, with metallic 0: exactly Lambert
    std::array<float, 3> specular_color{1, 1, 1};
    float ior = 1.5f;
    std::array<float, 3> emission{0, 0, 0};  // radiance, front side only
    float normal_scale = 1;
    int alpha_mode = ALPHA_OPAQUE;
    float alpha_cutoff = 0.5f;
    bool is_unlit = false;
    bool is_double_sided = false;
    TextureUse base_texture{};                // sRGB, alpha linear
    TextureUse metallic_roughness_texture{};  // linear: G roughness, B metallic
    TextureUse normal_texture{};              // linear
    TextureUse emission_texture{};            // sRGB
    TextureUse specular_texture{};            // linear: alpha
    TextureUse specular_color_texture{};      // sRGB
};

// Triangles of one material. Counter-clockwise corners face front. Without normals the surface is
// flat; without tangents they are derived where a normal map needs them.
struct MeshPart {
    std::vector<float3> positions{};
    std::vector<uint> indices{};             // three a triangle; empty: 0, 1, 2, ...
    std::vector<float3> normals{};           // empty, or one a vertex; so are the others
    std::vector<std::vector<float2>> uvs{};  // [set][vertex]
    std::vector<float4> tangents{};          // w = handedness
    std::vector<float4> colors{};            // linear, alpha; multiply the base colour
    int material = -1;                       // of add_material(), or -1 for the default material
};

struct PunctualLight {
    int kind = LIGHT_POINT;                   // LIGHT_POINT, LIGHT_SPOT or LIGHT_DIRECTIONAL
    std::array<float, 3> intensity{1, 1, 1};  // W/sr; directional: irradiance, W/m^2
    Vec3 position{0, 0, 0};
    Vec3 direction{0, 0, -1};  // in which light travels
    double inner_angle = 0;    // spot: half angles of the cone, radians
    double outer_angle = 0.78539816339744831;
    double range = 0;  // no light beyond it; 0 for no limit
};

struct CameraInput {
    Vec3 eye{0, 0, 0};
    Vec3 target{0, 0, -1};
    Vec3 up{0, 1, 0};
    double fov = 0.78539816339744831;  // vertical field of view, radians
    double half_height = 0;            // above 0: orthographic, of this half height
};

class SceneBuilder {
public:
    // Each returns the number by which the others refer to it.
    int add_image(Picture picture);
    int add_material(const MaterialInput& material);
    int add_texture_function(TextureFunction function);
    int add_texture_node(TextureNode node);
    void set_textures(const TextureSettings& settings);
    // Shows what the node gives, where a path first meets a surface, as a layer of the picture.
    void add_aov(int node);
    int add_mesh(std::vector<MeshPart> parts, const std::string& name = "");
    int add_mesh(MeshPart part, const std::string& name = "");

    // A mesh placed once is merged into the world; placed more often, it is stored once and
    // instanced. Throws SceneError if the transform is not finite.
    void place(int mesh, const Transform& to_world = {}, const std::string& name = "");

    // Gives every placement its own copy of meshes whose copies hold no more than `triangles` in
    // all: the second level of a tree and an instance's transforms cost more than so few triangles
    // save.
    void copy_small_meshes(size_t triangles);

    void add_light(const PunctualLight& light);
    void set_camera(const CameraInput& camera);
    // Latitude-longitude radiance map; u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi, row 0 = +Y.
    // Turned by `rotation` radians about +Y, multiplied by `scale`.
    void set_environment(Picture map, double rotation = 0, float scale = 1);
    void set_picture_size(int width, int height);
    void disable_effects(unsigned mask);  // tests: pretend that the scene does not call for them
    void notice(const std::string& line);

    bool has_camera() const { return camera_.has_value(); }
    bool has_environment() const { return environment_.has_value(); }
    // Whether anything placed or added so far emits light, the environment not counted.
    bool has_lights() const;
    // Of everything placed: low and high corner. False if there is nothing.
    bool bounds(Vec3& low, Vec3& high) const;

    // Everything derived: merged and instanced geometry, tangents, packed textures, lights with
    // their probabilities, the environment's importance cells, effects. Without a camera, one that
    // frames the bounds. Leaves the builder empty. bvh_nodes and root_node are the backend's.
    // Throws SceneError for positions that are not finite, indices out of range or sizes beyond
    // what 32-bit indices can address.
    SceneData finish();

private:
    friend class SceneAssembly;

    struct Mesh {
        std::string name;
        std::vector<MeshPart> parts;
        Vec3 low, high;  // of finite positions; low > high when there are none
    };
    struct Placement {
        int mesh;
        Transform to_world;
        std::string name;
    };
    struct EnvironmentMap {
        Picture map;
        double rotation;
        float scale;
    };

    std::vector<Picture> pictures_;
    std::vector<MaterialInput> materials_;
    std::vector<TextureFunction> texture_functions_;
    std::vector<TextureNode> texture_nodes_;
    TextureSettings texture_settings_;
    std::vector<int> aovs_;  // nodes
    std::vector<Mesh> meshes_;
    std::vector<Placement> placements_;
    std::vector<PunctualLight> lights_;
    std::optional<CameraInput> camera_;
    std::optional<EnvironmentMap> environment_;
    std::vector<std::string> notices_;
    int width_ = 512;
    int height_ = 512;
    unsigned disabled_effects_ = 0;
};

// Changes width, height and, keeping the vertical field of view, the camera's horizontal one.
void set_picture_size(SceneData& scene, int width, int height);

// Ready-made parts, outward facing. A quad has corners origin, +edge_u, +edge_u+edge_v, +edge_v,
// faces cross(edge_u, edge_v) and has uv (0,0) at the origin. A sphere of `segments` meridians and
// half as many parallels has smooth normals.
MeshPart quad_mesh(const Vec3& origin, const Vec3& edge_u, const Vec3& edge_v, int material = -1);
MeshPart box_mesh(const Vec3& low, const Vec3& high, int material = -1);
MeshPart sphere_mesh(const Vec3& centre, double radius, int segments = 64, int material = -1);

}  // namespace diptych
