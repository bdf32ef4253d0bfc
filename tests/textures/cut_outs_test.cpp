// Alpha that a texture gives: no traversal runs users' code, rays stop and are asked for, and what
// the camera, the scattered and the shadow rays see is what the equal image would show.
#include "common/textures/procedural.h"
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cmath>

namespace {

using namespace diptych;
using textures::handwritten;

constexpr int squares = 8;
int is_hole(int x, int y) { return (x + y) % 2; }

// Checks of holes; `alpha` is that of the rest.
TextureFunction checks()
{
    return handwritten("t0", {{"alpha", "float"}},
                       "    const float2 uv = tx_attribute_TexCoord0(tx);\n"
                       "    const float x = math_floor(uv.x * 8.0f);\n"
                       "    const float y = math_floor(uv.y * 8.0f);\n"
                       "    const float half_sum = 0.5f * (x + y);\n"
                       "    const float odd = 2.0f * (half_sum - math_floor(half_sum));\n"
                       "    const float a = odd > 0.5f ? 0.0f : alpha;\n"
                       "    return TX_NEW(float4, 0.8f, 0.4f, 0.2f, a);",
                       ATTRIBUTE_TexCoord0);
}

TextureFunction veil()
{
    return handwritten("t1", {{"alpha", "float"}},
                       "    return TX_NEW(float4, 0.0f, 0.0f, 0.0f, alpha);");
}

Picture picture_of_checks()
{
    Picture picture{squares, squares, {}, {}, false, 0};
    for (int y = 0; y < squares; ++y)
        for (int x = 0; x < squares; ++x)
            picture.floats.insert(picture.floats.end(),
                                  {0.8f, 0.4f, 0.2f, is_hole(x, y) ? 0.0f : 1.0f});
    return picture;
}

TextureUse paint(SceneBuilder& scene, bool is_image)
{
    TextureUse use;
    if (is_image) {
        use.image = scene.add_image(picture_of_checks());
        use.filter = TEXTURE_NEAREST;
    } else {
        use.node = scene.add_texture_node(
            {"checks", scene.add_texture_function(checks()), {{"alpha", {.numbers = {1}}}}});
    }
    return use;
}

// Screens between a lamp and a floor, one of them an instance of a mesh placed twice.
SceneData screens_and_shadow(bool is_image, int mode)
{
    SceneBuilder scene;
    const TextureUse use = paint(scene, is_image);
    const int floor = scene.add_material(laws::lambert(0.6f));
    const int lamp = scene.add_material(laws::lambert(0.5f, 8));
    const int screen = scene.add_material({.specular = 0, .alpha_mode = mode, .base_texture = use});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-0.1, 2, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, lamp)));
    const int mesh = scene.add_mesh(quad_mesh({-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, screen));
    scene.place(mesh, translation(0, 0.8, 0));
    scene.place(mesh, translation(0.06, 0.9, 0.03));
    scene.place(scene.add_mesh(quad_mesh({-1, 0.05, 0.4}, {2, 0, 0}, {0, 1, 0}, screen)));
    scene.set_camera({.eye = {0.4, 1.6, 3}, .target = {0, 0.4, 0}});
    scene.set_picture_size(48, 32);
    SceneData data = scene.finish();
    data.settings[0].max_bounces = 3;
    return data;
}

std::vector<float> picture_of(Backend& backend, SceneData scene, int samples)
{
    scene.bvh_nodes.clear();
    scene.bvh_items.clear();
    backend.upload(scene);
    RenderOptions options;
    options.samples = samples;
    return image::beauty_of(render(backend, scene, options).film.picture()).pixels;
}

// Pixels of which some component differs by more than rounding.
int differing_pixels(const std::vector<float>& a, const std::vector<float>& b)
{
    int differing = 0;
    for (size_t k = 0; k < a.size(); k += 4) {
        bool differs = false;
        for (size_t c = 0; c < 4; ++c)
            differs |= std::abs(a[k + c] - b[k + c]) > 1e-4f * (std::abs(b[k + c]) + 1e-3f);
        differing += differs ? 1 : 0;
    }
    return differing;
}

class CutOuts : public laws::OnEachBackend {};

TEST_P(CutOuts, CastTheShadowOfTheEqualImage)
{
    const SceneData texture = screens_and_shadow(false, ALPHA_MASK);
    ASSERT_TRUE(texture.effects & EFFECT_PROCEDURAL_ALPHA);
    const SceneData image = screens_and_shadow(true, ALPHA_MASK);
    ASSERT_FALSE(image.effects & EFFECT_PROCEDURAL_ALPHA);
    const std::vector<float> a = picture_of(*backend_, texture, 8);
    const std::vector<float> b = picture_of(*backend_, image, 8);
    EXPECT_LE(differing_pixels(a, b), 8) << "of " << a.size() / 4;
    EXPECT_EQ(backend_->statistics().undecided_rays, 0u);
}

// Sheets of black with alpha 0.3 before a sky of radiance 1: of light, 0.7^n comes through.
TEST_P(CutOuts, BlendedOnesLetTheirShareThrough)
{
    for (const int layers : {1, 3}) {
        SceneBuilder scene;
        const int n = scene.add_texture_node(
            {"veil", scene.add_texture_function(veil()), {{"alpha", {.numbers = {0.3}}}}});
        TextureUse use;
        use.node = n;
        const int sheet =
            scene.add_material({.specular = 0, .alpha_mode = ALPHA_BLEND, .base_texture = use});
        for (int k = 0; k < layers; ++k)
            scene.place(scene.add_mesh(quad_mesh({-2, -2, -0.1 * k}, {4, 0, 0}, {0, 4, 0}, sheet)));
        scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
        laws::look(scene, {0, 0, 3}, {0, 0, 0}, 1);
        EXPECT_TRUE(laws::obeys(measure(laws::finish(scene, 2), 3), std::pow(0.7, layers)))
            << layers;
    }
}

// Beyond the bound a surface is solid, whatever its texture says, and that is counted.
TEST_P(CutOuts, MoreLayersThanTheBoundAreSolid)
{
    SceneBuilder scene;
    const int n = scene.add_texture_node(
        {"nothing", scene.add_texture_function(veil()), {{"alpha", {.numbers = {0}}}}});
    TextureUse use;
    use.node = n;
    const int clear =
        scene.add_material({.specular = 0, .alpha_mode = ALPHA_MASK, .base_texture = use});
    for (int k = 0; k < 66; ++k) {  // the left half has fewer
        const double from = k < 60 ? -2 : 0;
        scene.place(
            scene.add_mesh(quad_mesh({from, -2, -0.01 * k}, {2 - from, 0, 0}, {0, 4, 0}, clear)));
    }
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 1);
    SceneData data = laws::finish(scene, 0);
    const std::vector<float> picture = picture_of(*backend_, data, 1);
    for (size_t k = 0; k < 16 * 16; ++k)
        EXPECT_NEAR(picture[4 * k], k % 16 < 8 ? 1.0f : 0.0f, 1e-5f) << k;
    EXPECT_EQ(backend_->statistics().undecided_rays, 128u);
}

ON_EACH_BACKEND(CutOuts);

}  // namespace
