// What `explain` says is so: reasons where there are effects, and only there.
#include "host/commands/explain_command.hpp"

#include "host/commands/selftest_scenes.hpp"
#include "host/scene/scene_builder.hpp"

#include <gtest/gtest.h>

using namespace diptych;

namespace {

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(Explain, GivesAReasonForEveryEffectAndNoOther)
{
    for (const SelftestScene& scene : selftest_scenes())
        for (unsigned bit = 0; bit < 32; ++bit) {
            const bool is_there = (scene.scene.effects & 1u << bit) != 0;
            EXPECT_EQ(!reason_for(scene.scene, 1u << bit).empty(), is_there)
                << scene.name << ", effect " << bit;
        }
}

SceneData small_room()
{
    SceneBuilder scene;
    const int grey = scene.add_material({.name = "grey", .specular = 0});
    const int lamp = scene.add_material({.name = "lamp", .specular = 0, .emission = {4, 4, 4}});
    scene.add_material({.name = "unused gold", .metallic = 1});
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey)));
    scene.place(scene.add_mesh(quad_mesh({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
    scene.add_light({.kind = LIGHT_POINT, .position = {0, 1, 0}});
    scene.notice("mesh 3: lines are skipped");
    return scene.finish();
}

TEST(Explain, NamesMaterialsLightsStagesAndOmissions)
{
    const std::string text = explanation(small_room(), {});
    EXPECT_TRUE(has(text, "emissive surfaces: material lamp")) << text;
    EXPECT_TRUE(has(text, "point, spot and directional lights: 1 point light")) << text;
    EXPECT_FALSE(has(text, "gold")) << "nothing has that material";
    EXPECT_TRUE(has(text, "material lamp: 2 emissive triangles")) << text;
    EXPECT_TRUE(has(text, "mesh 3: lines are skipped")) << text;
    EXPECT_TRUE(has(text, "occlusion textures")) << text;
    EXPECT_TRUE(has(text, "sample_light      each surface, for EMISSION, PUNCTUAL_LIGHTS")) << text;
    EXPECT_TRUE(has(text, "triangles ")) << text;
}

TEST(Explain, SaysWhatIsSkippedWithoutLight)
{
    SceneBuilder scene;
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})));
    const std::string text = explanation(scene.finish(), {});
    EXPECT_TRUE(has(text, "sample_light      skipped")) << text;
    EXPECT_TRUE(has(text, "none: the picture is black")) << text;
}

// Shares add up: a light is chosen in proportion to its power.
TEST(Explain, GivesLightsTheirShareOfPower)
{
    SceneBuilder scene;
    scene.place(scene.add_mesh(quad_mesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})));
    scene.add_light({.kind = LIGHT_POINT, .intensity = {3, 3, 3}, .position = {0, 1, 0}});
    scene.add_light({.kind = LIGHT_POINT, .intensity = {1, 1, 1}, .position = {0, 2, 0}});
    const std::string text = explanation(scene.finish(), {});
    EXPECT_TRUE(has(text, " 75.0 %  point light at 0, 1, 0")) << text;
    EXPECT_TRUE(has(text, " 25.0 %  point light at 0, 2, 0")) << text;
}

}  // namespace
