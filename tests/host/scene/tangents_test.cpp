#include "host/scene/tangents.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace diptych {
namespace {

// A square in the xy plane, u to the right and v down, as images lie.
MeshPart upright_square()
{
    MeshPart part = quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    part.normals.assign(4, {0, 0, 1});
    part.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    return part;
}

TEST(Tangents, Point_along_u_and_the_bitangent_to_the_top_of_the_image)
{
    MeshPart part = upright_square();
    derive_tangents(part, {.image = 0});
    for (const float4& t : part.tangents) {
        EXPECT_NEAR(t.x, 1, 1e-6);
        EXPECT_NEAR(t.y, 0, 1e-6);
        EXPECT_EQ(t.w, 1);  // cross(n, t) = +y, where v is least
    }
    EXPECT_EQ(part.positions.size(), 4u);
}

TEST(Tangents, Follow_the_texture_transform)
{
    MeshPart part = upright_square();
    derive_tangents(part, {.image = 0, .to_uv = {{{0, 1, 0}, {-1, 0, 1}}}});  // a quarter turn
    for (const float4& t : part.tangents) {
        EXPECT_NEAR(t.x, 0, 1e-6);
        EXPECT_NEAR(t.y, -1, 1e-6);  // image u grows with v, that is downward
        EXPECT_EQ(t.w, 1);
    }
}

// The mirrored half of a face shares its seam, whose vertices must not blend both hands.
TEST(Tangents, Vertices_between_mirrored_halves_are_split)
{
    MeshPart part;
    part.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    part.normals.assign(6, {0, 0, 1});
    part.colors.assign(6, {1, 1, 1, 1});
    part.uvs = {{{1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}}};
    part.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    derive_tangents(part, {.image = 0});
    EXPECT_EQ(part.positions.size(), 8u);
    EXPECT_EQ(part.colors.size(), 8u);
    EXPECT_EQ(part.uvs[0].size(), 8u);
    for (size_t c = 0; c < part.indices.size(); ++c) {
        const float4 t = part.tangents[part.indices[c]];
        EXPECT_NEAR(t.x, c < 6 ? -1 : 1, 1e-6);
        EXPECT_EQ(t.w, c < 6 ? -1 : 1);
    }
}

TEST(Tangents, Of_a_sphere_are_those_of_its_parametrisation)
{
    MeshPart part = sphere_mesh({0, 0, 0}, 1, 64);
    derive_tangents(part, {.image = 0});
    int checked = 0;
    for (size_t v = 0; v < part.positions.size(); ++v) {
        const float3 n = part.normals[v];
        if (std::abs(n.y) > 0.95f) {
            continue;
        }  // away from the poles
        const float4 t = part.tangents[v];
        const double length = std::hypot(n.x, n.z);
        // u runs against the clock seen from above: d/du (cos, -sin) = (-sin, -cos).
        EXPECT_NEAR(t.x, n.z / length, 0.06);
        EXPECT_NEAR(t.z, -n.x / length, 0.06);
        EXPECT_NEAR(t.x * n.x + t.y * n.y + t.z * n.z, 0, 1e-5);
        EXPECT_EQ(t.w, 1);
        ++checked;
    }
    EXPECT_GT(checked, 1000);
}

TEST(Tangents, Exist_where_the_texture_gives_none)
{
    MeshPart part = upright_square();
    part.uvs = {};
    derive_tangents(part, {.image = 0});
    for (const float4& t : part.tangents) {
        EXPECT_NEAR(std::hypot(t.x, t.y, t.z), 1, 1e-6);
        EXPECT_NEAR(t.z, 0, 1e-6);
    }
}

// A mirrored placement turns the handedness over: the image must stay as it is on the surface.
TEST(Tangents, Are_placed_with_their_mesh)
{
    for (const double mirror : {1.0, -1.0}) {
        SceneBuilder scene;
        const int image = scene.add_image(Picture{1, 1, {128, 128, 255, 255}, {}, true, 0});
        MeshPart part = upright_square();
        part.material = scene.add_material({.normal_texture = {.image = image}});
        scene.place(scene.add_mesh(part), scaling(mirror, 2, 1));
        const SceneData data = scene.finish();
        ASSERT_EQ(data.tangents.size(), 4u);
        for (const uint packed : data.tangents) {
            EXPECT_NEAR(normal_unpack(packed).x, mirror, 1e-3);
            EXPECT_EQ(packed & 1u, mirror < 0 ? 1u : 0u);
        }
    }
}

// Without normals each face has tangents of its own, and stays flat.
TEST(Tangents, Of_flat_meshes_belong_to_faces)
{
    SceneBuilder scene;
    const int image = scene.add_image(Picture{1, 1, {128, 128, 255, 255}, {}, true, 0});
    MeshPart part = upright_square();
    part.normals.clear();
    part.material = scene.add_material({.normal_texture = {.image = image}});
    scene.place(scene.add_mesh(part));
    const SceneData data = scene.finish();
    EXPECT_EQ(data.positions.size(), 6u);
    EXPECT_TRUE(data.normals.empty());
    EXPECT_NEAR(normal_unpack(data.tangents[0]).x, 1, 1e-3);
}

}  // namespace
}  // namespace diptych
