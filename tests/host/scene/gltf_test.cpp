// Geometry, nodes and cameras of glTF files written here.
#include "host/scene/load.hpp"

#include "tests/host/scene/gltf_text.hpp"

#include <algorithm>
#include <set>

namespace diptych {
namespace {

SceneData load(const GltfText& gltf, LoadOptions options = {})
{
    options.environment = "none";
    options.copied_triangles = 0;
    return load_scene(gltf.write(), options);
}

// The positions of all triangles, corner by corner, as text: for comparing geometry.
std::string shape(const SceneData& scene)
{
    std::string text;
    for (const Triangle& t : scene.triangles) {
        for (const int v : {t.vertex0, t.vertex1, t.vertex2}) {
            const float4 p = scene.positions[size_t(v)];
            text += std::to_string(p.x) + "," + std::to_string(p.y) + " ";
        }
    }
    return text;
}

const std::vector<float> fan_corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0.5f, 1.5f, 0, 0, 1, 0};

TEST(Gltf, A_triangle)
{
    GltfText gltf;
    gltf.add_triangle();
    const SceneData scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions[1].x, 1);
    EXPECT_EQ(scene.positions[2].y, 1);
    EXPECT_EQ(scene.effects, unsigned(EFFECT_SPECULAR)) << "the default material is a metal";
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_TRUE(scene.normals.empty());
}

TEST(Gltf, Indices_of_every_type_mean_the_same)
{
    std::set<std::string> shapes;
    const auto with_indices = [&](auto values, int type) {
        GltfText gltf;
        auto& primitive = gltf.add_triangle(fan_corners);
        primitive["indices"] = gltf.add_accessor(values, "SCALAR", type, values.size());
        shapes.insert(shape(load(gltf)));
    };
    with_indices(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 4}, 5121);
    with_indices(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 4}, 5123);
    with_indices(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 4}, 5125);
    EXPECT_EQ(shapes.size(), 1u);
}

TEST(Gltf, Strips_and_fans_keep_their_front)
{
    for (const int mode : {5, 6}) {
        GltfText gltf;
        // Around the fan's centre, or zigzag for the strip: counter-clockwise from +z.
        auto& primitive = gltf.add_triangle(
            mode == 6 ? fan_corners
                      : std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
        primitive["mode"] = mode;
        const SceneData scene = load(gltf);
        ASSERT_EQ(scene.triangles.size(), 3u);
        double area = 0;
        for (const Triangle& t : scene.triangles) {
            const float4 a = scene.positions[size_t(t.vertex0)];
            const float4 e1 = scene.positions[size_t(t.vertex1)] - a;
            const float4 e2 = scene.positions[size_t(t.vertex2)] - a;
            const double twice = double(e1.x) * e2.y - double(e1.y) * e2.x;
            EXPECT_GT(twice, 0);
            area += twice / 2;
        }
        EXPECT_NEAR(area, mode == 6 ? 1.25 : 1.5, 1e-6);
    }
}

TEST(Gltf, Points_and_lines_are_skipped_with_a_notice)
{
    for (const int mode : {0, 1, 2, 3}) {
        GltfText gltf;
        gltf.add_triangle()["mode"] = mode;
        const SceneData scene = load(gltf);
        EXPECT_TRUE(scene.triangles.empty());
        ASSERT_EQ(scene.notices.size(), 2u);
        EXPECT_EQ(scene.notices[0], "meshes: 1 primitives of points or lines skipped");
        EXPECT_EQ(scene.notices[1], "scene: it has no triangles; only its background is visible");
    }
}

TEST(Gltf, Reads_interleaved_attributes)
{
    GltfText gltf;
    const std::vector<float> mixed{0, 0, 0, 0, 0, 1, 9, 2, 0, 0, 0, 0, 1, 9, 0, 3, 0, 0, 0, 1, 9};
    const int view = gltf.add_view(mixed, 28);
    const auto accessor = [&](int offset) {
        return gltf.push("accessors", {{"bufferView", view},
                                       {"byteOffset", offset},
                                       {"componentType", 5126},
                                       {"count", 3},
                                       {"type", "VEC3"}});
    };
    const int positions = accessor(0), normals = accessor(12);
    gltf.add_mesh({{"POSITION", positions}, {"NORMAL", normals}});
    const SceneData scene = load(gltf);
    EXPECT_EQ(shape(scene), "0.000000,0.000000 2.000000,0.000000 0.000000,3.000000 ");
    EXPECT_TRUE(scene.effects & EFFECT_SMOOTH_NORMALS);
    EXPECT_NEAR(normal_unpack(scene.normals[2]).z, 1, 1e-6);
}

TEST(Gltf, Sparse_accessors_replace_single_elements)
{
    for (const bool has_base : {true, false}) {
        GltfText gltf;
        auto& primitive = gltf.add_triangle({5, 0, 0, 1, 0, 0, 0, 1, 0});
        auto& accessor = gltf.document["accessors"][0];
        if (!has_base) {
            accessor.erase("bufferView");
        }
        const int indices = gltf.add_view(std::vector<std::uint16_t>{0, 2});
        const int values = gltf.add_view(std::vector<float>{7, 8, 0, 3, 4, 0});
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}};
        EXPECT_FALSE(primitive.contains("indices"));
        EXPECT_EQ(shape(load(gltf)), std::string("7.000000,8.000000 ") +
                                         (has_base ? "1.000000,0.000000 " : "0.000000,0.000000 ") +
                                         "3.000000,4.000000 ");
    }
}

