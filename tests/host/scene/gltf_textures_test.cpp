// The extension DIPTYCH_procedural_texture from files: every kind of argument arrives, and whatever
// else stands there is refused with its place.
#include "backends/textures/texture_tool.hpp"
#include "host/scene/load.hpp"
#include "host/scene/texture_arguments.hpp"
#include "tests/host/scene/gltf_text.hpp"

#include <bit>

namespace {

using namespace diptych;
using nlohmann::json;

const std::string all_kinds = R"(
// amount (float; default 0.75): what the file says where the node is silent
float4 userProc(float scale, int count, uint flags, float2 shift, float3 tint, float4 edge, int2 cells,
                float amount, float inner, const float* ramp, const float3* colors, sam2D image)
{
    float x = scale + count + flags + shift.x + edge.w + cells.y + amount + inner + ramp[0] + colors[0].x;
    return tex2D(image, (float2)(x, 0.5f)) * to_float4(tint, 1.0f);
}
)";
const std::string one_number = "float3 level(float value) { return (float3)(value); }\n";

// A file with a node "paint" that has everything, and one that it reads.
GltfText textured()
{
    GltfText gltf;
    gltf.add_triangle()["material"] = 0;
    gltf.document["images"] = {
        {{"uri",
          "data:image/png;base64,"
          "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5E"
          "rkJggg=="}}};
    gltf.document["textures"] = {{{"source", 0}}};
    gltf.document["extensionsUsed"] = {"DIPTYCH_procedural_texture"};
    gltf.document["extensions"]["DIPTYCH_procedural_texture"] = json::parse(R"({
        "sources": [{"uri": "paint.c"}, {"uri": "sub%20folder/level.c", "name": "a level"}],
        "nodes": [
            {"name": "level", "source": 1, "function": "level", "arguments": {"value": 0.5}},
            {"name": "paint", "source": 0, "arguments": {
                "scale": 2.5, "count": -3, "flags": true, "shift": [0.25, 4], "tint": [1, 2, 3],
                "edge": [1, 2, 3, 4], "cells": [7, -8], "inner": {"node": "level"},
                "ramp": [0, 0.5, 1, 1.5, 2], "colors": [[1, 2, 3], [4, 5, 6]],
                "image": {"texture": 0, "colorSpace": "linear"}}}],
        "occlusionRays": 8, "occlusionDistance": 2, "time": 1.5})");
    gltf.document["materials"] = {
        {{"name", "wall"},
         {"extensions",
          {{"DIPTYCH_procedural_texture", {{"baseColorTexture", {{"node", "paint"}}}}}}}}};
    return gltf;
}

json& extension(GltfText& gltf)
{
    return gltf.document["extensions"]["DIPTYCH_procedural_texture"];
}

SceneData load(const GltfText& gltf, const LoadOptions& options = {})
{
    write_file("paint.c", all_kinds);
    write_file("sub folder/level.c", one_number);
    return load_scene(gltf.write(), options);
}

// Words of an argument of the attachment of a node.
std::vector<uint> words_of(const SceneData& scene, const std::string& node, size_t argument)
{
    const auto* words = reinterpret_cast<const uint*>(scene.materials.data());
    for (const TextureAttachment& use : scene.textures.attachments) {
        if (use.node != node) continue;
        const TextureFunction& function = scene.textures.functions[size_t(use.function)];
        const size_t at = size_t(use.first_word) + 4 * argument;
        if (int(words[at]) >= 0) return {};  // from another node
        const size_t count = words[at + 2] * size_t(stride_of(function.arguments.at(argument)));
        return {words + words[at + 1], words + words[at + 1] + count};
    }
    ADD_FAILURE() << "no use of " << node;
    return {};
}

std::vector<uint> bits(const std::vector<float>& values)
{
    std::vector<uint> words;
    for (const float value : values) words.push_back(std::bit_cast<uint>(value));
    return words;
}

// Where no image reads them, textures still do; and a function may have no arguments at all.
TEST(GltfTextures, MeshesKeepTheCoordinatesThatTexturesAskFor)
{
    GltfText gltf;
    json& primitive = gltf.add_triangle();
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] =
        gltf.add_accessor(std::vector<float>{0, 0, 0.25f, 0, 0.25f, 0.75f}, "VEC2", 5126, 3);
    gltf.document["materials"] = {{{"name", "wall"}}};
    write_file("where.c", "float2 place() { float2 uv = readAttr(\"TexCoord0\"); return uv; }\n");
    LoadOptions options;
    options.textures = {"wall.baseColor=" + (test_folder() / "where.c").string()};
    const SceneData scene = load_scene(gltf.write(), options);
    EXPECT_EQ(scene.settings.at(0).texture_uv_set[0], 0);
    ASSERT_EQ(scene.uvs.size(), 3u);
    EXPECT_EQ(scene.uvs[2].x, 0.25f);
    EXPECT_EQ(scene.uvs[2].y, 0.75f);
}

