// The stage that holds user code, on every backend: what it leaves is what the stages behind read.
#include "backends/textures/native_stage.hpp"
#include "common/textures/procedural.h"
#include "host/commands/trace_comparison.hpp"
#include "host/render/render.hpp"
#include "host/scene/texture_graph.hpp"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cmath>
#include <numbers>

namespace {

using namespace diptych;
using textures::handwritten;

TextureFunction constant_color(const std::string& id = "t0")
{
    return handwritten(
        id, {{"color", "float3"}, {"scale", "float"}},
        "    return TX_NEW(float4, color.x * scale, color.y * scale, color.z * scale,"
        " 1.0f);");
}

TextureFunction stripes(const std::string& id = "t1")
{
    return handwritten(id, {{"a", "float4"}, {"b", "float4"}, {"width", "float"}},
                       "    const float3 p = tx_attribute_WorldPos(tx);\n"
                       "    const float2 uv = tx_attribute_TexCoord0(tx);\n"
                       "    const float x = (p.x + 0.3f * p.y + uv.x) / width;\n"
                       "    const float t = x - math_floor(x);\n"
                       "    return TX_NEW(float4, a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t,\n"
                       "                  a.z + (b.z - a.z) * t, 1.0f);",
                       ATTRIBUTE_WorldPos | ATTRIBUTE_TexCoord0);
}

TextureInput numbers(std::vector<double> values) { return {.numbers = std::move(values)}; }
TextureUse node(int k)
{
    TextureUse use;
    use.node = k;
    return use;
}

// A furnace: a convex body of reflectance r in a uniform sky of radiance 1 looks like r.
SceneData furnace(SceneBuilder& scene, MaterialInput material)
{
    material.specular = 0;
    const int m = scene.add_material(material);
    scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, m)));
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 0.5);
    return laws::finish(scene);
}

class Textures : public laws::OnEachBackend {};

TEST_P(Textures, TX_1_ConstantColoursTheSurface)
{
    SceneBuilder scene;
    const int function = scene.add_texture_function(constant_color());
    const int n = scene.add_texture_node(
        {"grey", function, {{"color", numbers({0.5, 0.25, 1})}, {"scale", numbers({0.8})}}});
    const SceneData data = furnace(scene, {.base_texture = node(n)});
    EXPECT_TRUE(data.effects & EFFECT_PROCEDURAL);
    EXPECT_EQ(data.textures.outputs, 1);
    EXPECT_TRUE(laws::obeys(measure(data), 0.2));
}

// In a scene that has no image at all, too.
TEST_P(Textures, AnImageThatNobodyGaveIsWhite)
{
    SceneBuilder scene;
    const int function = scene.add_texture_function(
        handwritten("t0", {},
                    "    sam2D none = {0};\n"
                    "    return tx_sample(tx, none, TX_NEW(float2, 0.25f, 0.75f)) * 0.5f;"));
    const int n = scene.add_texture_node({"none", function, {}});
    const SceneData data = furnace(scene, {.base_texture = node(n)});
    EXPECT_TRUE(laws::obeys(measure(data), 0.5));
}

TEST_P(Textures, TX_5_OneCopyOfCodeHasARegionForEachUse)
{
    SceneBuilder scene;
    const int function = scene.add_texture_function(constant_color());
    const int dark = scene.add_texture_node(
        {"dark", function, {{"color", numbers({0.1, 0.1, 0.1})}, {"scale", numbers({1})}}});
    const int bright = scene.add_texture_node(
        {"bright", function, {{"color", numbers({0.9, 0.9, 0.9})}, {"scale", numbers({1})}}});
    const int a = scene.add_material({.specular = 0, .base_texture = node(dark)});
    const int b = scene.add_material({.specular = 0, .base_texture = node(bright)});
    scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}, a)));
    scene.place(scene.add_mesh(quad_mesh({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, b)));
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 0.5);
    const SceneData data = laws::finish(scene);
    EXPECT_EQ(data.textures.functions.size(), 1u);
    EXPECT_EQ(data.textures.attachments.size(), 2u);
    EXPECT_TRUE(laws::obeys(measure(data), 0.5));
}

