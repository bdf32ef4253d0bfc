// The same scene and samples give the same bits (D0), whatever threads, memory or neighbours do;
// backends agree as far as they promise (D2); an effect that no one calls for changes nothing.
#include "host/render/render.hpp"
#include "kernels_cpu/path_rows.hpp"
#include "tests/laws/measure.hpp"

#include <cmath>
#include <cstring>

namespace {

using namespace diptych;
using namespace laws;

using Determinism = OnEachBackend;

// Something of everything: textures, normal map, instances, alpha, lamps, sky; not a whole number
// of blocks.
SceneData busy_scene(int width = 40, int height = 24)
{
    SceneBuilder scene;
    Picture checks{4, 4, {}, {}, true, 0};
    for (int k = 0; k < 16; ++k) {
        const std::uint8_t value = (k + k / 4) % 2 ? 220 : 60;
        checks.bytes.insert(checks.bytes.end(), {value, 128, value, std::uint8_t(k * 16)});
    }
    const int image = scene.add_image(checks);
    const int floor = scene.add_material({.roughness = 0.4f, .base_texture = {.image = image}});
    const int leaf = scene.add_material(
        {.specular = 0, .alpha_mode = ALPHA_BLEND, .base_texture = {.image = image}});
    const int metal =
        scene.add_material({.metallic = 1, .roughness = 0.2f, .normal_texture = {.image = image}});
    const int lamp = scene.add_material({.emission = {5, 4, 3}});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-1, 0.1, 0.6}, {1, 0, 0}, {0, 1, 0}, leaf)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp)));
    const int ball = scene.add_mesh(sphere_mesh({0, 0, 0}, 0.3, 24, metal));
    for (int k = 0; k < 4; ++k) scene.place(ball, translation(0.7 * k - 1, 0.3, -0.2 * k));
    scene.add_light({.kind = LIGHT_SPOT,
                     .intensity = {4, 4, 4},
                     .position = {1, 2, 1},
                     .direction = {-0.5, -1, -0.5}});
    scene.set_environment(environment_of([](const Vec3& w) { return 0.3 + 0.2 * w[1]; }, 8, 8));
    scene.set_camera({.eye = {0.5, 1.2, 3}, .target = {0, 0.4, 0}});
    scene.set_picture_size(width, height);
    SceneData data = scene.finish();
    data.settings[0].max_bounces = 6;
    return data;
}

std::vector<float> picture_of(const std::string& name, const BackendOptions& options,
                              SceneData scene, RenderOptions render_options = {})
{
    const std::unique_ptr<Backend> backend = make_backend(name, options);
    backend->upload(scene);
    const RenderResult result = render(*backend, scene, render_options);
    return image::beauty_of(result.film.picture()).pixels;
}

RenderOptions with_samples(int samples, std::optional<Pixel> pixel = std::nullopt)
{
    RenderOptions options;
    options.samples = samples;
    options.pixel = pixel;
    return options;
}

BackendOptions with_threads(int threads)
{
    BackendOptions options;
    options.threads = threads;
    return options;
}

bool is_same(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

TEST_P(Determinism, ThreadsAndMemoryChangeNoBit)
{
    const RenderOptions samples = with_samples(40);
    const SceneData scene = busy_scene();
    const std::vector<float> one = picture_of(GetParam(), with_threads(1), scene, samples);
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), with_threads(2), scene, samples)));
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), with_threads(1), scene, samples)));
    BackendOptions little;
    little.memory_bytes = 3u << 20;
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), little, scene, samples)));
}

TEST_P(Determinism, OnePixelAloneHasItsValueInThePicture)
{
    SceneData scene = busy_scene();
    backend_->upload(scene);
    const RenderResult whole = render(*backend_, scene, with_samples(24));
    const std::vector<float> all = image::beauty_of(whole.film.picture()).pixels;
    for (const Pixel pixel : {Pixel{0, 0}, Pixel{17, 9}, Pixel{20, 15}, Pixel{39, 23}}) {
        const RenderResult alone = render(*backend_, scene, with_samples(24, pixel));
        const std::vector<float> one = image::beauty_of(alone.film.picture()).pixels;
        const size_t k = size_t(pixel.y * scene.settings[0].width + pixel.x) * 4;
        EXPECT_EQ(0, std::memcmp(&one[k], &all[k], 16))
            << pixel.x << "," << pixel.y << ": " << one[k] << " alone, " << all[k] << " in all";
    }
}

