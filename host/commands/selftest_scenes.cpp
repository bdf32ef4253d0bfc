#include "host/commands/selftest_scenes.hpp"

#include "common/textures/procedural.h"
#include "host/scene/scene_builder.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace diptych {
namespace {

constexpr int picture_size = 32;

using Texel = std::array<double, 4>;  // 0 to 1 for 8 bits

Picture picture_of(int width, int height, bool is_float,
                   const std::function<Texel(double u, double v)>& paint)
{
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.is_integer = !is_float;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const double value : paint((x + 0.5) / width, (y + 0.5) / height)) {
                if (is_float)
                    picture.floats.push_back(float(value));
                else
                    picture.bytes.push_back(std::uint8_t(std::lround(value * 255)));
            }
    return picture;
}

Picture sky()
{
    return picture_of(16, 8, true, [](double u, double v) {
        const bool is_sun = std::abs(u - 0.3) < 0.04 && std::abs(v - 0.3) < 0.07;
        const double glow = is_sun ? 40 : 0;
        return Texel{0.3 + 0.4 * u + glow, 0.5 + glow, 0.9 - 0.5 * v + glow, 1};
    });
}

Texel checks(double u, double v)
{
    const bool is_odd = (int(u * 6) + int(v * 6)) % 2 != 0;
    return is_odd ? Texel{0.9, 0.3, 0.2, 1} : Texel{0.2, 0.6, 0.8, 0.3};
}

Texel bumps(double u, double v)
{
    const double x = 0.4 * std::sin(2 * std::numbers::pi * 3 * u);
    const double y = 0.4 * std::sin(2 * std::numbers::pi * 2 * v);
    return {0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.95, 1};
}

MeshPart with_colors(MeshPart part)
{
    for (size_t k = 0; k < part.positions.size(); ++k) {
        const float t = float(k) / float(part.positions.size());
        part.colors.push_back({1 - 0.5f * t, 0.4f + 0.6f * t, 0.8f, 1});
    }
    return part;
}

void add_textured_things(SceneBuilder& scene)
{
    const TextureUse checked{.image = scene.add_image(picture_of(32, 32, false, checks)),
                             .wrap_u = WRAP_MIRROR,
                             .to_uv = {{{1.7, 0.4, 0.1}, {-0.4, 1.7, 0.2}}}};
    TextureUse nearest = checked;
    nearest.filter = TEXTURE_NEAREST;
    nearest.wrap_v = WRAP_CLAMP;
    const TextureUse measured{.image = scene.add_image(picture_of(8, 8, true, [](double u, double) {
        return Texel{0.5, 0.2 + 0.8 * u, 0.7, 0.5 + 0.5 * u};
    }))};
    const TextureUse bumpy{.image = scene.add_image(picture_of(32, 32, false, bumps))};
    const int floor = scene.add_material({.roughness = 0.4f,
                                          .normal_scale = 0.8f,
                                          .base_texture = checked,
                                          .normal_texture = bumpy});
    const int panel = scene.add_material({.emission = {3, 2.5f, 2}, .emission_texture = nearest});
    const int leaf = scene.add_material(
        {.alpha_mode = ALPHA_MASK, .is_double_sided = true, .base_texture = nearest});
    const int veil =
        scene.add_material({.base_color = {0.8f, 0.9f, 0.8f, 0.5f}, .alpha_mode = ALPHA_BLEND});
    const int metal = scene.add_material({.metallic = 0.9f,
                                          .roughness = 0.9f,
                                          .metallic_roughness_texture = measured,
                                          .normal_texture = bumpy});
    const int coated = scene.add_material({.roughness = 0.2f,
                                           .specular_color = {1, 0.7f, 0.4f},
                                           .ior = 1.8f,
                                           .specular_texture = measured,
                                           .specular_color_texture = checked});
    scene.place(scene.add_mesh(quad_mesh({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-1, 2.6, -1}, {2, 0, 0}, {0, 0, 2}, panel)));
    scene.place(scene.add_mesh(quad_mesh({-1.6, 0.1, 0.9}, {1, 0, 0.3}, {0, 1.2, 0}, leaf)));
    scene.place(scene.add_mesh(quad_mesh({0.5, 0.1, 1.2}, {1.1, 0, -0.2}, {0, 1.3, 0}, veil)));
    const int ball = scene.add_mesh(with_colors(sphere_mesh({0, 0, 0}, 0.55, 24, metal)));
    scene.place(ball, translation(-0.8, 0.55, -0.4));
    scene.place(ball, translation(0.7, 0.7, -0.8) * scaling(-1, 1.2, 0.8));
    scene.place(scene.add_mesh(sphere_mesh({0.1, 0.35, 0.7}, 0.35, 24, coated)));
}