// A mesh placed once lies in world space, one placed twice in its own: what a texture reads there
// is the same.
TEST_P(Textures, LocalPosIsThatOfTheMeshHoweverItIsPlaced)
{
    const Transform turned =
        translation(3, -2, 5) * rotation_about({0, 1, 0}, 0.5 * std::numbers::pi);
    for (const bool is_instance : {false, true}) {
        SceneBuilder scene;
        const int function = scene.add_texture_function(
            handwritten("t0", {},
                        "    const float3 p = tx_attribute_LocalPos(tx);\n"
                        "    const float x = p.x + 0.5f * p.y + 0.25f * p.z;\n"
                        "    return TX_NEW(float4, x, x, x, 1.0f);",
                        ATTRIBUTE_LocalPos));
        const int n = scene.add_texture_node({"place", function, {}});
        const int m = scene.add_material({.specular = 0, .base_texture = node(n)});
        const int mesh =
            scene.add_mesh(quad_mesh({0.2, 0.4, 0.8}, {0.001, 0, 0}, {0, 0.001, 0}, m));
        scene.place(mesh, turned);
        if (is_instance) scene.place(mesh, translation(0, 40, 0));
        scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
        const Vec3 middle = turned.point({0.2005, 0.4005, 0.8});
        laws::look(scene, middle + turned.vector({0, 0, 2}), middle, 1e-4);
        const SceneData data = laws::finish(scene);
        EXPECT_EQ((data.effects & EFFECT_INSTANCES) != 0, is_instance);
        EXPECT_TRUE(laws::obeys(measure(data), 0.2005 + 0.20025 + 0.2)) << is_instance;
    }
}

TEST_P(Textures, TX_7_NodesReadOtherNodes)
{
    SceneBuilder scene;
    const int color = scene.add_texture_function(constant_color("t0"));
    const int product = scene.add_texture_function(
        handwritten("t1", {{"a", "float4"}, {"b", "float"}},
                    "    return TX_NEW(float4, a.x * b, a.y * b, a.z * b, 1.0f);"));
    const int half = scene.add_texture_node(
        {"half", color, {{"color", numbers({0.5, 0.5, 0.5})}, {"scale", numbers({1})}}});
    const int twice =
        scene.add_texture_node({"twice", product, {{"a", {.node = half}}, {"b", {.node = half}}}});
    const SceneData data = furnace(scene, {.base_texture = node(twice)});
    EXPECT_EQ(data.textures.slots, 1);
    EXPECT_TRUE(laws::obeys(measure(data), 0.25));
}

// Every evaluation of node "counted" reads one element that is not there.
TEST_P(Textures, TX_7_ASharedNodeIsEvaluatedOnceAHit)
{
    SceneBuilder scene;
    const int counting = scene.add_texture_function(
        handwritten("t0", {{"level", "float"}},
                    "    const float x = level + (float)tx_index(tx, 3, 2) - 1.0f;\n"
                    "    return TX_NEW(float4, x, x, x, 1.0f);"));
    const int mean = scene.add_texture_function(
        handwritten("t1", {{"a", "float4"}, {"b", "float"}, {"c", "float3"}},
                    "    const float x = (a.x + b + c.x) / 3.0f;\n"
                    "    return TX_NEW(float4, x, x, x, 1.0f);"));
    const int counted = scene.add_texture_node({"counted", counting, {{"level", numbers({0.5})}}});
    const TextureInput shared{.node = counted};
    const int left =
        scene.add_texture_node({"left", mean, {{"a", shared}, {"b", shared}, {"c", shared}}});
    const int right = scene.add_texture_node(
        {"right", mean, {{"a", {.node = left}}, {"b", shared}, {"c", {.node = left}}}});
    SceneData data =
        furnace(scene, {.base_texture = node(right), .metallic_roughness_texture = node(counted)});
    data.settings[0].max_bounces = 0;
    backend_->upload(data);
    RenderOptions options;
    options.samples = 20;
    const RenderResult result = render(*backend_, data, options);
    const auto& faults = result.film.texture_faults().of_kind;
    EXPECT_EQ(faults[TEXTURE_FAULT_INDEX].count, 20u * 16 * 16);
    EXPECT_EQ(faults[TEXTURE_FAULT_NOT_FINITE].count, 0u);
    EXPECT_EQ(faults[TEXTURE_FAULT_BUDGET].count, 0u);
    EXPECT_EQ(faults[TEXTURE_FAULT_INDEX].first_sample, 0);
}

// The share of a cosine-distributed hemisphere that a wall of height 1 and width 2 takes, seen from
// the floor before its middle (the form factor of a perpendicular rectangle, twice).
double share_of_wall(double distance)
{
    const double r = std::sqrt(1 + distance * distance);
    return (std::atan(1 / distance) - distance / r * std::atan(1 / r)) / std::numbers::pi;
}