// Indices that are all zero but for what the sparse part says: valid, if odd.
TEST(Gltf, Sparse_indices_need_no_buffer_view)
{
    GltfText gltf;
    auto& primitive = gltf.add_triangle();
    const int where = gltf.add_view(std::vector<std::uint8_t>{1, 2});
    const int values = gltf.add_view(std::vector<std::uint16_t>{1, 2});
    primitive["indices"] =
        gltf.push("accessors", {{"componentType", 5123},
                                {"count", 3},
                                {"type", "SCALAR"},
                                {"sparse",
                                 {{"count", 2},
                                  {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                  {"values", {{"bufferView", values}}}}}});
    EXPECT_EQ(load(gltf).triangles.size(), 1u);
}

TEST(Gltf, Quantized_and_normalized_positions)
{
    GltfText gltf;
    gltf.document["extensionsUsed"] =
        gltf.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    gltf.add_mesh(
        {{"POSITION",
          gltf.push("accessors", {{"bufferView",
                                   gltf.add_view(std::vector<std::int16_t>{-32768, 0, 0, 0, 32767,
                                                                           0, 0, 0, 0, 16384, 0, 0},
                                                 8)},
                                  {"componentType", 5122},
                                  {"normalized", true},
                                  {"count", 3},
                                  {"type", "VEC3"}})}});
    gltf.add_mesh(
        {{"POSITION",
          gltf.push(
              "accessors",
              {{"bufferView",
                gltf.add_view(std::vector<std::uint8_t>{255, 0, 0, 0, 0, 7, 0, 0, 0, 0, 9, 0}, 4)},
               {"componentType", 5121},
               {"count", 3},
               {"type", "VEC3"}})}});
    const SceneData scene = load(gltf);
    ASSERT_EQ(scene.positions.size(), 6u);
    EXPECT_EQ(scene.positions[0].x, -1) << "-32768 is clamped";
    EXPECT_EQ(scene.positions[1].x, 1);
    EXPECT_FLOAT_EQ(scene.positions[2].y, 16384 / 32767.0f);
    EXPECT_EQ(scene.positions[3].x, 255);
    EXPECT_EQ(scene.positions[4].y, 7);
}

TEST(Gltf, Vertex_colors_of_every_type)
{
    GltfText gltf;
    const auto add = [&](int colors) {
        auto& primitive = gltf.add_triangle();
        primitive["attributes"]["COLOR_0"] = colors;
    };
    add(gltf.add_accessor(std::vector<float>{0.5f, 0, 0, 2, NAN, -1, 1, 1, 1}, "VEC3", 5126, 3));
    const int bytes = gltf.add_accessor(
        std::vector<std::uint8_t>{255, 0, 0, 51, 0, 255, 0, 255, 0, 0, 255, 255}, "VEC4", 5121, 3);
    gltf.document["accessors"][size_t(bytes)]["normalized"] = true;
    add(bytes);
    const SceneData scene = load(gltf);
    EXPECT_TRUE(scene.effects & EFFECT_VERTEX_COLOR);
    EXPECT_EQ(scene.colors[0].x, 0.5f);
    EXPECT_EQ(scene.colors[0].w, 1.0f) << "three components are opaque";
    EXPECT_EQ(scene.colors[1].x, 1.0f);
    EXPECT_EQ(scene.colors[1].y, 1.0f) << "not a number";
    EXPECT_EQ(scene.colors[1].z, 0.0f);
    EXPECT_FLOAT_EQ(scene.colors[3].w, 0.2f);
    EXPECT_EQ(scene.notices.back(),
              "meshes: 1 vertex colour values that are not numbers taken as 1");
}

TEST(Gltf, Node_transforms_compose)
{
    GltfText gltf;
    gltf.add_triangle();
    const double half = std::sqrt(0.5);
    gltf.document["nodes"] = {
        {{"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}, {"children", {1}}},
        {{"matrix", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}, {"mesh", 0}}};
    const SceneData scene = load(gltf);
    // (1, 0) -> matrix (7, 0) -> a quarter turn (0, 7) -> (10, 7).
    EXPECT_NEAR(scene.positions[1].x, 10, 1e-6);
    EXPECT_NEAR(scene.positions[1].y, 7, 1e-6);
    EXPECT_NEAR(scene.positions[2].x, 7, 1e-6);
    EXPECT_NEAR(scene.positions[2].y, 5, 1e-6);
}

TEST(Gltf, A_mesh_of_two_nodes_is_stored_once)
{
    GltfText gltf;
    gltf.add_triangle();
    gltf.document["nodes"] = {{{"mesh", 0}, {"name", "left"}},
                              {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    gltf.document["scenes"][0]["nodes"] = {0, 1};
    const SceneData scene = load(gltf);
    EXPECT_EQ(scene.positions.size(), 3u);
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.instance_names[1], "left");
    EXPECT_EQ(scene.instance_names[2], "node 1");
    EXPECT_FALSE(scene.instances[1].is_mirrored);
    EXPECT_TRUE(scene.instances[2].is_mirrored);
    EXPECT_TRUE(scene.effects & EFFECT_INSTANCES);
}

TEST(Gltf, A_small_mesh_is_copied_instead)
{
    GltfText gltf;
    gltf.add_triangle();
    gltf.document["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    gltf.document["scenes"][0]["nodes"] = {0, 1};
    LoadOptions options;
    options.environment = "none";
    options.copied_triangles = 1;
    EXPECT_EQ(load_scene(gltf.write(), options).instances.size(), 3u);
    options.copied_triangles = 2;
    const SceneData scene = load_scene(gltf.write(), options);
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_FALSE(scene.effects & EFFECT_INSTANCES);
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.triangle_objects[0], 0);
    EXPECT_EQ(scene.triangle_objects[1], 1);
}

TEST(Gltf, Gpu_instancing_places_its_mesh_for_every_element)
{
    GltfText gltf;
    gltf.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    gltf.add_triangle();
    const int where =
        gltf.add_accessor(std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3", 5126, 3);
    const int scale =
        gltf.add_accessor(std::vector<float>{1, 1, 1, 2, 2, 2, 0, 1, 1}, "VEC3", 5126, 3);
    gltf.document["nodes"][0]["translation"] = {0, 5, 0};
    gltf.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", where}, {"SCALE", scale}};
    const SceneData scene = load(gltf);
    ASSERT_EQ(scene.instances.size(), 3u) << "the third is flat";
    EXPECT_EQ(scene.degenerate_triangles, 1u);
    EXPECT_EQ(scene.instances[2].to_world_x.w, 2);
    EXPECT_EQ(scene.instances[2].to_world_y.w, 5);
    EXPECT_EQ(scene.instances[2].to_world_y.y, 2);
    EXPECT_EQ(scene.instance_names[2], "node 0 #1");
}

TEST(Gltf, Scenes_are_chosen_by_number)
{
    GltfText gltf;
    gltf.add_triangle();
    gltf.add_triangle();
    gltf.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 1}}}};
    EXPECT_EQ(load(gltf).triangles.size(), 1u);
    gltf.document["scene"] = 1;
    EXPECT_EQ(load(gltf).triangles.size(), 2u);
    EXPECT_EQ(load(gltf, {.scene_index = 0}).triangles.size(), 1u);
    EXPECT_THROW(load(gltf, {.scene_index = 2}), SceneError);
    gltf.document.erase("scene");
    gltf.document.erase("scenes");
    EXPECT_EQ(load(gltf).triangles.size(), 2u) << "without scenes, all nodes";
}

// Real exporters list nodes as roots that are children too.
TEST(Gltf, A_node_reached_twice_is_shown_once)
{
    GltfText gltf;
    gltf.add_triangle();
    gltf.document["nodes"] = {{{"mesh", 0}}, {{"translation", {0, 0, 9}}, {"children", {0}}}};
    gltf.document["scenes"][0]["nodes"] = {0, 1};
    const SceneData scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions[0].z, 9);
    EXPECT_EQ(scene.notices[0], "nodes: 1 reached a second time, shown once");
}