SceneData everything()
{
    SceneBuilder scene;
    add_textured_things(scene);
    const int sign = scene.add_material({.base_color = {0.1f, 0.8f, 0.3f, 1}, .is_unlit = true});
    scene.place(scene.add_mesh(box_mesh({-2.2, 0, -1.6}, {-1.6, 0.6, -1}, sign)));
    scene.add_light({.kind = LIGHT_POINT, .intensity = {2, 2, 1}, .position = {1.5, 1.8, 1.5}});
    scene.add_light({.kind = LIGHT_SPOT,
                     .intensity = {6, 4, 4},
                     .position = {-1.5, 2, 1.5},
                     .direction = {0.6, -1, -0.7},
                     .inner_angle = 0.2,
                     .outer_angle = 0.6,
                     .range = 8});
    scene.add_light(
        {.kind = LIGHT_DIRECTIONAL, .intensity = {0.5f, 0.6f, 0.8f}, .direction = {0.3, -1, 0.2}});
    scene.set_environment(sky(), 0.7, 0.5f);
    scene.set_camera({.eye = {0.3, 1.6, 4.2}, .target = {0, 0.7, 0}});
    scene.set_picture_size(picture_size, picture_size);
    return scene.finish();
}

// What the loops for simple scenes are made for: Lambert under area lights.
SceneData matte_room()
{
    SceneBuilder scene;
    const auto matte = [&](float r, float g, float b) {
        return scene.add_material({.base_color = {r, g, b, 1}, .specular = 0});
    };
    const int lamp = scene.add_material({.specular = 0, .emission = {9, 8, 6}});
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, matte(.7f, .7f, .7f))));
    scene.place(scene.add_mesh(quad_mesh({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, matte(.7f, .7f, .6f))));
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, matte(.6f, .1f, .1f))));
    scene.place(
        scene.add_mesh(box_mesh({-0.3, 0, -0.5}, {0.5, 0.9, 0.2}, matte(0.2f, 0.5f, 0.3f))));
    scene.place(scene.add_mesh(quad_mesh({-.3, 1.9, -.3}, {.6, 0, 0}, {0, 0, .6}, lamp)));
    scene.set_camera({.eye = {0.4, 1.2, 4}, .target = {0, 0.9, 0}, .half_height = 1.2});
    scene.set_picture_size(picture_size, picture_size);
    return scene.finish();
}

