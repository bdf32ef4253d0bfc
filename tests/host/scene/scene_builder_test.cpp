#include "host/scene/scene_builder.hpp"

#include "host/scene/load.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>

namespace diptych {
namespace {

Vec3 to_vec(const float4& v) { return {v.x, v.y, v.z}; }

Transform rows(const Instance& instance)
{
    Transform t;
    const float4 r[3] = {instance.to_world_x, instance.to_world_y, instance.to_world_z};
    for (size_t i = 0; i < 3; ++i) {
        t.row[i] = {r[i].x, r[i].y, r[i].z, r[i].w};
    }
    return t;
}

// Every triangle as it stands in the world: corners, in the order that faces front.
std::vector<std::array<Vec3, 3>> world_triangles(const SceneData& scene)
{
    std::vector<std::array<Vec3, 3>> result;
    for (const Instance& instance : scene.instances) {
        const Transform placed = rows(instance);
        for (int k = 0; k < instance.triangle_count; ++k) {
            const Triangle& t = scene.triangles[size_t(instance.first_triangle + k)];
            std::array<Vec3, 3> corners;
            const int v[3] = {t.vertex0, t.vertex1, t.vertex2};
            for (size_t c = 0; c < 3; ++c) {
                corners[c] = placed.point(to_vec(scene.positions[size_t(v[c])]));
            }
            if (instance.is_mirrored) {
                std::swap(corners[1], corners[2]);
            }
            result.push_back(corners);
        }
    }
    return result;
}

double area(const std::array<Vec3, 3>& t) { return length(cross(t[1] - t[0], t[2] - t[0])) / 2; }
Vec3 front(const std::array<Vec3, 3>& t) { return unit(cross(t[1] - t[0], t[2] - t[0])); }

Transform some_transform(double mirror = 1)
{
    return translation(3, -2, 0.5) * rotation_about(unit({1, 2, 3}), 0.7) *
           scaling(mirror * 0.5, 2, 1.25);
}

TEST(SceneBuilder, A_scene_takes_few_lines)
{
    SceneBuilder scene;
    const int red = scene.add_material({.base_color = {0.6f, 0.1f, 0.1f, 1}, .specular = 0});
    const int lamp = scene.add_material({.specular = 0, .emission = {5, 5, 5}});
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, red)));
    scene.place(scene.add_mesh(quad_mesh({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
    scene.set_camera({.eye = {0, 1, 4}, .target = {0, 1, 0}});
    const SceneData data = scene.finish();

    EXPECT_EQ(data.triangles.size(), 4u);
    EXPECT_EQ(data.instances.size(), 1u);
    EXPECT_EQ(data.lights.size(), 2u);
    EXPECT_EQ(data.effects, unsigned(EFFECT_EMISSION));
    EXPECT_TRUE(data.normals.empty());
    EXPECT_TRUE(data.notices.empty());
    for (const auto& t : world_triangles(data)) {
        const double up = front(t)[1];
        EXPECT_NEAR(up, t[0][1] < 1 ? 1 : -1, 1e-12) << "floor up, lamp down";
    }
}

TEST(SceneBuilder, Spheres_and_boxes_are_closed_and_face_outward)
{
    for (const MeshPart& part : {sphere_mesh({1, 2, 3}, 0.5, 96), box_mesh({0, 0, 0}, {1, 2, 3})}) {
        SceneBuilder scene;
        scene.place(scene.add_mesh(part));
        const SceneData data = scene.finish();
        const bool is_sphere = !part.normals.empty();
        double surface = 0, volume = 0;
        for (const auto& t : world_triangles(data)) {
            surface += area(t);
            volume += dot(t[0], cross(t[1], t[2])) / 6;
        }
        // pi within the sphere's tessellation error; 22 and 6 exactly.
        EXPECT_NEAR(surface, is_sphere ? 3.14159265 : 22, is_sphere ? 4e-3 : 1e-6);
        EXPECT_NEAR(volume, is_sphere ? 0.52359878 : 6, is_sphere ? 2e-3 : 1e-6);
        EXPECT_EQ(data.degenerate_triangles, 0u);
    }
}

// Two placements of one mesh look the same as two meshes placed once each.
TEST(SceneBuilder, Instances_stand_where_merged_meshes_stand)
{
    for (const double mirror : {1.0, -1.0}) {
        SceneBuilder shared, merged;
        const int mesh = shared.add_mesh(sphere_mesh({0.5, 0, 0}, 1, 12));
        for (const Transform& t : {Transform{}, some_transform(mirror)}) {
            shared.place(mesh, t);
            merged.place(merged.add_mesh(sphere_mesh({0.5, 0, 0}, 1, 12)), t);
        }
        const SceneData a = shared.finish(), b = merged.finish();
        EXPECT_EQ(a.instances.size(), 3u);
        EXPECT_EQ(b.instances.size(), 1u);
        EXPECT_EQ(a.instances[0].triangle_count, 0);
        EXPECT_EQ(a.instances[2].is_mirrored, mirror < 0);
        EXPECT_EQ(2 * a.positions.size(), b.positions.size());
        EXPECT_TRUE(a.effects & EFFECT_INSTANCES);
        EXPECT_FALSE(b.effects & EFFECT_INSTANCES);
        const auto in_a = world_triangles(a), in_b = world_triangles(b);
        ASSERT_EQ(in_a.size(), in_b.size());
        for (size_t k = 0; k < in_a.size(); ++k) {
            EXPECT_NEAR(area(in_a[k]), area(in_b[k]), 1e-5);
            EXPECT_GT(dot(front(in_a[k]), front(in_b[k])), 0.9999) << k;
            Vec3 centre_a{}, centre_b{};
            for (size_t c = 0; c < 3; ++c) {
                centre_a = centre_a + in_a[k][c], centre_b = centre_b + in_b[k][c];
            }
            EXPECT_LT(length(centre_a - centre_b), 1e-5);
        }
    }
}

TEST(SceneBuilder, Merged_normals_stay_orthogonal_to_the_surface)
{
    for (const double mirror : {1.0, -1.0}) {
        SceneBuilder scene;
        scene.place(scene.add_mesh(sphere_mesh({0, 0, 0}, 1, 256)), some_transform(mirror));
        const SceneData data = scene.finish();
        const auto triangles = world_triangles(data);
        for (size_t k = 0; k < triangles.size(); ++k) {
            const float3 n = normal_unpack(data.normals[size_t(data.triangles[k].vertex0)]);
            EXPECT_GT(dot(front(triangles[k]), {n.x, n.y, n.z}), 0.998) << k;
        }
    }
}

TEST(SceneBuilder, To_object_is_the_inverse_of_to_world)
{
    SceneBuilder scene;
    const int mesh = scene.add_mesh(box_mesh({0, 0, 0}, {1, 1, 1}));
    scene.place(mesh, some_transform());
    scene.place(mesh, some_transform(-1));
    const SceneData data = scene.finish();
    for (const Instance& instance : data.instances) {
        Transform back;
        const float4 r[3] = {instance.to_object_x, instance.to_object_y, instance.to_object_z};
        for (size_t i = 0; i < 3; ++i) {
            back.row[i] = {r[i].x, r[i].y, r[i].z, r[i].w};
        }
        const Transform both = back * rows(instance);
        for (size_t i = 0; i < 3; ++i) {
            for (size_t j = 0; j < 4; ++j) {
                EXPECT_NEAR(both.row[i][j], i == j, 2e-6);
            }
        }
    }
}

TEST(SceneBuilder, Drops_and_counts_triangles_without_area)
{
    SceneBuilder scene;
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1e-7f, 1, 0}};
    part.indices = {0, 1, 2, 0, 1, 3, 3, 4, 0, 1, 1, 1, 0, 3, 5};
    scene.place(scene.add_mesh(part));
    const int flattened = scene.add_mesh(box_mesh({0, 0, 0}, {1, 1, 1}));
    scene.place(flattened, scaling(1, 0, 1));
    const SceneData data = scene.finish();
    EXPECT_EQ(data.triangles.size(), 2u) << "the thin one has an area";
    EXPECT_EQ(data.degenerate_triangles, 3u + 12u);
    EXPECT_EQ(data.notices.size(), 1u);
}

TEST(SceneBuilder, Refuses_what_it_cannot_index_or_place)
{
    const auto message = [](const MeshPart& part, const Transform& t = {}) -> std::string {
        try {
            SceneBuilder scene;
            scene.place(scene.add_mesh(part, "thing"), t);
            scene.finish();
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    MeshPart part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(message(part), "");
    part.indices[4] = 4;
    EXPECT_NE(message(part).find("index 4 names vertex 4 of 4"), std::string::npos);
    part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    part.positions[2].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(message(part).find("thing, part 0: the position of vertex 2 is not finite"),
              std::string::npos);
    part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    part.normals.resize(3);
    EXPECT_NE(message(part).find("different numbers of vertices"), std::string::npos);
    part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 7);
    EXPECT_NE(message(part).find("no material 7"), std::string::npos);
    part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_NE(message(part, scaling(1e300, 1, 1) * scaling(1e300, 1, 1)).find("not finite"),
              std::string::npos);
    EXPECT_NE(message(part, scaling(1e39, 1, 1)).find("beyond the range of float"),
              std::string::npos);
}

// An empty scene is a scene.
TEST(SceneBuilder, Nothing_at_all_has_a_camera_and_no_lights)
{
    SceneBuilder scene;
    const SceneData data = scene.finish();
    EXPECT_EQ(data.instances.size(), 1u);
    EXPECT_EQ(data.instances[0].triangle_count, 0);
    EXPECT_TRUE(data.lights.empty());
    EXPECT_TRUE(data.light_choice.empty());
    EXPECT_EQ(data.effects, 0u);
    EXPECT_EQ(data.settings[0].environment_light, -1);
    EXPECT_GT(length(to_vec(data.settings[0].camera_right)), 0);
}

TEST(SceneBuilder, Camera_keeps_the_vertical_field_of_view)
{
    SceneBuilder scene;
    scene.set_picture_size(200, 100);
    scene.set_camera({.eye = {1, 2, 3}, .target = {1, 2, -5}, .fov = 1.0});
    SceneData data = scene.finish();
    const Settings& s = data.settings[0];
    EXPECT_FLOAT_EQ(s.camera_up.y, float(std::tan(0.5)));
    EXPECT_FLOAT_EQ(s.camera_right.x, 2 * float(std::tan(0.5)));
    EXPECT_FLOAT_EQ(s.camera_forward.z, -1);
    EXPECT_EQ(s.camera_kind, CAMERA_PERSPECTIVE);
    set_picture_size(data, 100, 300);
    EXPECT_FLOAT_EQ(s.camera_up.y, float(std::tan(0.5)));
    EXPECT_FLOAT_EQ(s.camera_right.x, float(std::tan(0.5)) / 3);

    scene.set_picture_size(200, 100);
    scene.set_camera({.half_height = 1.5});
    data = scene.finish();
    EXPECT_EQ(data.effects, unsigned(EFFECT_ORTHOGRAPHIC));
    EXPECT_FLOAT_EQ(data.settings[0].camera_up.y, 1.5f);
    EXPECT_FLOAT_EQ(data.settings[0].camera_right.x, 3);
}

// Whatever the aspect, every vertex is in the picture that frames the scene.
TEST(SceneBuilder, Framing_camera_sees_everything)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> in_box(-1, 1);
    for (const auto& [width, height] : {std::pair{100, 100}, {300, 100}, {100, 300}}) {
        SceneBuilder scene;
        MeshPart part;
        for (int k = 0; k < 300; ++k) {
            part.positions.push_back(
                {5 + 40 * in_box(random), 3 * in_box(random), 10 * in_box(random)});
        }
        scene.place(scene.add_mesh(part));
        scene.set_picture_size(width, height);
        const SceneData data = scene.finish();
        const Settings& s = data.settings[0];
        for (const float4& p : data.positions) {
            const Vec3 to = to_vec(p) - to_vec(s.camera_origin);
            const double depth = dot(to, to_vec(s.camera_forward));
            const Vec3 right = to_vec(s.camera_right), up = to_vec(s.camera_up);
            EXPECT_GT(depth, 0);
            EXPECT_LE(std::abs(dot(to, right)) / dot(right, right) / depth, 1);
            EXPECT_LE(std::abs(dot(to, up)) / dot(up, up) / depth, 1);
            EXPECT_LE(length(to_vec(p) - to_vec(s.scene_centre)), s.scene_radius);
        }
    }
}

Picture plain_picture(std::uint8_t value, std::uint8_t alpha = 255)
{
    Picture p{2, 2, {}, {}, true, 0};
    for (int k = 0; k < 16; ++k) {
        p.bytes.push_back(k % 4 == 3 ? alpha : value);
    }
    return p;
}

unsigned effects_of(const MaterialInput& material, const Picture& picture)
{
    SceneBuilder scene;
    scene.add_image(picture);
    scene.add_material({.name = "unused",
                        .metallic = 1,
                        .emission = {1, 1, 1},
                        .is_unlit = true,
                        .normal_texture = {.image = 0}});
    scene.place(
        scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.add_material(material))));
    return scene.finish().effects;
}