// As users call them: by name alone, all arguments by their defaults.
TEST(GltfTextures, EveryTextureOfTheLibraryNeedsItsNameAlone)
{
    GltfText gltf;
    gltf.add_triangle()["material"] = 0;
    gltf.document["materials"] = {{{"name", "wall"}}};
    const std::string path = gltf.write();
    int textures = 0;
    for (const auto& file :
         std::filesystem::directory_iterator(library_texture("rust").parent_path())) {
        if (file.path().extension() != ".c") continue;
        SCOPED_TRACE(file.path().stem());
        LoadOptions options;
        options.textures = {"wall.baseColor=" + file.path().stem().string()};
        EXPECT_NO_THROW(load_scene(path, options));
        ++textures;
    }
    EXPECT_EQ(textures, 19);
}

TEST(GltfTextures, DefaultsStandInCommentsOfAnyForm)
{
    GltfText gltf;
    gltf.add_triangle()["material"] = 0;
    gltf.document["materials"] = {{{"name", "wall"}}};
    write_file("sum.c", "// a (float; default 2)\n"
                        "/* b (float; default 3): of a block */\n"
                        "/*\n * c (float; default 4)\n */\n"
                        "// d (float; default 5): the usual form\n"
                        "float4 sum(float a, float b, float c, float d)\n"
                        "{\n    return (float4)(a, b, c, d);\n}\n");
    LoadOptions options;
    options.textures = {"wall.baseColor=" + (test_folder() / "sum.c").string()};
    const SceneData scene = load_scene(gltf.write(), options);
    for (size_t k = 0; k < 4; ++k) EXPECT_EQ(words_of(scene, "sum", k), bits({float(k + 2)})) << k;
}

TEST(GltfTextures, EveryKindOfArgumentArrives)
{
    const SceneData scene = load(textured());
    EXPECT_EQ(words_of(scene, "paint", 0), bits({2.5f}));
    EXPECT_EQ(words_of(scene, "paint", 1), std::vector<uint>{uint(-3)});
    EXPECT_EQ(words_of(scene, "paint", 2), std::vector<uint>{1u});
    EXPECT_EQ(words_of(scene, "paint", 3), bits({0.25f, 4}));
    EXPECT_EQ(words_of(scene, "paint", 4), bits({1, 2, 3, 0}));
    EXPECT_EQ(words_of(scene, "paint", 5), bits({1, 2, 3, 4}));
    EXPECT_EQ(words_of(scene, "paint", 6), (std::vector<uint>{7u, uint(-8)}));
    EXPECT_EQ(words_of(scene, "paint", 7), bits({0.75f})) << "the file's default";
    EXPECT_EQ(words_of(scene, "paint", 8), std::vector<uint>{}) << "another node's result";
    EXPECT_EQ(words_of(scene, "paint", 9), bits({0, 0.5f, 1, 1.5f, 2}));
    EXPECT_EQ(words_of(scene, "paint", 10), bits({1, 2, 3, 0, 4, 5, 6, 0}));
    const std::vector<uint> image = words_of(scene, "paint", 11);
    ASSERT_EQ(image.size(), 1u);
    const Image& texels = scene.images[size_t(scene.texture_slots[image[0]].image)];
    EXPECT_EQ(texels.encoding, TEXELS_8_LINEAR);
    EXPECT_EQ(words_of(scene, "level", 0), bits({0.5f}));
    EXPECT_EQ(scene.settings[0].occlusion_rays, 8);
    EXPECT_EQ(scene.settings[0].time, 1.5f);
    EXPECT_EQ(scene.textures.nodes[1].values.at("shift"), "[0.25,4]");
}

TEST(GltfTextures, TheCommandLineComesLast)
{
    LoadOptions options;
    options.texture_values = {"paint.scale=4", "paint.scale=5", "level.value=[1]"};
    const SceneData scene = load(textured(), options);
    EXPECT_EQ(words_of(scene, "paint", 0), bits({5}));
    EXPECT_EQ(words_of(scene, "level", 0), bits({1}));
}

struct Hostile {
    const char* name;
    std::function<void(json&)> edit;  // of the extension
    const char* said;
};

json numbers(size_t count) { return json(std::vector<double>(count, 1.0)); }

