// What must stay finite and free of scale (GI-21): sizes from millimetres to kilometres, places far
// from the origin, thin walls, broken geometry, extreme materials and lights.
#include "tests/laws/measure.hpp"

#include <cmath>
#include <limits>

namespace {

using namespace diptych;
using namespace laws;

using HardCases = OnEachBackend;

// A room with an area light, a diffuse box and a rough metal one; coordinates in sixty-fourths.
SceneData small_room(double scale, const Vec3& offset = {0, 0, 0})
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(0.7f));
    const int lamp = scene.add_material(lambert(0, 12));
    const int metal = scene.add_material(
        {.base_color = {0.9f, 0.8f, 0.6f, 1}, .metallic = 1, .roughness = 0.25f});
    const Transform place =
        translation(offset[0], offset[1], offset[2]) * scaling(scale, scale, scale);
    const auto add = [&](std::vector<MeshPart> parts) {
        scene.place(scene.add_mesh(parts), place);
    };
    add(room({-1, 0, -1}, {1, 2, 1}, wall));
    add({quad_mesh({-0.25, 1.984375, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, lamp)});
    add({box_mesh({-0.75, 0, -0.75}, {-0.125, 1.25, -0.125}, wall)});
    add({box_mesh({0.125, 0, -0.25}, {0.625, 0.5, 0.375}, metal)});
    scene.set_camera(
        {.eye = place.point({0, 1, 0.984375}), .target = place.point({0, 0.75, -1}), .fov = 1.2});
    scene.set_picture_size(16, 16);
    return finish(scene, 8);
}

double relative_rms(const Measurement& a, const Measurement& b)
{
    double square = 0, whole = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k) {
        square += (a.pixels[k] - b.pixels[k]) * (a.pixels[k] - b.pixels[k]);
        whole += b.pixels[k] * b.pixels[k];
    }
    return std::sqrt(square / whole);
}

TEST_P(HardCases, PowersOfTwoInScaleChangeNoBit)
{
    const Measurement metres = measure(small_room(1));
    for (const double scale : {0x1p-10, 0x1p10}) {
        SCOPED_TRACE(scale);
        EXPECT_EQ(measure(small_room(scale)).pixels, metres.pixels);
    }
}

TEST_P(HardCases, ScaleChangesNothingButRounding)
{
    const Measurement metres = measure(small_room(1), 3);
    for (const double scale : {1e-3, 1e3}) {
        SCOPED_TRACE(scale);
        const Measurement other = measure(small_room(scale), 3);
        EXPECT_EQ(other.faults, 0u);
        // Rounding sends a path in some ten thousands another way; each changes its pixel by a
        // sample.
        EXPECT_LT(relative_rms(other, metres), GetParam() == "double" ? 1e-4 : 3e-3);
        EXPECT_NEAR(other.mean(), metres.mean(), 1e-4 * metres.mean());
    }
}

// A hundred thousand units away a float is exact to a hundred-and-twenty-eighth; the room is a
// hundred and twenty-eight times larger than that.
TEST_P(HardCases, OffsetChangesNothingButRounding)
{
    const Measurement near = measure(small_room(64), 3);
    const Measurement far = measure(small_room(64, {1e5, 1e5, -1e5}), 3);
    EXPECT_EQ(far.faults, 0u);
    EXPECT_NEAR(far.mean(), near.mean(), 0.01 * near.mean());
}

// A closed room with walls of a millimetre under a bright sky.
TEST_P(HardCases, ThinWallsDoNotLeak)
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(0.8f));
    scene.place(scene.add_mesh(room({-2, 0, -3}, {2, 2.5, 3}, wall)));
    scene.place(scene.add_mesh(box_mesh({-2.001, -0.001, -3.001}, {2.001, 2.501, 3.001}, wall)));
    scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
    scene.set_camera({.eye = {0, 1, 2.9}, .target = {0.5, 0, -3}, .fov = 1.3});
    scene.set_picture_size(16, 16);
    EXPECT_LT(measure(finish(scene, 8)).mean(), 1e-3);
}

// A strip 6 km long and 4 m wide under an even sky: what is scattered meets nothing more.
TEST_P(HardCases, LongStripsDoNotShadeThemselves)
{
    SceneBuilder scene;
    const Transform place = rotation_about({0.3, 0.8, 0.5}, 0.7);
    const int floor = scene.add_material(lambert(0.5f));
    scene.place(scene.add_mesh(quad_mesh({-3000, 0, -2}, {0, 0, 4}, {6000, 0, 0}, floor)), place);
    scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
    scene.set_camera(
        {.eye = place.point({1000, 3, 0}), .target = place.point({1000, 0, 0}), .fov = 0.4});
    scene.set_picture_size(16, 16);
    EXPECT_TRUE(obeys(measure(finish(scene, 4), 3), 0.5));
}

Measurement expect_finite(Measurement measured)
{
    EXPECT_EQ(measured.faults, 0u);
    for (const double value : measured.pixels) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    return measured;
}

// The small room, with something more in it.
SceneBuilder open_room()
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(0.7f));
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, wall)));
    scene.set_camera({.eye = {0, 2, 3}, .target = {0, 0.3, 0}});
    scene.set_picture_size(16, 16);
    return scene;
}

