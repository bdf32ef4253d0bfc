// What lies under a hit does not depend on whether its mesh is merged into the world or instanced.
#include "platform.h"

#include "common/surface.h"
#include "host/scene/scene_builder.hpp"

#include <gtest/gtest.h>

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

}  // namespace