const Hostile hostile[] = {
    {"extension is a number", [](json& e) { e = 3; }, "must be an object"},
    {"extension is a list",
     [](json& e) {
         e = {1, 2};
     },
     "must be an object"},
    {"unknown property", [](json& e) { e["rays"] = 3; }, "has no property rays; it may have: "},
    {"sources is an object", [](json& e) { e["sources"] = json::object(); },
     ".sources: must be an array"},
    {"source is text", [](json& e) { e["sources"][0] = "paint.c"; },
     ".sources[0]: must be an object"},
    {"source without file", [](json& e) { e["sources"][0] = json::object(); },
     ".sources[0]: must have either a uri or a library"},
    {"source with two files", [](json& e) { e["sources"][0]["library"] = "rust"; },
     ".sources[0]: must have either a uri or a library"},
    {"uri is a number", [](json& e) { e["sources"][0]["uri"] = 7; },
     ".sources[0].uri: must be a string"},
    {"file is missing", [](json& e) { e["sources"][0]["uri"] = "absent.c"; }, "absent.c"},
    {"file outside", [](json& e) { e["sources"][0]["uri"] = "../../paint.c"; },
     "leaves the scene's folder; pass --allow-outside"},
    {"absolute file", [](json& e) { e["sources"][0]["uri"] = "/etc/passwd"; },
     "leaves the scene's folder"},
    {"a folder", [](json& e) { e["sources"][0]["uri"] = "sub%20folder"; }, "sub%20folder"},
    {"from the network", [](json& e) { e["sources"][0]["uri"] = "https://example.com/a.c"; },
     "example.com"},
    {"unknown library",
     [](json& e) {
         e["sources"][0] = {{"library", "velvet"}};
     },
     "the library has no texture velvet"},
    {"library is a path",
     [](json& e) {
         e["sources"][0] = {{"library", "../rust"}};
     },
     "the library has no texture ../rust"},
    {"nodes is text", [](json& e) { e["nodes"] = "paint"; }, ".nodes: must be an array"},
    {"node is null", [](json& e) { e["nodes"][1] = nullptr; }, ".nodes[1]: must be an object"},
    {"node without source", [](json& e) { e["nodes"][1].erase("source"); },
     ".nodes[1].source: must name one of the 2 sources"},
    {"source out of range", [](json& e) { e["nodes"][1]["source"] = 2; },
     ".nodes[1].source: must name one of the 2 sources"},
    {"source is negative", [](json& e) { e["nodes"][1]["source"] = -1; },
     ".nodes[1].source: must name one of the 2 sources"},
    {"name is a number", [](json& e) { e["nodes"][1]["name"] = 5; },
     ".nodes[1].name: must be a string"},
    {"two nodes of one name", [](json& e) { e["nodes"][1]["name"] = "level"; },
     "DIPTYCH_procedural_texture.nodes[1].name: level is the name of nodes[0] too; give one of "
     "them "
     "another"},
    {"a name that another has for want of one",
     [](json& e) {
         e["nodes"][1]["name"] = "node 0";
         e["nodes"][0].erase("name");
         e["nodes"][1]["arguments"]["inner"] = {{"node", 0}};
     },
     "DIPTYCH_procedural_texture.nodes[1].name: node 0 is the name of nodes[0] too; give one of "
     "them another"},
    {"unknown function", [](json& e) { e["nodes"][1]["function"] = "absent"; }, "absent"},
    {"function is an injection", [](json& e) { e["nodes"][1]["function"] = "a; system(\"true\")"; },
     "texture node paint"},
    {"arguments is a list", [](json& e) { e["nodes"][1]["arguments"] = {1}; },
     ".nodes[1].arguments: must be an object"},
    {"argument is missing", [](json& e) { e["nodes"][1]["arguments"].erase("tint"); },
     "texture node paint: its argument float3 tint is missing; give it a value: --set "
     "paint.tint=JSON, in the scene, or as a default in the file's comment"},
    {"unknown argument", [](json& e) { e["nodes"][1]["arguments"]["hue"] = 1; },
     "userProc has no argument hue; it takes: float scale, int count"},
    {"argument is text", [](json& e) { e["nodes"][1]["arguments"]["scale"] = "2"; },
     "argument scale: must be numbers"},
    {"argument is null", [](json& e) { e["nodes"][1]["arguments"]["scale"] = nullptr; },
     "argument scale: must be a finite number"},
    {"beyond float", [](json& e) { e["nodes"][1]["arguments"]["scale"] = 1e300; },
     "beyond the range of float"},
    {"half a whole number", [](json& e) { e["nodes"][1]["arguments"]["count"] = 0.5; },
     "its argument count is of type int; 0.5 is not such a number"},
    {"negative unsigned", [](json& e) { e["nodes"][1]["arguments"]["flags"] = -1; },
     "its argument flags is of type uint; -1 is not such a number"},
    {"too many components",
     [](json& e) {
         e["nodes"][1]["arguments"]["tint"] = {1, 2, 3, 4};
     },
     "its argument tint is of type float3, but has 4 numbers; give it 3"},
    {"a hundred thousand numbers",
     [](json& e) { e["nodes"][1]["arguments"]["tint"] = numbers(100000); },
     "but has 100000 numbers; give it 3"},
    {"empty array", [](json& e) { e["nodes"][1]["arguments"]["ramp"] = json::array(); },
     "its argument ramp is of type float[], but has 0 numbers; give it whole elements"},
    {"array of broken vectors", [](json& e) { e["nodes"][1]["arguments"]["colors"] = numbers(5); },
     "its argument colors is of type float3[], but has 5 numbers; give it whole elements"},
    {"nested too deeply",
     [](json& e) {
         e["nodes"][1]["arguments"]["colors"] = {{{1, 2, 3}}, {{4, 5, 6}}};
     },
     "is nested too deeply"},
    {"number for an image", [](json& e) { e["nodes"][1]["arguments"]["image"] = 0; },
     "its argument image is an image; name one with {\"texture\": N}"},
    {"image for a number",
     [](json& e) {
         e["nodes"][1]["arguments"]["scale"] = {{"texture", 0}};
     },
     "its argument scale is of type float; give it numbers"},
    {"no such image",
     [](json& e) {
         e["nodes"][1]["arguments"]["image"] = {{"texture", 9}};
     },
     "must name one of the 1 textures of the file"},
    {"unknown colour space",
     [](json& e) { e["nodes"][1]["arguments"]["image"]["colorSpace"] = "cmyk"; },
     "colorSpace: must be srgb or linear"},
    {"node in an array",
     [](json& e) {
         e["nodes"][1]["arguments"]["ramp"] = json::array({json{{"node", "level"}}, 1});
     },
     "nodes in arrays are not supported"},
    {"node for a whole number",
     [](json& e) {
         e["nodes"][1]["arguments"]["count"] = {{"node", "level"}};
     },
     "its argument count is of type int, which no node gives; give it numbers"},
    {"unknown node",
     [](json& e) {
         e["nodes"][1]["arguments"]["inner"] = {{"node", "depth"}};
     },
     "\"depth\" names no texture node; there are 2: level, paint; name one of these"},
    {"node out of range",
     [](json& e) {
         e["nodes"][1]["arguments"]["inner"] = {{"node", 2}};
     },
     "2 names no texture node"},
    {"cycle of one",
     [](json& e) {
         e["nodes"][1]["arguments"]["inner"] = {{"node", "paint"}};
     },
     "paint > paint is a cycle"},
    {"cycle of two",
     [](json& e) {
         e["nodes"][0]["arguments"]["value"] = {{"node", "paint"}};
     },
     "is a cycle"},
    {"time is text", [](json& e) { e["time"] = "now"; }, ".time: must be a finite number"},
    {"rays are a list", [](json& e) { e["occlusionRays"] = {16}; },
     ".occlusionRays: must be a finite number"},
};

