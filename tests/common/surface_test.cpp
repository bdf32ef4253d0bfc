// What lies under a hit does not depend on whether its mesh is merged into the world or instanced.
#include "platform.h"

#include "common/surface.h"
#include "host/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace diptych;

// As backends bind it: a table without rows has one of zeros, which selects may read.
Scene view_of(const SceneData& data)
{
    Scene scene{};
    scene.effects = data.effects;
#define BIND(type, name)          \
    static const type name##_0{}; \
    scene.name = data.name.empty() ? &name##_0 : data.name.data();
    SCENE_BUFFERS(BIND)
#undef BIND
    return scene;
}

// A square facing +z whose normal map leans everywhere the same way, to the right
// of the image and, more, to its top;
// `twice` places it a second time, without transform, so that it is instanced.
SceneData leaning_square(const Transform& to_world, bool twice)
{
    SceneBuilder builder;
    const int image = builder.add_image({1, 1, {}, {0.6f, 0.75f, 0.9f, 1}, false, 0});
    const int bumpy = builder.add_material({.normal_texture = {.image = image}});
    const int mesh = builder.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, bumpy));
    builder.place(mesh, to_world);
    if (twice) {
        builder.place(mesh);
    }
    return builder.finish();
}

// The mapped normal at the middle of the mesh's first placement.
float3 mapped_normal(const SceneData& data)
{
    const Scene scene = view_of(data);
    const int instance = data.instances.size() > 1 ? 1 : 0;
    const int triangle = data.instances[size_t(instance)].first_triangle;
    const WorldTriangle world = world_triangle(&scene, instance, triangle);
    float3 outside = vec_normalize(vec_cross(world.edge1, world.edge2));
    if (data.instances[size_t(instance)].is_mirrored) {
        outside = -outside;
    }
    const float2 weights = make_float2(0.3f, 0.3f);
    const int slot = scene.materials[scene.triangles[triangle].material].normal_slot;
    const float4 texel = surface_texture(&scene, triangle, weights, slot);
    return surface_mapped_normal(&scene, instance, triangle, weights, outside, texel);
}

TEST(Surface, A_normal_map_leans_the_same_way_on_merged_and_instanced_meshes)
{
    const Transform placements[] = {Transform{},
                                    scaling(-1, 1, 1),
                                    scaling(1, -1, 1),
                                    scaling(1, 1, -1),
                                    translation(1, 2, 3) * rotation_about(unit({1, 2, 3}), 0.7) *
                                        scaling(-1, -1, -1),
                                    rotation_about(unit({3, 1, 2}), 2.1) * scaling(2, 2, -2)};
    for (const Transform& to_world : placements) {
        const float3 merged = mapped_normal(leaning_square(to_world, false));
        const float3 shared = mapped_normal(leaning_square(to_world, true));
        // Texel (0.6, 0.75, 0.9) is (0.2, 0.5, 0.8), turned and mirrored as the square itself is;
        // the top of the image is at its lower edge.
        const Vec3 expected = unit(to_world.vector({0.2, -0.5, 0.8}));
        for (const float3& n : {merged, shared}) {
            EXPECT_NEAR(n.x, expected[0], 1e-3);
            EXPECT_NEAR(n.y, expected[1], 1e-3);
            EXPECT_NEAR(n.z, expected[2], 1e-3);
        }
    }
}

float3 random_unit(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return vec_normalize(make_float3(normal(random), normal(random), normal(random)));
}

TEST(Surface, A_bent_normal_mirrors_to_above_the_face_and_others_stay)
{
    std::mt19937 random(7);
    int bent = 0;
    for (int k = 0; k < 100000; ++k) {
        const float3 face = random_unit(random);
        float3 view = random_unit(random);
        if (vec_dot(face, view) < 0) view = -view;
        // From flat to leaning as far as maps can.
        const float lean = 3.0f * float(k) / 100000;
        const float3 n = normal_facing(vec_normalize(face + random_unit(random) * lean), view);
        const float3 used = normal_mirroring(n, face, view);
        ASSERT_NEAR(vec_length(used), 1, 1e-5f);
        ASSERT_GT(vec_dot(used, view), 0);
        ASSERT_GT(vec_dot(face, vec_reflect(view, used)), -1e-6f);
        const bool was_valid = vec_dot(face, vec_reflect(view, n)) >= 0.01f;
        if (was_valid) {
            ASSERT_TRUE(used.x == n.x && used.y == n.y && used.z == n.z);
        }
        bent += was_valid ? 0 : 1;
    }
    EXPECT_GT(bent, 10000);
    EXPECT_LT(bent, 90000);
}

}  // namespace