// Exactly what a used material calls for.
TEST(SceneBuilder, Effects_follow_used_materials)
{
    const Picture grey = plain_picture(128), clear = plain_picture(128, 100);
    const TextureUse texture{.image = 0};
    EXPECT_EQ(effects_of({.specular = 0}, grey), 0u);
    EXPECT_EQ(effects_of({}, grey), unsigned(EFFECT_SPECULAR));
    EXPECT_EQ(effects_of({.specular_color = {0, 0, 0}}, grey), 0u) << "Lambert too";
    EXPECT_EQ(effects_of({.metallic = 0.1f, .specular = 0}, grey), unsigned(EFFECT_SPECULAR));
    EXPECT_EQ(effects_of({.specular = 0, .base_texture = texture}, grey),
              unsigned(EFFECT_BASE_TEXTURE));
    EXPECT_EQ(effects_of({.specular = 0, .metallic_roughness_texture = texture}, grey), 0u)
        << "a Lambert surface has no roughness";
    EXPECT_EQ(effects_of({.metallic_roughness_texture = texture}, grey),
              unsigned(EFFECT_SPECULAR | EFFECT_SURFACE_TEXTURES));
    EXPECT_EQ(effects_of({.specular_texture = texture}, grey),
              unsigned(EFFECT_SPECULAR | EFFECT_SURFACE_TEXTURES));
    EXPECT_EQ(effects_of({.specular = 0, .normal_texture = texture}, grey),
              unsigned(EFFECT_NORMAL_MAP));
    EXPECT_EQ(effects_of({.specular = 0, .emission_texture = texture}, grey), 0u)
        << "times a factor of zero";
    EXPECT_EQ(effects_of({.specular = 0, .emission = {1, 0, 0}, .emission_texture = texture}, grey),
              unsigned(EFFECT_EMISSION | EFFECT_EMISSION_TEXTURE));
    EXPECT_EQ(effects_of({.metallic = 1, .emission = {1, 0, 0}, .is_unlit = true}, grey),
              unsigned(EFFECT_UNLIT));
    EXPECT_EQ(effects_of({.specular = 0, .alpha_mode = ALPHA_BLEND}, grey), 0u)
        << "nothing is transparent";
    EXPECT_EQ(
        effects_of({.base_color = {1, 1, 1, 0.5f}, .specular = 0, .alpha_mode = ALPHA_BLEND}, grey),
        unsigned(EFFECT_ALPHA));
    const MaterialInput mask{
        .specular = 0, .alpha_mode = ALPHA_MASK, .alpha_cutoff = 0.5f, .base_texture = texture};
    EXPECT_EQ(effects_of(mask, grey), unsigned(EFFECT_BASE_TEXTURE));
    EXPECT_EQ(effects_of(mask, clear), unsigned(EFFECT_BASE_TEXTURE | EFFECT_ALPHA));
    Picture deep{1, 1, {}, {0.5f, 0.5f, 0.5f, 1}, true, 0};
    EXPECT_EQ(effects_of({.specular = 0, .base_texture = texture}, deep),
              unsigned(EFFECT_BASE_TEXTURE | EFFECT_FLOAT_TEXTURES));
}