// Rays of the lower hemisphere meet nothing, and none does within less than the way to the wall.
TEST_P(Textures, TX_9_OcclusionIsTracedBeforeTheTextures)
{
    struct Case {
        Hemisphere hemisphere;
        double distance, open;
    };
    const double open = 1 - share_of_wall(0.2);
    for (const Case& wanted :
         {Case{Hemisphere::upper, 1e6, open}, Case{Hemisphere::lower, 1e6, 1},
          Case{Hemisphere::both, 1e6, (1 + open) / 2}, Case{Hemisphere::upper, 0.1, 1}}) {
        SceneBuilder scene;
        TextureFunction function =
            handwritten("t0", {{"reach", "float"}},
                        "    const float open = tx_occlusion(tx, 1) + 0.0f * tx_occlusion(tx, 0);\n"
                        "    return TX_NEW(float4, open, open, open, 1.0f);");
        OcclusionRequest constant, argument;
        constant.distance = 1;
        argument.distance_argument = 0;
        argument.hemisphere = wanted.hemisphere;
        function.occlusion = {constant, argument};
        const int n = scene.add_texture_node({"open",
                                              scene.add_texture_function(function),
                                              {{"reach", numbers({wanted.distance})}}});
        scene.set_textures({.occlusion_rays = 16});
        const int floor = scene.add_material({.base_color = {0, 0, 0, 1},
                                              .specular = 0,
                                              .emission = {1, 1, 1},
                                              .emission_texture = node(n)});
        const int wall = scene.add_material({.base_color = {0, 0, 0, 1}, .specular = 0});
        scene.place(scene.add_mesh(quad_mesh({0, 0, -1}, {0, 0, 2}, {0.4, 0, 0}, floor)));
        scene.place(scene.add_mesh(quad_mesh({0, 0, -1}, {0, 1, 0}, {0, 0, 2}, wall)));
        scene.set_camera(
            {.eye = {0.2, 1, 0}, .target = {0.2, 0, 0}, .up = {0, 0, 1}, .half_height = 0.01});
        scene.set_picture_size(16, 16);
        const SceneData data = laws::finish(scene, 0);
        EXPECT_TRUE(data.effects & EFFECT_TEXTURE_OCCLUSION);
        EXPECT_EQ(data.textures.occlusion_results, 2);
        EXPECT_TRUE(laws::obeys(measure(data), wanted.open)) << wanted.distance;
    }
}

// TX-4: ten thousand uses of one texture, each with its own values and an array of 4 KiB.
TEST_P(Textures, TX_4_AttachmentsAndArraysHaveNoLimit)
{
    SceneBuilder scene;
    TextureFunction function = handwritten("t0", {{"level", "float"}},
                                           "    return TX_NEW(float4, level, level, level, 1.0f);");
    function.arguments.push_back({"table", "float", true, 0});
    const int id = scene.add_texture_function(function);
    constexpr int count = 10000;
    std::vector<MeshPart> parts;
    std::vector<double> table(1024, 0.25);
    for (int k = 0; k < count; ++k) {
        const int n = scene.add_texture_node(
            {"node " + std::to_string(k),
             id,
             {{"level", numbers({k % 2 ? 0.2 : 0.6})}, {"table", numbers(table)}}});
        const int m = scene.add_material({.specular = 0, .base_texture = node(n)});
        parts.push_back(quad_mesh({-1 + 0.02 * (k % 100), -1 + 0.02 * (k / 100), 0}, {0.02, 0, 0},
                                  {0, 0.02, 0}, m));
    }
    scene.place(scene.add_mesh(std::move(parts)));
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 1);
    const SceneData data = laws::finish(scene);
    EXPECT_EQ(data.textures.attachments.size(), size_t(count));
    EXPECT_EQ(data.textures.functions.size(), 1u);
    EXPECT_TRUE(laws::obeys(measure(data), 0.4, 0.005));
}

ON_EACH_BACKEND(Textures);

