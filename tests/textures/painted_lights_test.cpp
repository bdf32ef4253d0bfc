// Emitters that a texture paints are lights like others: chosen, sampled at a point whose emission
// the texture stage gives, and weighted against the rays that find them by chance.
#include "common/textures/procedural.h"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cmath>
#include <cstdlib>

namespace {

using namespace diptych;
using textures::handwritten;

// Eight by eight squares: a third dark, a third dim, a third ten times as bright.
constexpr int squares = 8;
int level_of(int x, int y) { return (x + 2 * y) % 3; }
constexpr double levels[] = {0, 1, 10};

double mean_level()
{
    double sum = 0;
    for (int k = 0; k < squares * squares; ++k) sum += levels[level_of(k % squares, k / squares)];
    return sum / (squares * squares);
}

TextureFunction painted_squares()
{
    return handwritten("t0", {{"strength", "float"}},
                       "    const float2 uv = tx_attribute_TexCoord0(tx);\n"
                       "    const float x = math_floor(uv.x * 8.0f);\n"
                       "    const float y = math_floor(uv.y * 8.0f);\n"
                       "    const float k = x + 2.0f * y;\n"
                       "    const float rest = k - 3.0f * math_floor(k * (1.0f / 3.0f) + 0.01f);\n"
                       "    const float v = rest < 0.5f ? 0.0f : (rest < 1.5f ? 1.0f : 10.0f);\n"
                       "    return TX_NEW(float4, v * strength, v * strength, v * strength, 1.0f);",
                       ATTRIBUTE_TexCoord0);
}

Picture picture_of_squares()
{
    Picture picture{squares, squares, {}, {}, false, 0};
    for (int y = 0; y < squares; ++y)
        for (int x = 0; x < squares; ++x) {
            const float v = float(levels[level_of(x, y)]);
            picture.floats.insert(picture.floats.end(), {v, v, v, 1});
        }
    return picture;
}

TextureUse node(int k)
{
    TextureUse use;
    use.node = k;
    return use;
}

int add_squares(SceneBuilder& scene, double strength = 1)
{
    return scene.add_texture_node({"squares",
                                   scene.add_texture_function(painted_squares()),
                                   {{"strength", {.numbers = {strength}}}}});
}

// A square lamp one above a floor, seen from below the lamp; its paint is an image or a texture.
SceneData lamp_and_floor(bool is_image, double side)
{
    SceneBuilder scene;
    TextureUse paint;
    if (is_image) {
        paint.image = scene.add_image(picture_of_squares());
        paint.filter = TEXTURE_NEAREST;
    } else {
        paint = node(add_squares(scene));
    }
    const int floor = scene.add_material(laws::lambert(0.6f));
    const int lamp = scene.add_material({.base_color = {0.5f, 0.5f, 0.5f, 1},
                                         .specular = 0,
                                         .emission = {1, 1, 1},
                                         .emission_texture = paint});
    scene.place(scene.add_mesh(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, floor)));
    scene.place(
        scene.add_mesh(quad_mesh({-side / 2, 1, -side / 2}, {side, 0, 0}, {0, 0, side}, lamp)));
    scene.set_camera({.eye = {0, 0.9, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .half_height = 1});
    scene.set_picture_size(16, 16);
    return laws::finish(scene, 3);
}

// The same scene, whose lights only rays find that come upon them.
SceneData without_light_sampling(SceneData scene)
{
    scene.lights.clear();
    scene.light_choice.clear();
    scene.settings[0].light_count = 0;
    for (int m = 0; m < scene.textures.first_page; ++m) scene.materials[size_t(m)].emission.w = 0;
    scene.effects &= ~unsigned(EFFECT_PROCEDURAL_EMISSION);
    return scene;
}

class PaintedLights : public laws::OnEachBackend {};

TEST_P(PaintedLights, SamplingThemKeepsTheMeanAndLowersTheNoise)
{
    const SceneData scene = lamp_and_floor(false, 0.4);
    ASSERT_TRUE(scene.effects & EFFECT_PROCEDURAL_EMISSION);
    ASSERT_EQ(scene.settings[0].light_count, 2);
    const laws::Measurement with = measure(scene, 4);
    const laws::Measurement without = measure(without_light_sampling(scene), 12);
    const double sigma = std::hypot(with.sigma(), without.sigma());
    EXPECT_NEAR(with.mean(), without.mean(), 4 * sigma);
    EXPECT_LT(sigma, 0.05 * with.mean()) << "too noisy to say something";
    EXPECT_LT(with.sigma(), 0.5 * without.sigma()) << "with a third of the samples";
    EXPECT_EQ(with.faults + without.faults, 0u);
}

// The paint of a lone lamp moves no choice: the same paths, and values that differ by rounding.
TEST_P(PaintedLights, ATextureLightsLikeTheEqualImage)
{
    const laws::Measurement texture = measure(lamp_and_floor(false, 1));
    const laws::Measurement image = measure(lamp_and_floor(true, 1));
    int differing = 0;
    for (size_t k = 0; k < texture.pixels.size(); ++k)
        differing += std::abs(texture.pixels[k] - image.pixels[k]) > 1e-3 * image.pixels[k];
    EXPECT_LE(differing, 2) << "pixels, by more than a texel's edge explains";
    EXPECT_NEAR(texture.mean(), image.mean(), 1e-3 * image.mean());
}

TEST_P(PaintedLights, SeenDirectlyTheyHaveTheirRadiance)
{
    SceneBuilder scene;
    const int n = add_squares(scene, 2);
    const int lamp = scene.add_material({.base_color = {0, 0, 0, 1},
                                         .specular = 0,
                                         .emission = {0.5f, 0.5f, 0.5f},
                                         .emission_texture = node(n)});
    scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lamp)));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 1);
    EXPECT_TRUE(laws::obeys(measure(laws::finish(scene, 0)), mean_level()));
}

