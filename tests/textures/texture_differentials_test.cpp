// TexCoord0Dx and TexCoord0Dy against differences between the places that neighbouring pixels see.
#include "backends/textures/texture_replay.hpp"
#include "common/textures/procedural.h"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cmath>

namespace {

using namespace diptych;
using textures::handwritten;

double product(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 of(const float4& v) { return {v.x, v.y, v.z}; }

// The plane y = 0.1 x, whose texture coordinates are (x, z) * 0.5 + 0.25, seen at an angle.
SceneData slope(bool is_parallel)
{
    SceneBuilder scene;
    const int function = scene.add_texture_function(
        handwritten("t0", {},
                    "    const float2 dx = tx_attribute_TexCoord0Dx(tx);\n"
                    "    const float2 dy = tx_attribute_TexCoord0Dy(tx);\n"
                    "    return TX_NEW(float4, dx.x, dx.y, dy.x, dy.y);",
                    ATTRIBUTE_TexCoord0Dx | ATTRIBUTE_TexCoord0Dy));
    TextureUse use;
    use.node = scene.add_texture_node({"change", function, {}});
    const int material = scene.add_material({.specular = 0, .base_texture = use});
    MeshPart part = quad_mesh({-4, -0.4, -4}, {0, 0, 8}, {8, 0.8, 0}, material);
    part.uvs.assign(1, {});
    for (const auto& p : part.positions)
        part.uvs[0].push_back({float(p.x * 0.5 + 0.25), float(p.z * 0.5 + 0.25)});
    scene.place(scene.add_mesh(part), translation(0, 0, 0));
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    CameraInput camera{.eye = {0.5, 2, 3}, .target = {0.2, 0, 0}};
    if (is_parallel) camera.half_height = 1;
    scene.set_camera(camera);
    scene.set_picture_size(48, 32);
    SceneData data = scene.finish();
    data.settings[0].max_bounces = 2;
    return data;
}

// Texture coordinates where the ray of the point (x, y) of the picture meets the plane.
std::array<double, 2> uv_at(const Settings& settings, bool is_parallel, double x, double y)
{
    const Vec3 forward = of(settings.camera_forward), right = of(settings.camera_right),
               up = of(settings.camera_up), eye = of(settings.camera_origin);
    Vec3 origin = eye, along = forward;
    for (size_t c = 0; c < 3; ++c) {
        const double shift =
            right[c] * (2 * x / settings.width - 1) + up[c] * (1 - 2 * y / settings.height);
        (is_parallel ? origin : along)[c] += shift;
    }
    const Vec3 n = {-0.1, 1, 0};
    const double t = -product(n, origin) / product(n, along);
    return {(origin[0] + t * along[0]) * 0.5 + 0.25, (origin[2] + t * along[2]) * 0.5 + 0.25};
}

class Differentials : public testing::TestWithParam<bool> {};

TEST_P(Differentials, AreThoseToTheNeighbouringPixels)
{
    const bool is_parallel = GetParam();
    SceneData scene = slope(is_parallel);
    const Settings settings = scene.settings[0];
    const std::unique_ptr<Backend> twin = make_backend("twin", {});
    twin->upload(scene);
    TextureReplay replay(scene, false);
    const WorkItem item{16, 16, 0, 0};
    int first = 0;
    twin->trace({{&item, 1}, 4}, [&](const StageState& state) {
        if (state.stage != STAGE_intersect) return;
        for (const TexturedPath& path : textured_hits(scene, state)) {
            const TextureStepValue step = replay.run(path.hit).at(0);
            if (path.hit.depth > 0) {
                for (const double v : step.value) EXPECT_EQ(v, 0);
                continue;
            }
            ++first;
            // where in the picture the ray came from
            const Vec3 right = of(settings.camera_right), up = of(settings.camera_up);
            Vec3 seen{};
            const Vec3 ray = {path.hit.direction[0], path.hit.direction[1], path.hit.direction[2]};
            const double depth = product(ray, of(settings.camera_forward));
            for (size_t c = 0; c < 3; ++c)
                seen[c] = is_parallel ? path.hit.origin[c] - of(settings.camera_origin)[c]
                                      : ray[c] / depth;
            const double x =
                (product(seen, right) / product(right, right) + 1) * 0.5 * settings.width;
            const double y = (1 - product(seen, up) / product(up, up)) * 0.5 * settings.height;
            const auto here = uv_at(settings, is_parallel, x, y);
            const auto beside = uv_at(settings, is_parallel, x + 1, y);
            const auto below = uv_at(settings, is_parallel, x, y + 1);
            const double expected[] = {beside[0] - here[0], beside[1] - here[1], below[0] - here[0],
                                       below[1] - here[1]};
            for (size_t c = 0; c < 4; ++c)
                EXPECT_NEAR(step.value[c], expected[c], 2e-5) << "component " << c;
        }
    });
    EXPECT_EQ(first, 4 * 256);
}

INSTANTIATE_TEST_SUITE_P(Cameras, Differentials, testing::Bool(), [](const auto& info) {
    return info.param ? "orthographic" : "perspective";
});

}  // namespace