TEST(SceneBuilder, Disabled_effects_are_cleared)
{
    SceneBuilder scene;
    scene.place(scene.add_mesh(sphere_mesh({0, 0, 0}, 1, 8)));
    scene.disable_effects(EFFECT_SMOOTH_NORMALS);
    EXPECT_EQ(scene.finish().effects, unsigned(EFFECT_SPECULAR));
}

// 8-bit texels are stored once for both readings; 16-bit ones are decoded for the one that is sRGB.
TEST(SceneBuilder, One_image_is_read_as_color_and_as_numbers)
{
    SceneBuilder scene;
    const int eight = scene.add_image(plain_picture(188));
    const int sixteen = scene.add_image(Picture{1, 1, {}, {0.5f, 0.5f, 0.5f, 0.25f}, true, 0});
    const int deep = scene.add_image(Picture{1, 1, {}, {7, 0.5f, 0.5f, 0.25f}, false, 0});
    for (const int image : {eight, sixteen, deep}) {
        const int material = scene.add_material(
            {.base_texture = {.image = image}, .metallic_roughness_texture = {.image = image}});
        scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material)));
    }
    const SceneData data = scene.finish();
    ASSERT_EQ(data.images.size(), 6u);
    EXPECT_EQ(data.texels_8.size(), 4u);
    EXPECT_EQ(data.texels_8[0], 0xffbcbcbcu);
    const auto image_of = [&](int slot) {
        return data.images[size_t(data.texture_slots[size_t(slot)].image)];
    };
    const Image color = image_of(data.materials[0].base_slot);
    const Image numbers = image_of(data.materials[0].metallic_roughness_slot);
    EXPECT_EQ(color.encoding, TEXELS_8_SRGB);
    EXPECT_EQ(numbers.encoding, TEXELS_8_LINEAR);
    EXPECT_EQ(color.first_texel, numbers.first_texel);
    const auto texel = [&](int slot) {
        return data.texels_float[size_t(image_of(slot).first_texel)];
    };
    EXPECT_NEAR(texel(data.materials[1].base_slot).x, 0.21404114, 1e-6);
    EXPECT_EQ(texel(data.materials[1].base_slot).w, 0.25f) << "alpha is never sRGB";
    EXPECT_EQ(texel(data.materials[1].metallic_roughness_slot).x, 0.5f);
    EXPECT_EQ(texel(data.materials[2].base_slot).x, 7.0f) << "float colours are linear";
}