// What finish() says of a graph, or nothing.
std::string refusal(const std::vector<TextureNode>& nodes, const MaterialInput& material)
{
    SceneBuilder scene;
    scene.add_texture_function(
        handwritten("t0", {{"a", "float4"}}, "    return TX_NEW(float4, a.x, a.y, a.z, a.w);"));
    for (const TextureNode& n : nodes) scene.add_texture_node(n);
    const int m = scene.add_material(material);
    scene.place(scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, m)));
    try {
        scene.finish();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(TextureGraph, TX_7_ACycleNamesItsNodes)
{
    const std::vector<TextureNode> nodes = {{"first", 0, {{"a", {.node = 1}}}},
                                            {"second", 0, {{"a", {.node = 2}}}},
                                            {"third", 0, {{"a", {.node = 1}}}}};
    EXPECT_EQ(refusal(nodes, {.base_texture = node(0)}),
              "texture nodes: second > third > second is a cycle; let one of them read something "
              "else");
}

TEST(TextureGraph, TX_7_ASharedNodeIsOneStepAndSlotsAreFreed)
{
    // A chain of ten with the first node read by all: two values live at once.
    std::vector<TextureNode> nodes = {{"start", 0, {{"a", {.numbers = {1, 1, 1, 1}}}}}};
    for (int k = 1; k < 10; ++k)
        nodes.push_back(
            {"node " + std::to_string(k), 0, {{"a", {.node = k - 1}}, {"b", {.node = 0}}}});
    const GraphProgram program = texture_order(nodes, {9});
    ASSERT_EQ(program.steps.size(), 10u);
    for (int k = 0; k < 10; ++k) EXPECT_EQ(program.steps[size_t(k)].node, k);
    EXPECT_EQ(program.slots, 2);
    EXPECT_EQ(program.steps[9].slot, -1) << "nobody reads the last";
}

TEST(TextureGraph, WrongArgumentsAreNamed)
{
    const MaterialInput material{.base_texture = node(0)};
    EXPECT_EQ(
        refusal({{"n", 0, {}}}, material),
        "texture node n: its argument float4 a is missing; give it a value: --set n.a=JSON, in "
        "the scene, or as a default in the file's comment");
    EXPECT_EQ(refusal({{"n", 0, {{"a", {.numbers = {1, 2}}}}}}, material),
              "texture node n: its argument a is of type float4, but has 2 numbers; give it 4");
    EXPECT_EQ(refusal({{"n", 0, {{"b", {.numbers = {1}}}}}}, material),
              "texture node n: userProc has no argument b; it takes: float4 a");
}

// Something of everything that the stage can be asked for.
SceneData busy_textures()
{
    SceneBuilder scene;
    const int color = scene.add_texture_function(constant_color("t0"));
    const int striped = scene.add_texture_function(stripes("t1"));
    const int sampled = scene.add_texture_function(
        handwritten("t2", {{"image", "sam2D"}, {"tint", "float4"}},
                    "    const float2 dx = tx_attribute_TexCoord0Dx(tx);\n"
                    "    const float2 dy = tx_attribute_TexCoord0Dy(tx);\n"
                    "    float2 uv = tx_attribute_TexCoord0(tx);\n"
                    "    uv.x += 3.0f * dx.x - 5.0f * dy.x;\n"
                    "    uv.y += 3.0f * dy.y - 5.0f * dx.y;\n"
                    "    const float4 c = tx_sample(tx, image, uv);\n"
                    "    const float3 n = tx_attribute_Normal(tx);\n"
                    "    const float3 t = tx_attribute_Tangent(tx);\n"
                    "    return TX_NEW(float4, c.x * tint.x, c.y * tint.y + 0.1f * math_abs(n.y),\n"
                    "                  c.z * tint.z + 0.1f * math_abs(t.x), 0.5f + 0.5f * n.z);",
                    ATTRIBUTE_TexCoord0 | ATTRIBUTE_Normal | ATTRIBUTE_Tangent |
                        ATTRIBUTE_TexCoord0Dx | ATTRIBUTE_TexCoord0Dy));
    Picture checks{4, 4, {}, {}, true, 0};
    for (int k = 0; k < 16; ++k) {
        const std::uint8_t value = (k + k / 4) % 2 ? 220 : 60;
        checks.bytes.insert(checks.bytes.end(), {value, 128, value, 255});
    }
    TextureUse image;
    image.image = scene.add_image(checks);
    const int red = scene.add_texture_node(
        {"red", color, {{"color", numbers({0.8, 0.1, 0.1})}, {"scale", numbers({0.9})}}});
    const int bands = scene.add_texture_node(
        {"bands",
         striped,
         {{"a", {.node = red}}, {"b", numbers({0.1, 0.2, 0.9, 1})}, {"width", numbers({0.25})}}});
    const int tinted = scene.add_texture_node(
        {"tinted", sampled, {{"image", {.images = {image}}}, {"tint", {.node = bands}}}});
    const int floor = scene.add_material({.roughness = 0.4f, .base_texture = node(tinted)});
    const int wall = scene.add_material({.specular = 0, .base_texture = node(bands)});
    const int metal = scene.add_material({.metallic = 1,
                                          .roughness = 0.6f,
                                          .base_texture = node(bands),
                                          .metallic_roughness_texture = node(tinted),
                                          .normal_texture = node(tinted)});
    const int veil = scene.add_material(
        {.specular = 0, .alpha_mode = ALPHA_BLEND, .base_texture = node(tinted)});
    const int lamp = scene.add_material({.emission = {5, 4, 3}});
    const int glow = scene.add_material(
        {.specular = 0, .emission = {0.5f, 0.5f, 0.5f}, .emission_texture = node(bands)});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, wall)));
    scene.place(scene.add_mesh(quad_mesh({-1.5, 0.1, -1.5}, {1, 0, 0}, {0, 1, 0}, glow)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 0.1, 0.8}, {1.5, 0, 0}, {0, 0.8, 0}, veil)));
    scene.place(scene.add_mesh(quad_mesh({-0.6, 1.2, -0.6}, {1.2, 0, 0}, {0, 0, 1.2}, veil)));
    const int ball = scene.add_mesh(sphere_mesh({0, 0, 0}, 0.3, 24, metal));
    for (int k = 0; k < 4; ++k) scene.place(ball, translation(0.7 * k - 1, 0.3, -0.2 * k));
    scene.set_camera({.eye = {0.5, 1.2, 3}, .target = {0, 0.4, 0}});
    scene.set_picture_size(32, 32);
    SceneData data = scene.finish();
    data.settings[0].max_bounces = 4;
    return data;
}

