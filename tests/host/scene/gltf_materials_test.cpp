// Materials, textures and lights of glTF files written here.
#include "host/scene/load.hpp"

#include "tests/host/scene/gltf_text.hpp"

#include <cmath>

namespace diptych {
namespace {

// A 2 x 2 PNG: red, green / blue, white at half alpha.
const char* const png_uri =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lEQVR42mP4z8DwHwyBNAg0AABJSQl4nFEXkgAAAA"
    "BJRU5ErkJggg==";

SceneData load(const GltfText& gltf) { return load_scene(gltf.write(), {.environment = "none"}); }

// A triangle with a material and two UV sets.
GltfText textured(const nlohmann::json& material)
{
    GltfText gltf;
    gltf.add_triangle();
    const int uv0 = gltf.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", 5126, 3);
    const int uv1 = gltf.add_accessor(std::vector<float>{5, 5, 6, 5, 5, 6}, "VEC2", 5126, 3);
    auto& primitive = gltf.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = uv0;
    primitive["attributes"]["TEXCOORD_1"] = uv1;
    primitive["material"] = 0;
    gltf.document["materials"] = {material};
    gltf.document["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf.document["samplers"] = {
        {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}}};
    gltf.document["images"] = {{{"uri", png_uri}}};
    return gltf;
}

TEST(GltfMaterials, Factors)
{
    const SceneData scene =
        load(textured({{"name", "paint"},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                         {"metallicFactor", 0.5},
                         {"roughnessFactor", 2}}},
                       {"emissiveFactor", {1, 0.5, 0}},
                       {"alphaMode", "MASK"},
                       {"alphaCutoff", 0.6},
                       {"doubleSided", true},
                       {"extensions",
                        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                         {"KHR_materials_ior", {{"ior", 2}}},
                         {"KHR_materials_specular",
                          {{"specularFactor", 0.25}, {"specularColorFactor", {1, 0.5, 2}}}}}}}));
    const Material& m = scene.materials[0];
    EXPECT_EQ(scene.material_names[0], "paint");
    EXPECT_FLOAT_EQ(m.base_color.z, 0.3f);
    EXPECT_FLOAT_EQ(m.base_color.w, 0.4f);
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.emission.x, 8);
    EXPECT_EQ(m.emission.y, 4);
    EXPECT_EQ(m.alpha_mode, ALPHA_MASK);
    EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.6f);
    EXPECT_EQ(m.flags, MATERIAL_DOUBLE_SIDED);
    EXPECT_FLOAT_EQ(m.dielectric_f0, 1.0f / 9);
    EXPECT_EQ(m.specular_color.w, 0.25f);
    EXPECT_EQ(m.specular_color.z, 2);
    EXPECT_EQ(m.base_slot, -1);
    EXPECT_EQ(scene.texels_8.size(), 1u) << "the white one; no image is read that nothing uses";
}

TEST(GltfMaterials, Defaults_are_those_of_the_specification)
{
    const SceneData scene = load(textured(nlohmann::json::object()));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.base_color.x, 1);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.emission.x, 0);
    EXPECT_FLOAT_EQ(m.dielectric_f0, 0.04f);
    EXPECT_EQ(m.specular_color.w, 1);
    EXPECT_EQ(m.alpha_mode, ALPHA_OPAQUE);
    EXPECT_EQ(m.flags, 0);
    EXPECT_EQ(scene.effects, unsigned(EFFECT_SPECULAR));
}

TEST(GltfMaterials, Specular_zero_is_lambert_and_unlit_is_unlit)
{
    EXPECT_EQ(
        load(textured({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}}))
            .effects,
        0u);
    const SceneData scene =
        load(textured({{"emissiveFactor", {1, 1, 1}},
                       {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}}));
    EXPECT_EQ(scene.effects, unsigned(EFFECT_UNLIT));
    EXPECT_EQ(scene.materials[0].flags, MATERIAL_UNLIT);
}

