// Occlusion whose distance another node gives, on every backend: that node runs before the rays.
#include "common/textures/procedural.h"
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using namespace diptych;
using textures::handwritten;

TextureInput numbers(std::vector<double> values) { return {.numbers = std::move(values)}; }

// Asks for occlusion as far as its argument says, and shows how open the place is.
TextureFunction open_within(const std::string& id)
{
    TextureFunction function =
        handwritten(id, {{"reach", "float"}},
                    "    const float open = tx_occlusion(tx, 0) + 0.0f * reach;\n"
                    "    return TX_NEW(float4, open, open, open, 1.0f);");
    OcclusionRequest request;
    request.distance_argument = 0;
    function.occlusion = {request};
    return function;
}

TextureFunction given(const std::string& id)
{
    return handwritten(id, {{"value", "float"}},
                       "    return TX_NEW(float4, value, value, value, 1.0f);");
}

// One distance where z is below zero, another above.
TextureFunction halves(const std::string& id)
{
    return handwritten(id, {{"below", "float"}, {"above", "float"}},
                       "    const float z = tx_attribute_WorldPos(tx).z;\n"
                       "    const float d = z < 0.0f ? below : above;\n"
                       "    return TX_NEW(float4, d, 0.0f, 0.0f, 1.0f);",
                       ATTRIBUTE_WorldPos);
}