TEST(Gltf, Deep_hierarchies_need_no_deep_stack)
{
    GltfText gltf;
    gltf.add_triangle();
    constexpr int depth = 100000;
    for (int k = 1; k < depth; ++k) {
        gltf.document["nodes"].push_back({{"children", {k - 1}}, {"translation", {0, 0, 1}}});
    }
    gltf.document["scenes"][0]["nodes"] = {depth - 1};
    EXPECT_EQ(load(gltf).positions[0].z, depth - 1);
}

TEST(Gltf, Cameras_by_name_and_number)
{
    GltfText gltf;
    gltf.document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
        {{"type", "orthographic"},
         {"name", "plan"},
         {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 9}}}}};
    gltf.document["nodes"] = {
        {{"camera", 0}, {"name", "eye"}, {"translation", {0, 0, 5}}},
        {{"camera", 1}, {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}}};
    gltf.document["scenes"] = {{{"nodes", {0, 1}}}};
    const auto settings = [&](const char* camera) {
        return load(gltf, {.camera = camera, .width = 200, .height = 100}).settings[0];
    };
    const Settings first = settings("");
    EXPECT_EQ(first.camera_kind, CAMERA_PERSPECTIVE);
    EXPECT_EQ(first.camera_origin.z, 5);
    EXPECT_EQ(first.camera_forward.z, -1);
    EXPECT_FLOAT_EQ(first.camera_up.y, float(std::tan(0.4)));
    EXPECT_FLOAT_EQ(first.camera_right.x, float(2 * std::tan(0.4)));
    for (const char* name : {"1", "plan"}) {
        const Settings plan = settings(name);
        EXPECT_EQ(plan.camera_kind, CAMERA_ORTHOGRAPHIC);
        EXPECT_NEAR(plan.camera_forward.y, -1, 1e-6);
        EXPECT_NEAR(plan.camera_up.z, -2, 1e-6);
        EXPECT_NEAR(plan.camera_right.x, 4, 1e-6);
    }
    EXPECT_EQ(settings("eye").camera_origin.z, 5);
    try {
        settings("side");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), (test_folder() / "scene.gltf").string() +
                                    ": camera side: the scene has no such camera; it has "
                                    "0 (eye), 1 ()");
    }
    LoadOptions view{.has_view = true, .eye = {0, 3, 0}, .up = {0, 0, -1}, .fov = 1};
    EXPECT_EQ(load(gltf, view).settings[0].camera_forward.y, -1);
}

