// Light that arrives at a point, by formula (GI-7 to GI-10, GI-15, GI-16). A white Lambert surface
// shows it: radiance = irradiance / pi.
#include "tests/laws/measure.hpp"

#include <cmath>
#include <numbers>

namespace {

using namespace diptych;
using namespace laws;
using std::numbers::pi;

using Irradiance = OnEachBackend;

constexpr double patch = 1e-3;  // half size of what the camera sees: a point, for these scenes

int add_plane(SceneBuilder& scene, const Vec3& centre, const Vec3& u, const Vec3& v)
{
    const int white = scene.add_material(lambert(1));
    scene.place(scene.add_mesh(quad_mesh(centre - u * 0.5 - v * 0.5, u, v, white)));
    return white;
}

// GI-7: a black ball rests on a plane under a white sky.
TEST_P(Irradiance, BallOnPlaneHidesTheSky)
{
    const double r = 0.5;
    for (const double x : {0.55, 1.0, 2.0}) {
        SCOPED_TRACE(x);
        SceneBuilder scene;
        add_plane(scene, {0, 0, 0}, {0, 0, 40}, {40, 0, 0});
        const int black = scene.add_material(lambert(0));
        scene.place(scene.add_mesh(faceted_sphere(r, 192, black, false)), translation(0, r, 0));
        scene.set_environment(environment_of([](const Vec3&) { return 1.0; }));
        look(scene, {x, 5, 0}, {x, 0, 0}, patch);
        const double truth = 1 - std::pow(r, 3) / std::pow(x * x + r * r, 1.5);
        EXPECT_TRUE(obeys(measure(finish(scene, 1)), truth, 0.0005));
    }
}

// GI-8: a rectangle with a corner over the point, parallel and perpendicular to the surface.
TEST_P(Irradiance, RectangleOverItsCorner)
{
    const double a = 0.8, b = 1.7, h = 1.2, radiance = 3;
    SceneBuilder scene;
    add_plane(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    const int lamp = scene.add_material(lambert(0, float(radiance)));
    scene.place(scene.add_mesh(quad_mesh({0, h, 0}, {a, 0, 0}, {0, 0, b}, lamp)));
    look(scene, {-2, 2, -2}, {0, 0, 0}, patch);
    const double x = a / h, y = b / h;
    const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    const double f = (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
    EXPECT_TRUE(obeys(measure(finish(scene, 1)), radiance * f));
}

TEST_P(Irradiance, RectangleBesideThePoint)
{
    const double a = 0.8, b = 1.7, h = 1.2, radiance = 3;
    SceneBuilder scene;
    add_plane(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    const int lamp = scene.add_material(lambert(0, float(radiance)));
    // In the plane x = h, width a along z, height b, facing the point.
    scene.place(scene.add_mesh(quad_mesh({h, 0, 0}, {0, 0, a}, {0, b, 0}, lamp)));
    look(scene, {-2, 2, -2}, {0, 0, 0}, patch);
    const double far = std::sqrt(h * h + b * b);
    const double f = (std::atan(a / h) - h / far * std::atan(a / far)) / (2 * pi);
    EXPECT_TRUE(obeys(measure(finish(scene, 1)), radiance * f));
}

// GI-9: a disc, seen from a point off its axis and from another disc.
TEST_P(Irradiance, DiscOffItsAxis)
{
    const double r = 0.7, h = 1.1, radiance = 2;
    for (const double a : {0.0, 0.5, 1.5}) {
        SCOPED_TRACE(a);
        SceneBuilder scene;
        add_plane(scene, {a, 0, 0}, {0, 0, 1}, {1, 0, 0});
        const int lamp = scene.add_material(lambert(0, float(radiance)));
        scene.place(scene.add_mesh(disc({0, h, 0}, {0, -1, 0}, r, lamp)));
        look(scene, {a + 0.4, 0.5, 0.3}, {a, 0, 0}, patch);
        const double s = h * h + a * a;
        const double f =
            0.5 * (1 - (s - r * r) / std::sqrt((s + r * r) * (s + r * r) - 4 * a * a * r * r));
        EXPECT_TRUE(obeys(measure(finish(scene, 1)), radiance * f));
    }
}

TEST_P(Irradiance, DiscToDisc)
{
    const double r1 = 0.9, r2 = 0.6, h = 0.8, radiance = 2, half = 1;
    SceneBuilder scene;
    const int white = scene.add_material(lambert(1));
    const int lamp = scene.add_material(lambert(0, float(radiance)));
    scene.place(scene.add_mesh(disc({0, h, 0}, {0, -1, 0}, r2, lamp)));
    scene.place(scene.add_mesh(disc({0, 0, 0}, {0, 1, 0}, r1, white)));
    look(scene, {0, h / 2, 0}, {0, 0, 0}, half);
    const double s = 1 + (h * h + r2 * r2) / (r1 * r1);
    const double ratio = r2 / r1;
    const double f12 = 0.5 * (s - std::sqrt(s * s - 4 * ratio * ratio));
    const double share = pi * r1 * r1 / (4 * half * half);  // of the picture
    EXPECT_TRUE(obeys(measure(finish(scene, 1)), radiance * f12 * share));
}

// GI-10: wall to wall in a cube.
TEST_P(Irradiance, CubeWallToWall)
{
    const double radiance = 2;
    for (const bool is_opposite : {true, false}) {
        SCOPED_TRACE(is_opposite ? "opposite" : "adjacent");
        SceneBuilder scene;
        const int white = scene.add_material(lambert(1));
        const int lamp = scene.add_material(lambert(0, float(radiance)));
        scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, white)));
        scene.place(scene.add_mesh(is_opposite ? quad_mesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, lamp)
                                               : quad_mesh({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, lamp)));
        look(scene, {0.5, 0.5, 0.5}, {0.5, 0, 0.5}, 0.5);
        const double truth = radiance * (is_opposite ? 0.199825 : 0.200044);
        EXPECT_TRUE(obeys(measure(finish(scene, 1)), truth));
    }
}

// GI-15: a sky that is a polynomial of height, on surfaces of any tilt.
TEST_P(Irradiance, PolynomialSkyOnTiltedSurfaces)
{
    const double a = 1, b = 0.5, c = 0.8;
    for (const double tilt : {0.0, 0.7, 1.5707963, 2.5}) {
        SCOPED_TRACE(tilt);
        SceneBuilder scene;
        const Vec3 normal{std::sin(tilt), std::cos(tilt), 0};
        const Vec3 along{0, 0, 1};
        add_plane(scene, {0, 0, 0}, along, cross(normal, along));
        scene.set_environment(
            environment_of([&](const Vec3& w) { return a + b * w[1] + c * w[1] * w[1]; }, 8, 512));
        look(scene, normal * 2 + along * 0.5, {0, 0, 0}, patch);
        const double cosine = std::cos(tilt);
        const double truth = pi * a + 2 * pi / 3 * b * cosine + pi / 4 * c * (1 + cosine * cosine);
        EXPECT_TRUE(obeys(measure(finish(scene, 1)), truth / pi));
    }
}

// GI-16: the edge of a half plane before a small sun, here a polygon of 256 corners. u: where the
// edge cuts the disc, in units of its radius.
TEST_P(Irradiance, PenumbraOfAStraightEdge)
{
    const double sine = 0.01, distance = 1000, height = 1, radiance = 1e4;
    for (const double u : {-1.5, -0.6, 0.0, 0.3, 0.8}) {
        SCOPED_TRACE(u);
        SceneBuilder scene;
        add_plane(scene, {0, 0, 0}, {0, 0, 2}, {2, 0, 0});
        const int black = scene.add_material(lambert(0));
        const int sun = scene.add_material(lambert(0, float(radiance)));
        const double edge = -u * sine * height;
        scene.place(
            scene.add_mesh(quad_mesh({edge - 8, height, -8}, {8, 0, 0}, {0, 0, 16}, black)));
        scene.place(scene.add_mesh(disc({0, distance, 0}, {0, -1, 0}, sine * distance, sun)));
        look(scene, {1, 0.5, 0.2}, {0, 0, 0}, 1e-5);
        const double inside = std::min(std::abs(u), 1.0) * (u < 0 ? -1 : 1);
        const double fraction =
            0.5 + (inside * std::sqrt(1 - inside * inside) + std::asin(inside)) / pi;
        const double whole = radiance * sine * sine / (1 + sine * sine);
        const Measurement image = measure(finish(scene, 1), 6);
        if (fraction > 0)
            EXPECT_TRUE(obeys(image, whole * fraction));
        else
            EXPECT_EQ(image.mean(), 0);
    }
}

ON_EACH_BACKEND(Irradiance);

}  // namespace
