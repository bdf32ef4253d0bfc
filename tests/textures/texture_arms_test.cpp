// The arms of the textures' study are other ways to the same picture.
#include "backends/textures/texture_arms.hpp"
#include "common/textures/procedural.h"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cstring>

namespace {

using namespace diptych;
using textures::handwritten;

TextureInput numbers(std::vector<double> values) { return {.numbers = std::move(values)}; }
TextureUse node(int k)
{
    TextureUse use;
    use.node = k;
    return use;
}

// The second element of an array.
TextureFunction from_table()
{
    TextureFunction function;
    function.id = "t2";
    function.file = "t2.c";
    function.entry = "second";
    function.arguments = {{"table", "float3", true, 0}};
    const auto text = [](const std::string& name) {
        return "SHARED float4 " + name +
               "(TextureContext* tx, tx_view_float3 table)\n{\n"
               "    const float3 v = tx_at_float3(tx, table, 1);\n"
               "    return TX_NEW(float4, v.x, v.y, v.z, 1.0f);\n}\n"
               "SHARED float4 t2_entry(TextureContext* tx, int region)\n{\n    return " +
               name + "(tx,\n        tx_argument_view_float3(tx, region, 0));\n}\n";
    };
    function.cpp = "namespace t2 {\n" + text("second") + "}\n";
    function.opencl = text("t2_second");
    return function;
}

// A floor before a wall: occlusion of two kinds, a node that two others read, an array, an image,
// two results of one material and a second material with the same nodes and other values.
SceneData corner()
{
    SceneBuilder scene;
    TextureFunction open =
        handwritten("t0", {{"reach", "float"}},
                    "    const float a = tx_occlusion(tx, 0), b = tx_occlusion(tx, 1);\n"
                    "    return TX_NEW(float4, a, b, 0.5f * (a + b), 1.0f);");
    OcclusionRequest near, both;
    near.distance_argument = 0;
    both.distance = 0.7;
    both.hemisphere = Hemisphere::both;
    both.is_same_object = true;
    open.occlusion = {near, both};
    const TextureFunction mixed = handwritten(
        "t1", {{"a", "float3"}, {"b", "float4"}, {"image", "sam2D"}, {"amount", "float"}},
        "    const float4 c = tx_sample(tx, image, tx_attribute_TexCoord0(tx));\n"
        "    return TX_NEW(float4, a.x * amount + c.x * b.y, a.y * b.z, c.z * amount, 1.0f);",
        ATTRIBUTE_TexCoord0);
    const int open_function = scene.add_texture_function(open);
    const int mixed_function = scene.add_texture_function(mixed);
    const int table_function = scene.add_texture_function(from_table());
    const Picture checks{
        2,  2,    {220, 128, 200, 255, 60, 128, 200, 255, 90, 128, 200, 255, 180, 128, 200, 255},
        {}, true, 0};
    TextureUse image;
    image.image = scene.add_image(checks);
    int materials[2];
    for (int k = 0; k < 2; ++k) {
        const int opened =
            scene.add_texture_node({"open", open_function, {{"reach", numbers({0.4 + 0.3 * k})}}});
        const int table = scene.add_texture_node(
            {"table", table_function, {{"table", numbers({1, 1, 1, 0.8, 0.5, 0.2 + 0.1 * k})}}});
        const int both_ways = scene.add_texture_node({"mixed",
                                                      mixed_function,
                                                      {{"a", {.node = table}},
                                                       {"b", {.node = opened}},
                                                       {"image", {.images = {image}}},
                                                       {"amount", {.node = opened}}}});
        materials[k] = scene.add_material({.specular = 0,
                                           .emission = {0.2f, 0.2f, 0.2f},
                                           .base_texture = node(both_ways),
                                           .emission_texture = node(opened)});
    }
    scene.set_textures({.occlusion_rays = 5});
    scene.place(scene.add_mesh(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, materials[0])));
    scene.place(scene.add_mesh(quad_mesh({-1, 0, -1}, {2, 0, 0}, {0, 1, 0}, materials[1])));
    scene.set_environment(laws::environment_of([](const Vec3& d) { return 1 + 0.5 * d[1]; }));
    laws::look(scene, {1, 2, 3}, {0, 0.3, 0}, 1);
    return laws::finish(scene, 3);
}

Results rendered(Backend& backend, TextureArm arm)
{
    SceneData scene = corner();
    make_texture_arm(scene, arm);
    backend.upload(scene);
    Results results;
    const std::vector<WorkItem> items{{0, 0, 0, 0}};
    backend.render({items, QUANTUM}, results);
    return results;
}

size_t differing(const std::vector<float>& a, const std::vector<float>& b)
{
    size_t count = 0;
    for (size_t k = 0; k < a.size(); ++k)
        count += std::memcmp(&a[k], &b[k], sizeof a[k]) != 0 ? 1 : 0;
    return count;
}

class TextureArms : public laws::OnEachBackend {};

TEST_P(TextureArms, TX_8_TX_9_GiveTheSamePicture)
{
    const Results ours = rendered(*backend_, {});
    for (const TextureArm arm :
         {TextureArm{true, false}, TextureArm{false, true}, TextureArm{true, true}}) {
        const Results other = rendered(*backend_, arm);
        ASSERT_EQ(ours.sum_radiance.size(), other.sum_radiance.size());
        EXPECT_EQ(differing(ours.sum_radiance, other.sum_radiance), 0u)
            << arm.pastes_arguments << arm.traces_inside;
    }
}

ON_EACH_BACKEND(TextureArms);

TEST(TextureArm, TX_8_PastesTheValuesAndKeepsTheStageBeforeOut)
{
    SceneData scene = corner();
    make_texture_arm(scene, {true, true});
    EXPECT_FALSE(scene.effects & EFFECT_TEXTURE_OCCLUSION);
    EXPECT_EQ(scene.textures.functions.size(), 6u)
        << "two results of two materials, and the light of each as a lamp";
    for (const TextureFunction& function : scene.textures.functions) {
        EXPECT_TRUE(function.arguments.empty());
        EXPECT_EQ(function.opencl.find("tx_argument_float(tx, region, 0)",
                                       function.opencl.find(function.id + "_entry")),
                  std::string::npos);
    }
}

}  // namespace