TEST(Gltf, A_glb_file_is_the_same_scene)
{
    GltfText gltf;
    gltf.add_triangle();
    nlohmann::json document = gltf.document;
    document["buffers"] = {{{"byteLength", gltf.bytes.size()}}};
    std::string json = document.dump();
    while (json.size() % 4 != 0) {
        json += ' ';
    }
    const auto word = [](size_t value) {
        std::string bytes(4, '\0');
        for (size_t k = 0; k < 4; ++k) {
            bytes[k] = char(value >> (8 * k) & 255);
        }
        return bytes;
    };
    const std::string binary(gltf.bytes.begin(), gltf.bytes.end());
    const std::string body =
        word(json.size()) + "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
    const auto file = write_file("scene.glb", "glTF" + word(2) + word(12 + body.size()) + body);
    EXPECT_EQ(shape(load_scene(file, {.environment = "none"})), shape(load(gltf)));
}

TEST(Gltf, File_names_may_be_encoded)
{
    for (const auto& [uri, name] : {std::pair{"my%20data%2b.bin", "my data+.bin"},
                                    {"my data.bin", "my data.bin"},
                                    {"100%.bin", "100%.bin"},
                                    {"d%C3%A9j%C3%A0/\u8272.bin", "d\u00e9j\u00e0/\u8272.bin"}}) {
        GltfText gltf;
        gltf.add_triangle();
        write_file(name, std::string(gltf.bytes.begin(), gltf.bytes.end()));
        gltf.document["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", uri}}};
        gltf.bytes.clear();
        EXPECT_EQ(load(gltf).triangles.size(), 1u) << uri;
    }
}

TEST(Gltf, A_scene_without_light_gets_a_sky)
{
    GltfText gltf;
    gltf.add_triangle();
    const auto file = gltf.write();
    const SceneData lit = load_scene(file);
    EXPECT_TRUE(lit.effects & EFFECT_ENVIRONMENT);
    EXPECT_EQ(lit.lights.size(), 1u);
    EXPECT_EQ(lit.notices.back(), "lights: none in the scene; a neutral sky lights it");
    EXPECT_TRUE(load_scene(file, {.environment = "none"}).lights.empty());
    EXPECT_THROW(load_scene(file, {.environment = "/no/such/map.exr"}), SceneError);
}

}  // namespace
}  // namespace diptych
