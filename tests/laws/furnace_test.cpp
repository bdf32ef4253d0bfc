// Enclosures and surroundings in which every answer is a formula (GI-1, GI-2, GI-3, GI-5).
#include "tests/laws/measure.hpp"

#include <cmath>
#include <numbers>

namespace {

using namespace diptych;
using namespace laws;
using std::numbers::pi;

using Furnace = OnEachBackend;

// GI-1: whatever reflects all light cannot be seen before a white background. Two flat-faced boxes,
// so that light also goes from one to the other; the smaller one is turned.
SceneData white_furnace(const MaterialInput& material)
{
    SceneBuilder scene;
    const int white = scene.add_material(material);
    scene.place(scene.add_mesh(box_mesh({-1, -1, -1}, {0.2, 0.5, 1}, white)));
    scene.place(scene.add_mesh(box_mesh({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}, white)),
                translation(0.7, 0.1, 0.9) * rotation_about(unit({1, 2, 3}), 1));
    scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
    look(scene, {3, 2, 5}, {0, 0, 0}, 1.6);
    return finish(scene);
}

TEST_P(Furnace, DiffuseObjectsVanish) { EXPECT_TRUE(obeys(measure(white_furnace(lambert(1))), 1)); }

TEST_P(Furnace, MetalsVanishAtEveryRoughness)
{
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
        SCOPED_TRACE(roughness);
        const Measurement image = measure(white_furnace({.metallic = 1, .roughness = roughness}));
        EXPECT_TRUE(obeys(image, 1, 0.004));
    }
}

TEST_P(Furnace, DielectricsVanishAtEveryRoughness)
{
    for (const float roughness : {0.0f, 0.3f, 1.0f}) {
        SCOPED_TRACE(roughness);
        EXPECT_TRUE(obeys(measure(white_furnace({.roughness = roughness})), 1, 0.004));
    }
}

// A mirror is as lossless with a normal map, however steep: no direction goes into the surface. One
// flat side, so that light is reflected once.
TEST_P(Furnace, MirrorsVanishWhereverTheirNormalsLean)
{
    for (const float lean : {0.3f, 1.0f, 3.0f}) {
        SCOPED_TRACE(lean);
        SceneBuilder scene;
        const float length = 2 * std::sqrt(1 + lean * lean);
        const int bumps = scene.add_image(
            {1, 1, {}, {0.5f + lean / length, 0.5f, 0.5f + 1 / length, 1}, false, 0});
        const int mirror =
            scene.add_material({.metallic = 1, .roughness = 0, .normal_texture = {.image = bumps}});
        scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, mirror)));
        scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
        look(scene, {-0.5, 1.5, 1.2}, {0, 0, 0}, 0.9);
        EXPECT_TRUE(obeys(measure(finish(scene)), 1, 0.001));
    }
}

// GI-2: N scattering events in a closed room whose walls all shine.
SceneData closed_furnace(float reflectance, int bounces)
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(reflectance, 0.5f));
    scene.place(scene.add_mesh(room({-1, -1, -1}, {1, 2, 1.5}, wall)));
    look(scene, {0, 0, 1}, {0.3, 0.2, -1}, 0.6);
    return finish(scene, bounces);
}

TEST_P(Furnace, BouncesAreCounted)
{
    for (const int bounces : {0, 1, 2, 5}) {
        SCOPED_TRACE(bounces);
        const double truth = 0.5 * (1 - std::pow(0.8, bounces + 1)) / (1 - 0.8);
        EXPECT_TRUE(obeys(measure(closed_furnace(0.8f, bounces)), truth));
    }
}

TEST_P(Furnace, UnlimitedBouncesReachTheLimit)
{
    EXPECT_TRUE(obeys(measure(closed_furnace(0.5f, BOUNCES_UNLIMITED)), 1));
    EXPECT_TRUE(obeys(measure(closed_furnace(0.8f, BOUNCES_UNLIMITED)), 2.5));
}

// Roulette must not let the weights of long paths grow: the mean path has a hundred bounces.
TEST_P(Furnace, AlmostLosslessRoomReachesTheLimit)
{
    EXPECT_TRUE(obeys(measure(closed_furnace(0.99f, BOUNCES_UNLIMITED)), 50));
}

// GI-3: in a sphere, each bounce of light spreads evenly over the wall, wherever its source is.
SceneData integrating_sphere(int bounces)
{
    SceneBuilder scene;
    const int wall = scene.add_material(lambert(0.8f));
    scene.place(scene.add_mesh(faceted_sphere(2, 128, wall, true)));
    scene.add_light({.intensity = {3, 3, 3}, .position = {0.9, 0.5, -0.4}});
    look(scene, {0, 0.2, 0}, {-2, 0.3, 0.4}, 0.5);
    return finish(scene, bounces);
}

TEST_P(Furnace, SphereSpreadsEachBounceEvenly)
{
    const double rho = 0.8, flux = 4 * pi * 3, even = flux / (4 * pi * 2 * 2);
    Measurement before = measure(integrating_sphere(1), 6);
    for (int k = 1; k <= 3; ++k) {
        SCOPED_TRACE(k);
        const Measurement after = measure(integrating_sphere(k + 1), 6);
        EXPECT_TRUE(obeys(difference(after, before), rho / pi * std::pow(rho, k) * even, 0.0005));
        before = after;
    }
    const Measurement indirect = difference(measure(integrating_sphere(BOUNCES_UNLIMITED), 6),
                                            measure(integrating_sphere(1), 6));
    EXPECT_TRUE(obeys(indirect, rho / pi * rho / (1 - rho) * even, 0.0005));
}

// GI-5: an inner sphere shines at an outer one. Areas are those of the facets.
struct Spheres {
    SceneData scene;
    double inner_exitance;
    double outer_exitance;
};

Spheres concentric_spheres(const Vec3& eye, const Vec3& target)
{
    const float rho1 = 0.4f, rho2 = 0.7f, radiance = 2;
    SceneBuilder scene;
    const int inner = scene.add_material(lambert(rho1, radiance));
    const int outer = scene.add_material(lambert(rho2));
    const MeshPart inside = faceted_sphere(1, 96, inner, false);
    const MeshPart outside = faceted_sphere(2, 96, outer, true);
    const double f21 = area(inside) / area(outside);
    scene.place(scene.add_mesh(inside));
    scene.place(scene.add_mesh(outside));
    look(scene, eye, target, 0.3);
    // B1 = M + rho1 B2, B2 = rho2 (F21 B1 + (1 - F21) B2).
    const double exitance = pi * radiance;
    const double b2 = rho2 * f21 * exitance / (1 - rho2 * (1 - f21) - rho2 * f21 * rho1);
    return {finish(scene), exitance + rho1 * b2, b2};
}

TEST_P(Furnace, ConcentricSpheresExchangeLight)
{
    const Spheres outwards = concentric_spheres({0, 1.5, 0.3}, {0.2, 2, 0.4});
    EXPECT_TRUE(obeys(measure(outwards.scene, 4), outwards.outer_exitance / pi, 0.001));
    const Spheres inwards = concentric_spheres({0.4, 1.5, 0.3}, {0.2, 0.9, 0.1});
    EXPECT_TRUE(obeys(measure(inwards.scene, 4), inwards.inner_exitance / pi, 0.001));
}

ON_EACH_BACKEND(Furnace);

}  // namespace