TEST(GltfMaterials, Textures_with_samplers_sets_and_transforms)
{
    const SceneData scene = load(textured({{"pbrMetallicRoughness",
                                            {{"baseColorTexture",
                                              {{"index", 0},
                                               {"texCoord", 0},
                                               {"extensions",
                                                {{"KHR_texture_transform",
                                                  {{"offset", {0.25, 0.5}},
                                                   {"rotation", 0.5},
                                                   {"scale", {2, 3}},
                                                   {"texCoord", 1}}}}}}},
                                             {"metallicRoughnessTexture", {{"index", 0}}}}}}));
    ASSERT_EQ(scene.texture_slots.size(), 2u);
    ASSERT_EQ(scene.images.size(), 2u) << "read as sRGB and as numbers";
    EXPECT_EQ(scene.texels_8.size(), 4u);
    EXPECT_EQ(scene.texels_8[0], 0xff0000ffu);
    EXPECT_EQ(scene.texels_8[1], 0xff00ff00u);
    EXPECT_EQ(scene.texels_8[3] >> 24, 0x80u) << "straight alpha";
    EXPECT_EQ(scene.texels_8[3] & 0xffffffu, 0xffffffu) << "straight alpha";
    const TextureSlot& slot = scene.texture_slots[size_t(scene.materials[0].base_slot)];
    EXPECT_EQ(slot.wrap, WRAP_CLAMP + 4 * WRAP_MIRROR);
    EXPECT_EQ(slot.filter, TEXTURE_NEAREST);
    EXPECT_EQ(scene.images[size_t(slot.image)].encoding, TEXELS_8_SRGB);
    EXPECT_EQ(scene.settings[0].uv_set_count, 2);
    EXPECT_EQ(scene.uvs[size_t(slot.uv_set)].x, 5) << "the transform's set wins";
    // The extension's matrices: translation * rotation * scale.
    const double c = std::cos(0.5), s = std::sin(0.5);
    EXPECT_FLOAT_EQ(slot.to_u.x, float(2 * c));
    EXPECT_FLOAT_EQ(slot.to_u.y, float(3 * s));
    EXPECT_FLOAT_EQ(slot.to_u.z, 0.25f);
    EXPECT_FLOAT_EQ(slot.to_v.x, float(-2 * s));
    EXPECT_FLOAT_EQ(slot.to_v.y, float(3 * c));
    EXPECT_FLOAT_EQ(slot.to_v.z, 0.5f);
}

TEST(GltfMaterials, Masks_that_no_texel_fails_are_opaque)
{
    const nlohmann::json texture = {{"baseColorTexture", {{"index", 0}}}};
    EXPECT_TRUE(
        load(textured({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", texture}})).effects &
        EFFECT_ALPHA);
    EXPECT_FALSE(
        load(textured({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", texture}})).effects &
        EFFECT_ALPHA);
    EXPECT_FALSE(load(textured({{"pbrMetallicRoughness", texture}})).effects & EFFECT_ALPHA);
}

TEST(GltfMaterials, Missing_coordinates_are_told)
{
    GltfText gltf = textured(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 4}}}}}});
    const SceneData scene = load(gltf);
    EXPECT_EQ(scene.settings[0].uv_set_count, 1);
    EXPECT_EQ(scene.notices[0], "meshes: 1 sets of texture coordinates missing, taken as (0, 0)");
    gltf.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 8;
    EXPECT_THROW(load(gltf), SceneError);
}

TEST(GltfMaterials, Extensions_not_simulated_are_told)
{
    GltfText gltf =
        textured({{"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", "x"}}}}}});
    gltf.document["extensionsUsed"] = {"KHR_materials_sheen", "EXT_something"};
    const SceneData scene = load(gltf);
    ASSERT_EQ(scene.notices.size(), 2u);
    EXPECT_EQ(scene.notices[0], "extension EXT_something: unknown, ignored");
    EXPECT_EQ(scene.notices[1], "extension KHR_materials_sheen: not simulated yet; materials are "
                                "rendered without it");
}

TEST(GltfLights, Shine_along_minus_z_of_their_nodes)
{
    GltfText gltf;
    gltf.document["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 40}, {"range", 7}},
        {{"type", "directional"}},
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.6}}}}};
    const double half = std::sqrt(0.5);
    for (int k = 0; k < 3; ++k) {
        gltf.document["nodes"].push_back(
            {{"translation", {k, 2, 3}},
             {"rotation", {-half, 0, 0, half}},
             {"extensions", {{"KHR_lights_punctual", {{"light", k}}}}}});
    }
    gltf.document["scenes"] = {{{"nodes", {0, 1, 2}}}};
    const SceneData scene = load_scene(gltf.write());
    EXPECT_EQ(scene.effects, unsigned(EFFECT_PUNCTUAL_LIGHTS)) << "no sky";
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].kind, LIGHT_POINT);
    EXPECT_EQ(scene.lights[0].emission.x, 40);
    EXPECT_EQ(scene.lights[0].emission.y, 20);
    EXPECT_EQ(scene.lights[0].range, 7);
    EXPECT_EQ(scene.lights[1].kind, LIGHT_DIRECTIONAL);
    EXPECT_EQ(scene.lights[1].emission.x, 1) << "intensity 1 is irradiance 1";
    EXPECT_NEAR(scene.lights[1].edge1.y, -1, 1e-6);
    EXPECT_EQ(scene.lights[2].position.x, 2);
    EXPECT_FLOAT_EQ(scene.lights[2].edge2.x, float(std::cos(0.6)));
    EXPECT_FLOAT_EQ(scene.lights[2].edge2.y, float(1 / (1 - std::cos(0.6))));
}

}  // namespace
}  // namespace diptych