// Rooms of coplanar and repeated faces: every hit is a tie.
TEST_P(Determinism, TiesDoNotDependOnCompany)
{
    SceneBuilder builder;
    const int colors[] = {builder.add_material(lambert(0.2f)), builder.add_material(lambert(0.9f))};
    for (int k = 0; k < 4; ++k) {
        const MeshPart part = box_mesh({-1, -1, -1}, {1, 1, 1}, colors[k % 2]);
        builder.place(builder.add_mesh(part), translation(0.5 * (k / 2), 0, 0));
    }
    builder.set_environment(environment_of([](const Vec3& w) { return 1 + w[1]; }, 8, 8));
    builder.set_camera({.eye = {3, 2, 4}, .target = {0, 0, 0}});
    builder.set_picture_size(32, 32);
    SceneData scene = builder.finish();
    backend_->upload(scene);
    const RenderResult whole = render(*backend_, scene, with_samples(4));
    const std::vector<float> all = image::beauty_of(whole.film.picture()).pixels;
    int differing = 0;
    for (int p = 0; p < 32 * 32; p += 7) {
        const RenderResult alone = render(*backend_, scene, with_samples(4, Pixel{p % 32, p / 32}));
        const std::vector<float> one = image::beauty_of(alone.film.picture()).pixels;
        differing += std::memcmp(&one[size_t(p) * 4], &all[size_t(p) * 4], 16) != 0;
    }
    EXPECT_EQ(differing, 0);
}

// What a scene does not call for may be switched on as far as its buffers allow.
TEST_P(Determinism, AnEffectNotCalledForChangesNoPixel)
{
    SceneBuilder builder;
    const int red = builder.add_material({.base_color = {0.8f, 0.3f, 0.2f, 1}, .specular = 0});
    const int lamp = builder.add_material(lambert(0.5f, 4));
    builder.place(builder.add_mesh(box_mesh({-1, 0, -1}, {1, 0.7, 1}, red)));
    builder.place(builder.add_mesh(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, red)));
    builder.place(builder.add_mesh(quad_mesh({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
    builder.set_camera({.eye = {0, 1.5, 4}, .target = {0, 0.5, 0}});
    builder.set_picture_size(24, 16);
    SceneData plain = builder.finish();
    plain.settings[0].max_bounces = 5;
    backend_->upload(plain);
    const std::vector<float> expected =
        image::beauty_of(render(*backend_, plain, with_samples(16)).film.picture()).pixels;
    // Buffers that say nothing, for the effects that read some.
    SceneData full = plain;
    full.normals.assign(full.positions.size(), NORMAL_FLAT);
    full.colors.assign(full.positions.size(), {1, 1, 1, 1});
    full.tangents.assign(full.positions.size(), normal_pack({1, 0, 0}));
    full.uvs.assign(full.positions.size(), {0, 0});
    full.settings[0].uv_set_count = 1;
    full.texture_slots.push_back({});
    full.images.push_back({1, 1, 0, TEXELS_8_LINEAR});
    full.texels_8.push_back(~0u);
    full.texels_float.push_back({0, 0, 0, 0});
    full.settings[0].environment_width = full.settings[0].environment_height = 1;
    full.settings[0].cell_columns = full.settings[0].cell_rows = 1;
    full.environment_cells.push_back({1, 0, 1, 0});
#define TRY(name, bit, words)                                                                  \
    if ((EFFECT_##name & (plain.effects | EFFECT_ORTHOGRAPHIC)) == 0) {                        \
        full.bvh_nodes.clear();                                                                \
        full.bvh_items.clear(); /* the trees' shape follows the effects */                     \
        full.effects = plain.effects | EFFECT_##name;                                          \
        backend_->upload(full);                                                                \
        const RenderResult more = render(*backend_, full, with_samples(16));                   \
        EXPECT_TRUE(is_same(expected, image::beauty_of(more.film.picture()).pixels)) << #name; \
    }
    EFFECTS_LIST(TRY)
#undef TRY
}

ON_EACH_BACKEND(Determinism);

TEST(Agreement, DebugKernelsHaveTheTwinsBits)
{
    const RenderOptions samples = with_samples(4);
    const SceneData scene = busy_scene();
    BackendOptions debug;
    debug.debug_kernels = true;
    EXPECT_TRUE(
        is_same(picture_of("twin", {}, scene, samples), picture_of("twin", debug, scene, samples)));
}

}  // namespace