// Roughness from mirror to matte, metals and dielectrics, nothing but a sky for light.
SceneData row_of_balls()
{
    SceneBuilder scene;
    const int ground = scene.add_material({.base_color = {0.4f, 0.4f, 0.4f, 1}});
    scene.place(scene.add_mesh(quad_mesh({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, ground)));
    for (int k = 0; k < 6; ++k) {
        const int material = scene.add_material({.base_color = {0.9f, 0.7f, 0.4f, 1},
                                                 .metallic = k % 2 == 0 ? 1.0f : 0.0f,
                                                 .roughness = float(k / 2) * 0.5f});
        scene.place(scene.add_mesh(sphere_mesh({k - 2.5, 0.45, 0}, 0.45, 24, material)));
    }
    scene.set_environment(sky());
    scene.set_camera({.eye = {0, 1.8, 6}, .target = {0, 0.3, 0}});
    scene.set_picture_size(picture_size, picture_size);
    return scene.finish();
}

// A texture as the texture tool writes them, which the self-test does without.
TextureFunction texture_of(const std::string& id, std::vector<TextureArgument> arguments,
                           unsigned attributes, const std::string& body)
{
    std::string values;
    for (size_t k = 0; k < arguments.size(); ++k)
        values += "    const " + arguments[k].type + " " + arguments[k].name + " = tx_argument_" +
                  arguments[k].type + "(tx, region, " + std::to_string(k) + ");\n";
    TextureFunction function;
    function.id = id;
    function.file = "selftest.c";
    function.entry = id;
    function.opencl = "SHARED float4 " + id + "_entry(TextureContext* tx, int region)\n{\n" +
                      values + body + "}\n";
    function.cpp = "namespace " + id + " {\n" + function.opencl + "}\n";
    function.arguments = std::move(arguments);
    function.attributes = attributes;
    return function;
}

// Textures that ask for occlusion, read each other and images, and do what users should not.
SceneData procedural()
{
    SceneBuilder scene;
    TextureFunction crevices =
        texture_of("crevices", {{"color", "float3"}}, ATTRIBUTE_TexCoord0 | ATTRIBUTE_TexCoord0Dx,
                   "    const float open = tx_occlusion(tx, 0);\n"
                   "    const float2 uv = tx_attribute_TexCoord0(tx);\n"
                   "    const float blur = tx_attribute_TexCoord0Dx(tx).x;\n"
                   "    return TX_NEW(float4, color.x * open, color.y * tx_fabs_float(uv.x),\n"
                   "                  color.z + 0.1f * blur, 1.0f);\n");
    OcclusionRequest near;
    near.distance = 0.5;
    crevices.occlusion = {near};
    const int waves = scene.add_texture_function(
        texture_of("waves", {{"under", "float4"}, {"scale", "float"}},
                   ATTRIBUTE_WorldPos | ATTRIBUTE_Normal | ATTRIBUTE_Tangent,
                   "    const float3 p = tx_attribute_WorldPos(tx);\n"
                   "    const float3 n = tx_attribute_Normal(tx);\n"
                   "    const float3 t = tx_attribute_Tangent(tx);\n"
                   "    const float w = 0.5f + 0.5f * tx_sin_float(p.x * scale + p.z);\n"
                   "    float turns = 0.0f;\n"
                   "    tx->budget = 8;\n"
                   "    while (tx_spend(tx, 1)) turns += 0.01f * (float)tx_index(tx, 5, 3);\n"
                   "    return TX_NEW(float4, under.x * w, 0.3f + 0.4f * n.y * n.y,\n"
                   "                  turns + 0.1f * t.x * t.x, 1.0f);\n"));
    const int base = scene.add_texture_node({"crevices",
                                             scene.add_texture_function(crevices),
                                             {{"color", {.numbers = {0.8, 0.6, 0.4}}}}});
    TextureUse low, high;
    low.node = base;
    high.node = scene.add_texture_node(
        {"waves", waves, {{"under", {.node = base}}, {"scale", {.numbers = {9}}}}});
    const int floor = scene.add_material({.base_texture = low, .metallic_roughness_texture = high});
    const int thing = scene.add_material({.base_texture = high, .specular_color_texture = low});
    const int lamp = scene.add_material({.emission = {6, 6, 5}});
    scene.set_textures({.occlusion_rays = 4});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor)));
    scene.place(scene.add_mesh(sphere_mesh({0, 0.5, 0}, 0.5, 24, thing)));
    scene.place(scene.add_mesh(box_mesh({0.6, 0, -0.4}, {1.1, 0.6, 0.3}, thing)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp)));
    scene.set_camera({.eye = {0.5, 1.4, 3}, .target = {0, 0.3, 0}});
    scene.set_picture_size(picture_size, picture_size);
    return scene.finish();
}