TEST_P(HardCases, BrokenGeometryStaysFinite)
{
    SceneBuilder scene = open_room();
    const int wall = scene.add_material({.metallic = 0.5f, .roughness = 0.3f});
    const int lamp = scene.add_material(lambert(0.2f, 5));
    scene.place(scene.add_mesh(quad_mesh({-1, 0, -1}, {0, 0, 1}, {2, 0, 0}, wall)));  // coplanar
    scene.place(scene.add_mesh(quad_mesh({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
    scene.place(scene.add_mesh(quad_mesh({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, wall)));
    MeshPart sliver;
    sliver.positions = {{0, 0.5f, 0}, {1, 0.5f, 0}, {0.5f, 0.5f, 0},       // no area
                        {0, 0.6f, 0}, {0, 0.6f, 0}, {0, 0.6f, 0},          // a point
                        {0, 0.7f, 0}, {1, 0.7f, 0}, {0.5f, 0.7f, 1e-7f}};  // hardly any
    sliver.material = lamp;
    scene.place(scene.add_mesh(sliver));
    EXPECT_GT(expect_finite(measure(finish(scene, 8))).mean(), 0);
}

TEST_P(HardCases, ExtremeMaterialsStayFinite)
{
    SceneBuilder scene = open_room();
    double x = -1.5;
    for (const float roughness : {0.0f, 1e-4f, 0.0101f, 1.0f}) {
        for (const float metallic : {0.0f, 1.0f}) {
            const int material = scene.add_material({.metallic = metallic, .roughness = roughness});
            scene.place(scene.add_mesh(sphere_mesh({x, 0.2, 0}, 0.18, 24, material)));
            x += 0.4;
        }
    }
    scene.set_environment(environment_of([](const Vec3& w) { return w[1] > 0 ? 1.0 : 0.2; }, 8, 8));
    EXPECT_GT(expect_finite(measure(finish(scene, 64))).mean(), 0);
}

TEST_P(HardCases, BrightestSunAndSmallestLampStayFinite)
{
    SceneBuilder scene = open_room();
    Picture map = environment_of([](const Vec3&) { return 0.1; }, 64, 32);
    for (size_t c = 0; c < 3; ++c) map.floats[4 * (5 * 64 + 20) + c] = 1e6f;
    scene.set_environment(map);
    const int lamp = scene.add_material(lambert(0, 1e6f));
    scene.place(scene.add_mesh(quad_mesh({0, 1, 0}, {1e-3, 0, 0}, {0, 0, 1e-3}, lamp)));
    const int mirror = scene.add_material({.metallic = 1, .roughness = 0.02f});
    scene.place(scene.add_mesh(sphere_mesh({0.6, 0.4, 0}, 0.4, 48, mirror)));
    EXPECT_GT(expect_finite(measure(finish(scene, 8))).mean(), 0);
}

TEST_P(HardCases, NormalMapsOfAnyContentStayFinite)
{
    SceneBuilder scene = open_room();
    Picture map{2, 2, {}, {}, false, 0};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    map.floats = {nan, nan, nan, 1, 0.5f, 0.5f, 0.5f, 1, 0, 0, 0, 1, 1e30f, -1e30f, 0, 1};
    const int image = scene.add_image(map);
    const int bumpy = scene.add_material({.roughness = 0.4f, .normal_texture = {.image = image}});
    scene.place(scene.add_mesh(sphere_mesh({0, 0.5, 0}, 0.5, 24, bumpy)));
    scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
    EXPECT_GT(expect_finite(measure(finish(scene, 8))).mean(), 0);
}

TEST_P(HardCases, NothingShines)
{
    SceneBuilder scene = open_room();
    EXPECT_EQ(expect_finite(measure(finish(scene))).mean(), 0);
}

TEST_P(HardCases, NothingReflects)
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(0));
    scene.place(scene.add_mesh(room({-1, -1, -1}, {1, 1, 1}, wall)));
    scene.add_light({.intensity = {5, 5, 5}, .position = {0, 0.5, 0}});
    scene.set_picture_size(16, 16);
    EXPECT_EQ(expect_finite(measure(finish(scene))).mean(), 0);
}

TEST_P(HardCases, NothingIsThere)
{
    SceneBuilder scene;
    scene.set_picture_size(16, 16);
    EXPECT_EQ(expect_finite(measure(finish(scene))).mean(), 0);
}

// All light stays in the room and paths have no limit: they must end all the same.
TEST_P(HardCases, LosslessRoomEnds)
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(1));
    scene.place(scene.add_mesh(room({-1, -1, -1}, {1, 1, 1}, wall)));
    scene.add_light({.intensity = {5, 5, 5}, .position = {0, 0.5, 0}});
    scene.set_camera({.eye = {0, 0, 0.9}, .target = {0, 0, -1}});
    scene.set_picture_size(2, 2);
    EXPECT_GT(expect_finite(measure(finish(scene))).mean(), 0);
}

ON_EACH_BACKEND(HardCases);

}  // namespace