// What the texture asks of its surroundings is traced about the point on the light.
TEST_P(PaintedLights, TX_9_OcclusionIsThatOfThePointOnTheLight)
{
    SceneBuilder scene;
    TextureFunction function =
        handwritten("t0", {{"reach", "float"}},
                    "    const float open = tx_occlusion(tx, 0);\n"
                    "    return TX_NEW(float4, open, open, open, 1.0f + 0.0f * reach);");
    OcclusionRequest request;
    request.distance_argument = 0;
    function.occlusion = {request};
    const int n = scene.add_texture_node(
        {"open", scene.add_texture_function(function), {{"reach", {.numbers = {10}}}}});
    scene.set_textures({.occlusion_rays = 8});
    const int floor = scene.add_material(laws::lambert(0.6f));
    const int black = scene.add_material(laws::lambert(0));
    const int lamp = scene.add_material({.base_color = {0, 0, 0, 1},
                                         .specular = 0,
                                         .emission = {3, 3, 3},
                                         .emission_texture = node(n)});
    scene.place(scene.add_mesh(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp)));
    scene.place(scene.add_mesh(quad_mesh({0, 0.2, -0.5}, {0, 0.7, 0}, {0, 0, 1}, black)));
    scene.set_camera({.eye = {0, 0.15, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .half_height = 1});
    scene.set_picture_size(16, 16);
    const SceneData data = laws::finish(scene, 1);
    const laws::Measurement with = measure(data, 2);
    const laws::Measurement without = measure(without_light_sampling(data), 6);
    const double sigma = std::hypot(with.sigma(), without.sigma());
    EXPECT_NEAR(with.mean(), without.mean(), 4 * sigma);
    EXPECT_LT(sigma, 0.02 * with.mean());
}

ON_EACH_BACKEND(PaintedLights);

// Two lamps of equal size, one plain: their shares of the choices are those of their power.
double share_of_painted(SceneData& scene)
{
    double share = 0;
    for (const Light& light : scene.lights)
        if (scene.materials[size_t(scene.triangles[size_t(light.triangle)].material)]
                .texture_program[PROGRAM_EMISSION] != 0)
            share += double(light.emission.w);
    return share;
}

SceneData two_lamps(double strength)
{
    SceneBuilder scene;
    const int n = add_squares(scene, strength);
    const int plain = scene.add_material(laws::lambert(0.5f, 2));
    const int painted =
        scene.add_material({.specular = 0, .emission = {2, 2, 2}, .emission_texture = node(n)});
    const MeshPart left = quad_mesh({-2, 2, 0}, {1, 0, 0}, {0, 0, 1}, plain);
    scene.place(scene.add_mesh(left));
    scene.place(scene.add_mesh(quad_mesh({1, 2, 0}, {1, 0, 0}, {0, 0, 1}, painted)));
    return scene.finish();
}

TEST(PaintedLightChoice, FollowsTheEstimatedPower)
{
    SceneData scene = two_lamps(1);
    EXPECT_NEAR(share_of_painted(scene), mean_level() / (mean_level() + 1), 0.02);
    SceneData dark = two_lamps(0);
    EXPECT_NEAR(share_of_painted(dark), 1.0 / 65, 1e-3) << "dark where it was asked, still chosen";
}

TEST(PaintedLightChoice, WithoutACompilerItIsThatOfTheFactor)
{
    const char* chosen = std::getenv("DIPTYCH_CXX");
    const std::string before = chosen ? chosen : "";
    setenv("DIPTYCH_CXX", "/no/such/compiler", 1);
    SceneData scene = two_lamps(1);
    if (chosen)
        setenv("DIPTYCH_CXX", before.c_str(), 1);
    else
        unsetenv("DIPTYCH_CXX");
    EXPECT_NEAR(share_of_painted(scene), 0.5, 1e-6);
    ASSERT_FALSE(scene.notices.empty());
    EXPECT_NE(scene.notices.back().find("as if the textures gave 1"), std::string::npos)
        << scene.notices.back();
}

}  // namespace