// Textures asked away from the place that a path has met, and aside from what surfaces read: they
// give light, holes, the distance that another's occlusion reaches, and layers of the picture.
SceneData procedural_aside()
{
    SceneBuilder scene;
    const auto node = [&](const std::string& name, TextureFunction function,
                          std::map<std::string, TextureInput> inputs = {}) {
        return scene.add_texture_node({name, scene.add_texture_function(function), inputs});
    };
    const int reach =
        node("reach", texture_of("reach", {}, ATTRIBUTE_WorldPos,
                                 "    const float3 p = tx_attribute_WorldPos(tx);\n"
                                 "    const float far = 0.4f + 0.3f * tx_sin_float(7.0f * p.x);\n"
                                 "    return TX_NEW(float4, far, p.z, 0.0f, 1.0f);\n"));
    TextureFunction hollows = texture_of("hollows", {{"reach", "float"}}, 0,
                                         "    const float open = tx_occlusion(tx, 0);\n"
                                         "    return TX_NEW(float4, open, reach, 0.5f, 1.0f);\n");
    OcclusionRequest request;
    request.distance_argument = 0;
    hollows.occlusion = {request};
    TextureUse base, holes, glow;
    base.node = node("hollows", hollows, {{"reach", {.node = reach}}});
    holes.node = node(
        "holes", texture_of("holes", {}, ATTRIBUTE_TexCoord0,
                            "    const float2 uv = tx_attribute_TexCoord0(tx);\n"
                            "    const float w = tx_sin_float(20.0f * uv.x);\n"
                            "    return TX_NEW(float4, 0.7f, 0.8f, 0.3f, 0.5f + 0.5f * w);\n"));
    glow.node =
        node("glow", texture_of("glow", {}, ATTRIBUTE_LocalPos,
                                "    const float3 p = tx_attribute_LocalPos(tx);\n"
                                "    const float w = 0.6f + 0.4f * tx_sin_float(9.0f * p.x);\n"
                                "    return TX_NEW(float4, w, w * w, 0.5f, 1.0f);\n"));
    for (const int shown : {base.node, reach}) scene.add_aov(shown);
    const int floor = scene.add_material({.base_texture = base});
    const int leaf = scene.add_material({.alpha_mode = ALPHA_MASK, .base_texture = holes});
    const int veil = scene.add_material({.alpha_mode = ALPHA_BLEND, .base_texture = holes});
    const int lamp = scene.add_material({.emission = {7, 6, 5}, .emission_texture = glow});
    scene.set_textures({.occlusion_rays = 4});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor)));
    scene.place(scene.add_mesh(box_mesh({0.2, 0, -0.8}, {0.9, 0.7, -0.2}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-1.2, 0.1, 0.2}, {1.3, 0, 0.3}, {0, 1.1, 0}, leaf)));
    scene.place(scene.add_mesh(quad_mesh({0.3, 0.1, 0.7}, {0.9, 0, -0.2}, {0, 1, 0}, veil)));
    scene.place(scene.add_mesh(quad_mesh({-0.6, 2, -0.5}, {1.2, 0, 0}, {0, 0, 1}, lamp)));
    scene.set_camera({.eye = {0.5, 1.4, 3}, .target = {0, 0.4, 0}});
    scene.set_picture_size(picture_size, picture_size);
    return scene.finish();
}

}  // namespace

std::vector<SelftestScene> selftest_scenes()
{
    std::vector<SelftestScene> scenes;
    scenes.push_back({"everything at once", everything()});
    scenes.push_back({"matte room, orthographic", matte_room()});
    scenes.push_back({"balls under a sky", row_of_balls()});
    scenes.push_back({"procedural textures", procedural()});
    scenes.push_back({"textures asked aside", procedural_aside()});
    return scenes;
}

}  // namespace diptych