TEST(SceneBuilder, Uv_sets_are_those_that_materials_read)
{
    SceneBuilder scene;
    const int image = scene.add_image(plain_picture(1));
    const int material = scene.add_material({.base_texture = {.image = image, .uv_set = 3},
                                             .normal_texture = {.image = image, .uv_set = 1}});
    MeshPart part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    for (float set = 1; set < 4; ++set) {
        part.uvs.push_back(part.uvs[0]);
        for (float2& uv : part.uvs.back()) {
            uv.x += 10 * set;
        }
    }
    scene.place(scene.add_mesh(part));
    scene.place(scene.add_mesh(quad_mesh({0, 0, 2}, {1, 0, 0}, {0, 1, 0})));
    const SceneData data = scene.finish();
    ASSERT_EQ(data.settings[0].uv_set_count, 2);
    ASSERT_EQ(data.uvs.size(), 2 * data.positions.size());
    const auto& slots = data.texture_slots;
    const int base = slots[size_t(data.materials[0].base_slot)].uv_set;
    const int normal = slots[size_t(data.materials[0].normal_slot)].uv_set;
    EXPECT_EQ(base + normal, 1);
    EXPECT_EQ(data.uvs[size_t(2 + base)].x, 31);
    EXPECT_EQ(data.uvs[size_t(2 + normal)].x, 11);
    EXPECT_EQ(data.material_names.back(), "(default material)");
}