TEST(GltfTextures, HostileExtensionsAreRefusedEachInItsWords)
{
    for (const Hostile& wrong : hostile) {
        GltfText gltf = textured();
        wrong.edit(extension(gltf));
        std::string said;
        try {
            load(gltf);
        } catch (const SceneError& error) {
            said = error.what();
        }
        EXPECT_NE(said.find(wrong.said), std::string::npos)
            << wrong.name << ": wanted \"" << wrong.said << "\", said \"" << said << "\"";
        EXPECT_TRUE(said.starts_with((test_folder() / "scene.gltf").string() + ": "))
            << wrong.name << ": " << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << wrong.name << ": " << said;
    }
}

TEST(GltfTextures, HostileMaterialsAreRefusedEachInItsWords)
{
    const std::pair<json, const char*> wrong[] = {
        {json(3), "must be an object"},
        {json{{"sheenTexture", {{"node", "paint"}}}}, "has no slot sheenTexture; slots are"},
        {json{{"baseColorTexture", "paint"}}, ".baseColorTexture: must be an object"},
        {json{{"baseColorTexture", json::object()}}, "its node is missing; name one"},
        {json{{"baseColorTexture", {{"node", "absent"}}}}, "names no texture node"},
        {json{{"baseColorTexture", {{"node", 1.5}}}}, "names no texture node"},
        {json{{"baseColorTexture", {{"node", "paint"}, {"index", 0}}}}, "has no property index"},
    };
    for (const auto& [slots, wanted] : wrong) {
        GltfText gltf = textured();
        gltf.document["materials"][0]["extensions"]["DIPTYCH_procedural_texture"] = slots;
        try {
            load(gltf);
            ADD_FAILURE() << slots << " is taken";
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find(wanted), std::string::npos) << error.what();
        }
    }
}

}  // namespace