void expect_parity(const std::string& a, const std::string& b, const Bound& bound, double share)
{
    SceneData scene = busy_textures(), other = scene;
    std::unique_ptr<Backend> first, second;
    try {
        first = make_backend(a, {}), second = make_backend(b, {});
    } catch (const std::runtime_error& error) {
        GTEST_SKIP() << error.what();
    }
    first->upload(scene);
    second->upload(other);
    const std::vector<WorkItem> items{{8, 8, 0, 0}};
    const Dispatch dispatch{items, 8};
    const TraceComparison result = compare_traces(*first, *second, scene.effects, dispatch, bound);
    int parted = 0;
    for (const char has : result.has_parted) parted += has ? 1 : 0;
    EXPECT_LE(parted, share * dispatch.paths());
    if (result.first && parted > share * dispatch.paths())
        ADD_FAILURE() << "first in " << stage_names[result.first->stage] << ", bounce "
                      << result.first->bounce << ", path " << result.first->path << ", "
                      << result.first->buffer << ": " << result.first->a << " and "
                      << result.first->b;
}

TEST(TextureParity, OpenclHasTheTwinsBits) { expect_parity("twin", "opencl", {}, 0); }

TEST(TextureParity, VectorLanesFollowTheTwin)
{
    expect_parity("twin", "cpu", {.ulps = 0, .relative = 0}, 0.001);
}

TEST(TextureParity, DoubleFollowsTheTwin)
{
    expect_parity("twin", "double", {.ulps = 0, .relative = 2e-2}, 0.05);
}

TEST(TextureParity, DebugTexturesHaveTheSameBits)
{
    SceneData scene = busy_textures();
    std::vector<std::vector<float>> pictures;
    for (const bool is_debug : {false, true}) {
        BackendOptions options;
        options.debug_textures = is_debug;
        const std::unique_ptr<Backend> twin = make_backend("twin", options);
        twin->upload(scene);
        RenderOptions render_options;
        render_options.samples = 4;
        pictures.push_back(
            image::beauty_of(render(*twin, scene, render_options).film.picture()).pixels);
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

// TX-3: another argument is other bytes: nothing is compiled.
TEST(TextureArguments, TX_3_ChangingOneCompilesNothing)
{
    const auto with = [](double grey) {
        SceneBuilder scene;
        const int function = scene.add_texture_function(constant_color());
        const int n = scene.add_texture_node(
            {"grey", function, {{"color", numbers({grey, grey, grey})}, {"scale", numbers({1})}}});
        return furnace(scene, {.base_texture = node(n)});
    };
    for (const char* name : {"cpu", "twin", "opencl"}) {
        std::unique_ptr<Backend> backend;
        try {
            backend = make_backend(name, {});
        } catch (const std::runtime_error&) {
            continue;
        }
        SceneData first = with(0.25), second = with(0.75);
        EXPECT_TRUE(laws::obeys(laws::measure(*backend, first), 0.25)) << name;
        const unsigned long before = texture_compilations();
        EXPECT_TRUE(laws::obeys(laws::measure(*backend, second), 0.75)) << name;
        EXPECT_EQ(texture_compilations(), before) << name;
    }
}

}  // namespace