// A floor that shows node `shown` as light, before a wall at x = 0; seen from above about
// (0.2, 0, z). As TX-9 has it.
SceneData floor_and_wall(SceneBuilder& scene, int shown, double z, float base = 0)
{
    TextureUse use;
    use.node = shown;
    scene.set_textures({.occlusion_rays = 16});
    const int floor = scene.add_material({.base_color = {base, base, base, 1},
                                          .specular = 0,
                                          .emission = {1, 1, 1},
                                          .emission_texture = use});
    const int wall = scene.add_material({.base_color = {base, base, base, 1}, .specular = 0});
    scene.place(scene.add_mesh(quad_mesh({0, 0, -1}, {0, 0, 2}, {0.4, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({0, 0, -1}, {0, 1, 0}, {0, 0, 2}, wall)));
    scene.set_camera(
        {.eye = {0.2, 1, z}, .target = {0.2, 0, z}, .up = {0, 0, 1}, .half_height = 0.01});
    scene.set_picture_size(16, 16);
    return laws::finish(scene, base > 0 ? 3 : 0);
}

// What the floor sees of the wall, cosine-weighted: a rectangle that stands at its edge.
double share_of_wall(double distance)
{
    const double r = std::sqrt(1 + distance * distance);
    return (std::atan(1 / distance) - distance / r * std::atan(1 / r)) / std::numbers::pi;
}

class OcclusionDistances : public laws::OnEachBackend {
protected:
    // Beauty of a few samples.
    std::vector<float> picture(SceneData data)
    {
        backend_->upload(data);
        RenderOptions options;
        options.samples = 8;
        return image::beauty_of(render(*backend_, data, options).film.picture()).pixels;
    }
};

TEST_P(OcclusionDistances, AConstantNodeIsTheConstantBitForBit)
{
    std::vector<std::vector<float>> pictures;
    // the number itself; a node; a node behind a node, of which occlusion has a second use; and
    // what is not above zero stands for the scene's default, as in an argument
    for (const auto& [nodes, distance] :
         std::vector<std::pair<int, double>>{{0, 0.25}, {1, 0.25}, {2, 0.25}, {0, -1}, {1, -1}}) {
        SceneBuilder scene;
        const int asks = scene.add_texture_function(open_within("t0"));
        const int gives = scene.add_texture_function(given("t1"));
        TextureInput reach = numbers({distance});
        for (int k = 0; k < nodes; ++k)
            reach = {.node = scene.add_texture_node(
                         {"gives " + std::to_string(k), gives, {{"value", reach}}})};
        const int open = scene.add_texture_node({"open", asks, {{"reach", reach}}});
        // bounces, light sampling of the painted floor: records ask as well
        const SceneData data = floor_and_wall(scene, open, 0, 0.5f);
        EXPECT_EQ((data.effects & EFFECT_OCCLUSION_DISTANCE) != 0, nodes > 0);
        EXPECT_EQ(data.textures.distances, nodes > 0 ? 1 : 0);
        EXPECT_TRUE(data.effects & EFFECT_PROCEDURAL_EMISSION);
        pictures.push_back(picture(data));
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_EQ(pictures[0], pictures[2]);
    EXPECT_EQ(pictures[3], pictures[4]);
    EXPECT_NE(pictures[0], pictures[3]);
}

struct OpenByHalves {
    int half;   // gives the distance
    int shown;  // is open as far as it says
};

OpenByHalves open_by_halves(SceneBuilder& scene, double below, double above)
{
    const int asks = scene.add_texture_function(open_within("t0"));
    const int gives = scene.add_texture_function(halves("t1"));
    const int half = scene.add_texture_node(
        {"half", gives, {{"below", numbers({below})}, {"above", numbers({above})}}});
    return {half, scene.add_texture_node({"open", asks, {{"reach", {.node = half}}}})};
}

// Nothing is nearer than the wall; within any distance of the other half, all of it counts.
TEST_P(OcclusionDistances, FollowTheNodeFromPlaceToPlace)
{
    const double open = 1 - share_of_wall(0.2);
    for (const auto& [z, truth] : {std::pair{-0.012, 1.0}, std::pair{0.012, open}}) {
        SceneBuilder scene;
        const int shown = open_by_halves(scene, 0.1, 1e6).shown;
        EXPECT_TRUE(laws::obeys(measure(floor_and_wall(scene, shown, z)), truth)) << z;
    }
}

// The same node as a layer of the picture: asked aside, with a program of its own.
TEST_P(OcclusionDistances, AreTheSameInALayer)
{
    SceneBuilder scene;
    const auto [half, shown] = open_by_halves(scene, 0.1, 1e6);
    scene.add_aov(shown);
    scene.add_aov(half);
    SceneData data = floor_and_wall(scene, shown, 0);
    backend_->upload(data);
    RenderOptions options;
    options.samples = 8;
    const image::Picture picture = render(*backend_, data, options).film.picture();
    const std::vector<float>& beauty = image::beauty_of(picture).pixels;
    const image::Layer* open = image::find_layer(picture, "aov.open");
    ASSERT_TRUE(open && image::find_layer(picture, "aov.half"));
    std::vector<float> layer;
    for (size_t p = 0; p < open->pixels.size(); p += 4) {
        layer.push_back(open->pixels[p]);
        EXPECT_EQ(open->pixels[p], beauty[p]) << "emission 1 times the node";
    }
    EXPECT_GT(*std::max_element(layer.begin(), layer.end()),
              *std::min_element(layer.begin(), layer.end()));
}

ON_EACH_BACKEND(OcclusionDistances);

TEST(OcclusionDistanceParity, OpenclHasTheTwinsBits)
{
    std::vector<std::vector<float>> pictures;
    for (const char* name : {"twin", "opencl"}) {
        std::unique_ptr<Backend> backend;
        try {
            backend = make_backend(name, {});
        } catch (const std::runtime_error& error) {
            GTEST_SKIP() << error.what();
        }
        SceneBuilder scene;
        const int shown = open_by_halves(scene, 0.3, 1).shown;
        SceneData data = floor_and_wall(scene, shown, 0, 0.5f);
        backend->upload(data);
        RenderOptions options;
        options.samples = 8;
        pictures.push_back(image::beauty_of(render(*backend, data, options).film.picture()).pixels);
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

// What finish() says of occlusion that reaches as far as `reach` says.
std::string refusal(bool is_behind_another)
{
    SceneBuilder scene;
    const int asks = scene.add_texture_function(open_within("t0"));
    const int gives = scene.add_texture_function(given("t1"));
    int reach = scene.add_texture_node({"inner", asks, {{"reach", numbers({1})}}});
    if (is_behind_another)
        reach = scene.add_texture_node({"between", gives, {{"value", {.node = reach}}}});
    const int outer = scene.add_texture_node({"outer", asks, {{"reach", {.node = reach}}}});
    try {
        floor_and_wall(scene, outer, 0);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(OcclusionDistanceGraph, ANodeThatAsksForOcclusionItselfIsNamed)
{
    EXPECT_EQ(refusal(false), "texture node outer: the distance of its occlusion, reach, comes "
                              "from node inner, which asks for occlusion itself; let it come from "
                              "nodes that do not");
    EXPECT_EQ(refusal(true), "texture node outer: the distance of its occlusion, reach, comes "
                             "from node between, which reads node inner, which asks for occlusion "
                             "itself; let it come from nodes that do not");
}

}  // namespace
