// Every glTF file among the real scenes, the broken ones too: loads, or is refused with one line.
#include "host/render/render.hpp"
#include "host/scene/load.hpp"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

namespace diptych {
namespace {

namespace fs = std::filesystem;

const fs::path scenes = fs::path(DIPTYCH_SHARED) / "scenes";

#define SKIP_WITHOUT_SCENES()                                          \
    if (!fs::is_directory(scenes)) {                                   \
        GTEST_SKIP() << "no folder " << scenes << " with real scenes"; \
    }

struct Outcome {
    std::string message;  // empty: loaded
    SceneData scene;
};

Outcome load(const std::string& file, const LoadOptions& options = {})
{
    try {
        return {"", load_scene(scenes / file, options)};
    } catch (const SceneError& error) {
        return {error.what(), {}};
    }
}

size_t drawn_triangles(const SceneData& scene)
{
    size_t count = 0;
    for (const Instance& instance : scene.instances) {
        count += size_t(instance.triangle_count);
    }
    return count;
}

// Everything that kernels index must be in range, and everything they add up must be finite.
void expect_sound(const SceneData& d)
{
    const auto in = [](int index, size_t size) { return index >= 0 && size_t(index) < size; };
    ASSERT_EQ(d.settings.size(), 1u);
    const Settings& s = d.settings[0];
    const size_t vertices = d.positions.size();
    EXPECT_TRUE(d.normals.empty() || d.normals.size() == vertices);
    EXPECT_TRUE(d.tangents.empty() || d.tangents.size() == vertices);
    EXPECT_TRUE(d.colors.empty() || d.colors.size() == vertices);
    EXPECT_EQ(d.uvs.size(), vertices * size_t(s.uv_set_count));
    EXPECT_EQ(d.normals.empty(), !(d.effects & EFFECT_SMOOTH_NORMALS));
    EXPECT_EQ(d.tangents.empty(), !(d.effects & EFFECT_NORMAL_MAP));
    EXPECT_EQ(d.colors.empty(), !(d.effects & EFFECT_VERTEX_COLOR));
    EXPECT_EQ(d.instances.size() > 1, bool(d.effects & EFFECT_INSTANCES));
    EXPECT_EQ(d.materials.size(), d.material_names.size());
    EXPECT_EQ(d.instances.size(), d.instance_names.size());

    const auto is_finite = [](const float4& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    EXPECT_TRUE(std::ranges::all_of(d.positions, is_finite));
    EXPECT_TRUE(std::ranges::all_of(d.triangles, [&](const Triangle& t) {
        return in(t.vertex0, vertices) && in(t.vertex1, vertices) && in(t.vertex2, vertices) &&
               in(t.material, d.materials.size());
    }));
    EXPECT_TRUE(std::ranges::all_of(d.instances, [&](const Instance& i) {
        return i.first_triangle >= 0 && i.triangle_count >= 0 &&
               size_t(i.first_triangle) + size_t(i.triangle_count) <= d.triangles.size();
    }));
    for (const Material& m : d.materials) {
        for (const int slot : {m.base_slot, m.metallic_roughness_slot, m.normal_slot,
                               m.emission_slot, m.specular_slot, m.specular_color_slot}) {
            EXPECT_TRUE(slot == -1 || in(slot, d.texture_slots.size()));
        }
        EXPECT_TRUE(std::isfinite(m.emission.w));
    }
    for (const TextureSlot& slot : d.texture_slots) {
        EXPECT_TRUE(in(slot.image, d.images.size()));
        EXPECT_TRUE(in(slot.uv_set, size_t(std::max(s.uv_set_count, 1))));  // 0 where there is none
    }
    for (const Image& image : d.images) {
        const size_t texels =
            image.encoding == TEXELS_FLOAT ? d.texels_float.size() : d.texels_8.size();
        EXPECT_LE(size_t(image.first_texel) + size_t(image.width) * size_t(image.height), texels);
        EXPECT_GT(image.width, 0);
        EXPECT_GT(image.height, 0);
    }
    EXPECT_EQ(d.lights.size(), d.light_choice.size());
    EXPECT_EQ(int(d.lights.size()), s.light_count);
    double total = 0;
    for (const Light& light : d.lights) {
        total += double(light.emission.w);
        if (light.kind != LIGHT_TRIANGLE) {
            continue;
        }
        ASSERT_TRUE(in(light.triangle, d.triangles.size()));
        ASSERT_TRUE(in(light.instance, d.instances.size()));
    }
    EXPECT_NEAR(total, d.lights.empty() ? 0 : 1, 1e-3);
    const size_t cells = size_t(s.cell_rows + 1) +
                         size_t(s.cell_rows) * size_t(s.cell_columns + 1) +
                         size_t(s.cell_rows - 1) * size_t(s.cell_columns);
    EXPECT_EQ(d.environment_cells.size(), s.environment_width > 0 ? cells : 0);
    EXPECT_TRUE(is_finite(s.camera_origin) && is_finite(s.camera_right));
    EXPECT_TRUE(std::isfinite(s.scene_radius));
}

// On the CPU, by few samples: none is dropped for being no finite number.
void expect_renders(Backend& backend, SceneData& scene)
{
    RenderOptions options;
    options.samples = 2;
    backend.upload(scene);
    const RenderResult result = render(backend, scene, options);
    EXPECT_TRUE(result.is_complete);
    EXPECT_EQ(result.film.faults().count, 0);
    for (int y = 0; y < scene.settings[0].height; ++y)
        for (int x = 0; x < scene.settings[0].width; ++x)
            for (const float value : result.film.radiance(x, y))
                ASSERT_TRUE(std::isfinite(value) && value >= 0) << x << "," << y << ": " << value;
}

TEST(SharedScenes, Every_file_loads_and_renders_or_is_refused_with_one_line)
{
    SKIP_WITHOUT_SCENES();
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    std::set<std::string> refused;
    size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(scenes)) {
        const auto extension = entry.path().extension();
        if (extension != ".gltf" && extension != ".glb") {
            continue;
        }
        const std::string name = fs::relative(entry.path(), scenes).string();
        Outcome outcome = load(name, {.width = 24, .height = 16});
        SCOPED_TRACE(name);
        ++files;
        if (outcome.message.empty()) {
            expect_sound(outcome.scene);
            expect_renders(*backend, outcome.scene);
        } else {
            EXPECT_EQ(outcome.message.find('\n'), std::string::npos) << outcome.message;
            EXPECT_TRUE(outcome.message.starts_with(entry.path().string() + ": "))
                << outcome.message;
            EXPECT_NE(outcome.message.find("; "), std::string::npos) << outcome.message;
            if (!name.starts_with("hostile-")) {
                refused.insert(name);
            }
        }
    }
    EXPECT_GT(files, 300u);
    const std::set<std::string> expected{"bevy-AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf",
                                         "bio-14_emission_strength/14_emission_strength.gltf",
                                         "gltftransform-BoxMeshopt/BoxMeshopt.glb",
                                         "gltftransform-BoxMeshopt/BoxMeshopt.gltf",
                                         "khr-Box-Draco/Box.gltf"};
    EXPECT_EQ(refused, expected);
}

TEST(SharedScenes, Refusals_name_the_reason)
{
    SKIP_WITHOUT_SCENES();
    const std::pair<const char*, const char*> cases[] = {
        {"khr-Box-Draco/Box.gltf", "KHR_draco_mesh_compression is not supported"},
        {"gltftransform-BoxMeshopt/BoxMeshopt.glb", "EXT_meshopt_compression is not supported"},
        {"bio-14_emission_strength/14_emission_strength.gltf",
         "KHR_materials_pbrSpecularGlossiness is not supported"},
        {"bevy-AnisotropyBarnLamp-ktx2/AnisotropyBarnLamp.gltf", "KHR_texture_basisu"},
        {"hostile-assimp-gltf2-open/BoxWithInfinites.glb", "POSITION): element 0 is not finite"},
        {"hostile-assimp-gltf2-open/IndexOutOfRange/IndexOutOfRange.gltf",
         "names vertex 255 of 24"},
        {"hostile-assimp-gltf2-open/MissingBin/BoxTextured.gltf",
         "BoxTextured0.bin): no such file"},
        {"hostile-gltf-validator-open/base/asset/1_0_version.gltf", "glTF 1.0"},
        {"hostile-gltf-validator-open/base/glb/truncated_chunk_data.glb", "truncated"},
        {"hostile-gltf-validator-open/base/glb/invalid_magic.glb", "neither JSON nor a .glb"},
    };
    for (const auto& [file, part] : cases) {
        const std::string message = load(file).message;
        EXPECT_NE(message.find(part), std::string::npos) << file << ": " << message;
    }
}

// What INDEX.md of the scenes counts, as drawn; degenerate ones are dropped.
TEST(SharedScenes, Triangles_are_those_of_the_index)
{
    SKIP_WITHOUT_SCENES();
    struct Case {
        const char* file;
        size_t triangles;  // in the file
        size_t degenerate;
        size_t instances;
    };
    const Case cases[] = {
        {"gi-cornell-box/gi-cornell-box.glb", 36, 0, 1},
        {"gi-veach-mis/gi-veach-mis.glb", 27124, 0, 1},
        {"gi-lux-kitchen/gi-lux-kitchen.glb", 86032, 3290, 1},
        {"godot-living-room/living_room.glb", 5088, 3537, 1},
        {"khr-MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", 1040409, 196, 1},
        {"babylon-TeapotsGalore/TeapotsGalore.gltf", 7656770, 0, 1900},
        {"khr-SimpleInstancing/SimpleInstancing.glb", 1500, 0, 126},
        {"khr-MeshPrimitiveModes/MeshPrimitiveModes.gltf", 16, 0, 1},
        {"khr-SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 0, 1},
        {"khr-Box_With_Spaces/Box With Spaces.gltf", 12, 0, 1},
        {"khr-NegativeScaleTest/NegativeScaleTest.glb", 7724, 0, 7},
    };
    for (const Case& c : cases) {
        const Outcome outcome = load(c.file);
        EXPECT_EQ(outcome.message, "");
        EXPECT_EQ(drawn_triangles(outcome.scene) + outcome.scene.degenerate_triangles, c.triangles)
            << c.file;
        EXPECT_EQ(outcome.scene.degenerate_triangles, c.degenerate) << c.file;
        EXPECT_EQ(outcome.scene.instances.size(), c.instances) << c.file;
    }
}

TEST(SharedScenes, Effects_are_what_the_file_calls_for)
{
    SKIP_WITHOUT_SCENES();
    const std::pair<const char*, int> cases[] = {
        {"gi-cornell-box/gi-cornell-box.glb", EFFECT_EMISSION | EFFECT_SMOOTH_NORMALS},
        {"khr-UnlitTest/UnlitTest.glb", EFFECT_UNLIT | EFFECT_ENVIRONMENT | EFFECT_SMOOTH_NORMALS},
        {"khr-BoxVertexColors/BoxVertexColors.glb",
         EFFECT_SPECULAR | EFFECT_ENVIRONMENT | EFFECT_SMOOTH_NORMALS | EFFECT_VERTEX_COLOR},
        {"khr-WaterBottle/WaterBottle.gltf",
         EFFECT_SPECULAR | EFFECT_BASE_TEXTURE | EFFECT_SURFACE_TEXTURES | EFFECT_NORMAL_MAP |
             EFFECT_EMISSION | EFFECT_EMISSION_TEXTURE | EFFECT_SMOOTH_NORMALS},
    };
    for (const auto& [file, effects] : cases) {
        EXPECT_EQ(load(file).scene.effects, unsigned(effects)) << file;
    }
}

// The environment maps: orientation is in INDEX.md, here only that they make sound lights.
TEST(SharedScenes, Environment_maps_light_a_scene)
{
    SKIP_WITHOUT_SCENES();
    for (const char* map : {"hdr-lobby/lobby.hdr", "hdr-rpr-envLightImage/envLightImage.exr"}) {
        LoadOptions options;
        options.environment = (scenes / map).string();
        const Outcome outcome = load("gi-cornell-box/gi-cornell-box.glb", options);
        ASSERT_EQ(outcome.message, "");
        expect_sound(outcome.scene);
        EXPECT_TRUE(outcome.scene.effects & EFFECT_ENVIRONMENT);
        EXPECT_EQ(outcome.scene.settings[0].environment_light, 2);
        EXPECT_GT(outcome.scene.settings[0].environment_probability, 0.01);
    }
}

}  // namespace
}  // namespace diptych
