// The scene that `diptych render` shows without a file: a room with a terracotta and a teal wall, a
// tiled floor, a marble vase on a plinth, a gold sphere, a small lacquered one and a leaning
// mirror, under one panel of light.
#include "host/scene/load.hpp"

#include <algorithm>
#include <functional>
#include <numbers>

namespace diptych {
namespace {

using std::numbers::pi;

// Integer lattice noise, so that the picture is the same on every machine.
double lattice(int x, int y)
{
    unsigned h = unsigned(x) * 0x9E3779B1u ^ unsigned(y) * 0x85EBCA77u;
    h = (h ^ h >> 15) * 0x2C1B3C6Du;
    h = (h ^ h >> 12) * 0x297A2D39u;
    return double(h ^ h >> 15) / 4294967295.0;
}

// Smooth noise of 0..1 that repeats every `period` cells in x.
double noise(double x, double y, int period)
{
    const int ix = int(std::floor(x)), iy = int(std::floor(y));
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double fx = smooth(x - ix), fy = smooth(y - iy);
    const auto at = [&](int dx, int dy) {
        return lattice(((ix + dx) % period + period) % period, iy + dy);
    };
    const double low = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    const double high = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    return low + (high - low) * fy;
}

double turbulence(double u, double v)
{
    double sum = 0, weight = 0.5;
    for (int octave = 0, cells = 6; octave < 6; ++octave, cells *= 2, weight /= 2) {
        sum += weight * noise(u * cells, v * cells, cells);
    }
    return sum;
}

struct Rgb {
    double r, g, b;
};

Rgb mix(const Rgb& a, const Rgb& b, double t)
{
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

Picture painted(int width, int height, const std::function<Rgb(double u, double v)>& color)
{
    Picture picture{width, height, {}, {}, true, 0};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Rgb c = color((x + 0.5) / width, (y + 0.5) / height);
            for (const double value : {c.r, c.g, c.b, 1.0}) {
                picture.bytes.push_back(std::uint8_t(std::clamp(value, 0.0, 1.0) * 255 + 0.5));
            }
        }
    }
    return picture;
}

// Ivory with dark green veins; colours as sRGB values.
Rgb marble(double u, double v)
{
    const double t = turbulence(u, v);
    const double vein = std::pow(1 - std::abs(std::sin(2 * pi * (u + v) + 7 * t)), 5);
    const double fine = std::pow(1 - std::abs(std::sin(2 * pi * (3 * u - 2 * v) + 11 * t)), 9);
    const Rgb stone = mix({0.95, 0.92, 0.86}, {0.80, 0.80, 0.74}, t);
    return mix(mix(stone, {0.16, 0.30, 0.25}, 0.85 * vein), {0.45, 0.38, 0.28}, 0.5 * fine);
}

// 8 x 8 tiles with joints, each of its own shade.
Rgb tiles(double u, double v)
{
    const double x = u * 8, y = v * 8;
    const int column = int(x), row = int(y);
    const double edge = std::min({x - column, column + 1 - x, y - row, row + 1 - y});
    const Rgb light{0.82, 0.77, 0.68}, dark{0.30, 0.30, 0.31};
    const Rgb tile = (column + row) % 2 ? light : dark;
    const double shade = 0.9 + 0.1 * lattice(column, row) + 0.06 * (turbulence(u * 2, v * 2) - 0.5);
    const Rgb worn{tile.r * shade, tile.g * shade, tile.b * shade};
    return edge < 0.012 ? Rgb{0.22, 0.20, 0.18} : worn;
}

// A surface of revolution about +Y; the profile gives (radius, height) from bottom to top.
MeshPart lathe(const Vec3& foot, const std::vector<std::array<double, 2>>& profile, int segments,
               int material)
{
    MeshPart part;
    part.material = material;
    part.uvs.resize(1);
    const int rows = int(profile.size());
    for (int row = 0; row < rows; ++row) {
        const auto& below = profile[size_t(std::max(row - 1, 0))];
        const auto& above = profile[size_t(std::min(row + 1, rows - 1))];
        const double rise = above[1] - below[1], flare = above[0] - below[0];
        for (int column = 0; column <= segments; ++column) {
            const double angle = 2 * pi * (column % segments) / segments;
            const double c = std::cos(angle), s = -std::sin(angle);
            const auto [radius, height] = profile[size_t(row)];
            const Vec3 n = unit({c * rise, -flare, s * rise});
            part.positions.push_back({float(foot[0] + c * radius), float(foot[1] + height),
                                      float(foot[2] + s * radius)});
            part.normals.push_back({float(n[0]), float(n[1]), float(n[2])});
            part.uvs[0].push_back(
                {float(double(column) / segments), float(1 - double(row) / (rows - 1))});
        }
    }
    for (int row = 0; row + 1 < rows; ++row) {
        for (int column = 0; column < segments; ++column) {
            const uint a = uint(row * (segments + 1) + column), b = a + uint(segments) + 1;
            if (profile[size_t(row)][0] > 0) {
                part.indices.insert(part.indices.end(), {a, a + 1, b});
            }
            if (profile[size_t(row) + 1][0] > 0) {
                part.indices.insert(part.indices.end(), {b, a + 1, b + 1});
            }
        }
    }
    return part;
}

// Foot, belly, neck and lip, then down the inside.
std::vector<std::array<double, 2>> vase_profile()
{
    std::vector<std::array<double, 2>> profile{{0.0, 0.0}, {0.13, 0.0}, {0.14, 0.015}};
    constexpr int steps = 60;
    for (int k = 0; k <= steps; ++k) {
        const double t = double(k) / steps;
        const double belly = 0.20 * std::pow(std::sin(pi * std::pow(t, 0.8)), 1.4);
        profile.push_back({0.115 + belly - 0.035 * t + 0.05 * std::pow(t, 12), 0.03 + 0.78 * t});
    }
    const auto lip = profile.back();
    for (int k = 1; k <= 6; ++k) {  // the lip's half circle
        const double angle = pi * k / 6;
        profile.push_back(
            {lip[0] - 0.012 * (1 - std::cos(angle)), lip[1] + 0.012 * std::sin(angle)});
    }
    profile.push_back({lip[0] - 0.06, lip[1] - 0.12});
    profile.push_back({0.0, lip[1] - 0.5});
    return profile;
}

void add_room(SceneBuilder& scene)
{
    const auto matte = [&](const char* name, float r, float g, float b) {
        return scene.add_material({.name = name, .base_color = {r, g, b, 1}, .specular = 0});
    };
    const int plaster = matte("plaster", 0.76f, 0.73f, 0.68f);
    const int terracotta = matte("terracotta", 0.60f, 0.20f, 0.11f);
    const int teal = matte("teal", 0.07f, 0.27f, 0.30f);
    const int floor =
        scene.add_material({.name = "tiles",
                            .roughness = 0.25f,
                            .base_texture = {.image = scene.add_image(painted(512, 512, tiles))}});
    const auto wall = [&](const Vec3& origin, const Vec3& u, const Vec3& v, int material) {
        scene.place(scene.add_mesh(quad_mesh(origin, u, v, material)));
    };
    wall({-2, 0, 2.6}, {4, 0, 0}, {0, 0, -4.6}, floor);
    wall({-2, 3, -2}, {4, 0, 0}, {0, 0, 4.6}, plaster);
    wall({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, plaster);
    wall({-2, 0, 2.6}, {0, 0, -4.6}, {0, 3, 0}, terracotta);
    wall({2, 0, -2}, {0, 0, 4.6}, {0, 3, 0}, teal);

    const int lamp =
        scene.add_material({.name = "lamp", .specular = 0, .emission = {7.2f, 6.4f, 5.2f}});
    wall({-1.25, 2.98, -1.3}, {2.5, 0, 0}, {0, 0, 1.9}, lamp);
}

void add_objects(SceneBuilder& scene)
{
    const int stone = scene.add_material(
        {.name = "limestone", .base_color = {0.70f, 0.67f, 0.62f, 1}, .specular = 0});
    const int gold = scene.add_material(
        {.name = "gold", .base_color = {1.0f, 0.71f, 0.29f, 1}, .metallic = 1, .roughness = 0.32f});
    const int mirror = scene.add_material(
        {.name = "mirror", .base_color = {0.95f, 0.95f, 0.95f, 1}, .metallic = 1, .roughness = 0});
    const int brass = scene.add_material({.name = "brass",
                                          .base_color = {0.88f, 0.66f, 0.38f, 1},
                                          .metallic = 1,
                                          .roughness = 0.45f});
    const int lacquer = scene.add_material(
        {.name = "lacquer", .base_color = {0.03f, 0.10f, 0.33f, 1}, .roughness = 0.08f});
    const int marble_stone =
        scene.add_material({.name = "marble",
                            .roughness = 0.15f,
                            .base_texture = {.image = scene.add_image(painted(512, 512, marble))}});

    const Transform turned = translation(0.15, 0, -0.55) * rotation_about({0, 1, 0}, 0.4);
    scene.place(scene.add_mesh(box_mesh({-0.34, 0, -0.34}, {0.34, 0.72, 0.34}, stone)), turned);
    scene.place(scene.add_mesh(lathe({0, 0.72, 0}, vase_profile(), 160, marble_stone)), turned);
    scene.place(scene.add_mesh(sphere_mesh({-1.02, 0.52, 0.12}, 0.52, 256, gold)));
    scene.place(scene.add_mesh(sphere_mesh({0.72, 0.24, 0.85}, 0.24, 192, lacquer)));

    // Leaning against the back wall, turned a little towards the room.
    const Transform leaning = translation(1.2, 0.03, -1.4) * rotation_about({0, 1, 0}, -0.6) *
                              rotation_about({1, 0, 0}, -0.05);
    scene.place(scene.add_mesh(quad_mesh({-0.5, 0.05, 0.031}, {1, 0, 0}, {0, 2, 0}, mirror)),
                leaning);
    scene.place(scene.add_mesh(box_mesh({-0.56, -0.01, -0.03}, {0.56, 2.11, 0.03}, brass)),
                leaning);
}

}  // namespace

SceneData demo_scene(const LoadOptions& options)
{
    SceneBuilder scene;
    add_room(scene);
    add_objects(scene);
    scene.set_camera({.eye = {0, 1.45, 6.6}, .target = {0, 1.38, 0}, .fov = 0.62});
    apply_options(scene, options);
    return scene.finish();
}

}  // namespace diptych