TEST(SceneBuilder, Vertex_colors_default_to_white_and_normals_to_flat)
{
    SceneBuilder scene;
    MeshPart colored = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    colored.colors.assign(4, {0.5f, 0.25f, 0, 1});
    MeshPart smooth = quad_mesh({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    smooth.normals.assign(4, {0, 0, 2});
    smooth.normals[1] = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
    scene.place(scene.add_mesh(colored));
    scene.place(scene.add_mesh(smooth));
    const SceneData data = scene.finish();
    EXPECT_EQ(data.effects,
              unsigned(EFFECT_SPECULAR | EFFECT_VERTEX_COLOR | EFFECT_SMOOTH_NORMALS));
    EXPECT_EQ(data.colors[0].y, 0.25f);
    EXPECT_EQ(data.colors[4].y, 1.0f);
    EXPECT_EQ(data.normals[0], NORMAL_FLAT);
    EXPECT_NE(data.normals[4], NORMAL_FLAT);
    EXPECT_EQ(data.normals[4], data.normals[5]) << "repaired from the face";
}

TEST(DemoScene, Shows_what_the_renderer_can_do)
{
    const SceneData data = demo_scene();
    EXPECT_TRUE(data.notices.empty()) << data.notices[0];
    EXPECT_EQ(data.effects, unsigned(EFFECT_SPECULAR | EFFECT_BASE_TEXTURE | EFFECT_EMISSION |
                                     EFFECT_SMOOTH_NORMALS));
    EXPECT_EQ(data.lights.size(), 2u);
    EXPECT_GT(data.triangles.size(), 10000u);
    EXPECT_EQ(data.degenerate_triangles, 0u);
}

}  // namespace
}  // namespace diptych
