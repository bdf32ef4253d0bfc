// The same scene and samples give the same bits (D0), whatever threads, memory or neighbours do;
// backends agree as far as they promise (D2); an effect that no one calls for changes nothing.
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"

#include <cstring>

namespace {

using namespace diptych;
using namespace laws;

using Determinism = OnEachBackend;

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
    const SceneData scene = busy_scene(40, 24);
    const std::vector<float> one = picture_of(GetParam(), with_threads(1), scene, samples);
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), with_threads(2), scene, samples)));
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), with_threads(1), scene, samples)));
    BackendOptions little;
    little.memory_bytes = 3u << 20;
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), little, scene, samples)));
    RenderOptions short_dispatches = samples;
    short_dispatches.most_items = 3;
    EXPECT_TRUE(is_same(one, picture_of(GetParam(), {}, scene, short_dispatches)));
}

// Where work items hold few paths, the cpu backend runs as many together as leave each thread some.
TEST_P(Determinism, ItemsThatRunTogetherChangeNoBit)
{
    const RenderOptions samples = with_samples(2);
    const SceneData scene = busy_scene(160, 96);
    const std::vector<float> together = picture_of(GetParam(), with_threads(1), scene, samples);
    EXPECT_TRUE(is_same(together, picture_of(GetParam(), with_threads(64), scene, samples)));
    RenderOptions odd_dispatches = samples;
    odd_dispatches.most_items = 7;
    EXPECT_TRUE(is_same(together, picture_of(GetParam(), with_threads(1), scene, odd_dispatches)));
}

// Paths may be under way when it is stopped: what they have found so far is not lost.
TEST_P(Determinism, StoppedAndResumedARenderHasTheSameBits)
{
    SceneData scene = busy_scene(40, 24);
    backend_->upload(scene);
    RenderOptions options = with_samples(80);
    const std::vector<float> whole =
        image::beauty_of(render(*backend_, scene, options).film.picture()).pixels;
    std::atomic<bool> stop{false};
    int dispatches = 0;
    options.most_items = 5;
    options.stop = &stop;
    options.observe = [&](const RenderState&) {
        if (++dispatches % 2 == 0) stop = true;
    };
    std::optional<RenderState> state;
    int renders = 0;
    for (bool is_complete = false; !is_complete && renders < 100; ++renders) {
        stop = false;
        RenderResult part = render(*backend_, scene, options, std::move(state));
        is_complete = part.is_complete;
        state = RenderState{std::move(part.film), std::move(part.schedule)};
    }
    EXPECT_GT(renders, 2);
    EXPECT_TRUE(is_same(whole, image::beauty_of(state->film.picture()).pixels));
}

// Camera rays alone when nothing scatters; else as many as the cpu backend traces, but for the few
// paths that rounding sends another way. OpenCL counts all that it launches: in
// the first step, paths of a block that lie outside the picture too.
TEST_P(Determinism, RaysAreCounted)
{
    const auto count = [](Backend& backend, int bounces) {
        SceneData scene = busy_scene(40, 24);
        scene.settings[0].max_bounces = bounces;
        backend.upload(scene);
        render(backend, scene, with_samples(16));
        return backend.statistics();
    };
    const bool is_bound = GetParam() == "opencl";
    const Statistics seen = count(*make_backend(GetParam(), {}), 0);
    EXPECT_GE(seen.rays, 40u * 24 * 16);
    EXPECT_LE(seen.rays, 40u * 24 * 16 + (is_bound ? 48u * 32 - 40u * 24 : 0));
    const Statistics own = count(*make_backend(GetParam(), {}), 3);
    const Statistics cpu = count(*make_backend("cpu", {}), 3);
    const double few = 0.001;
    EXPECT_GE(double(own.rays), (1 - few) * double(cpu.rays));
    EXPECT_GE(double(own.shadow_rays), (1 - few) * double(cpu.shadow_rays));
    if (is_bound) return;
    EXPECT_LE(double(own.rays), (1 + few) * double(cpu.rays));
    EXPECT_LE(double(own.shadow_rays), (1 + few) * double(cpu.shadow_rays));
}

TEST_P(Determinism, OnePixelAloneHasItsValueInThePicture)
{
    SceneData scene = busy_scene(40, 24);
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
    full.settings[0].cell_columns = 1;
    full.settings[0].cell_rows = 2;
    full.environment_cells = {0, 0.5f, 1, 0, 1, 0, 1, 0};
    const auto expect_same_with = [&](unsigned effects, const std::string& name) {
        full.bvh_nodes.clear();  // the trees' shape follows the effects
        full.bvh_items.clear();
        full.effects = plain.effects | effects;
        backend_->upload(full);
        const RenderResult more = render(*backend_, full, with_samples(16));
        EXPECT_TRUE(is_same(expected, image::beauty_of(more.film.picture()).pixels)) << name;
    };
    // A users' texture is code that must be there: nothing to switch on.
    const unsigned possible = ~(plain.effects | USER_TEXTURE_EFFECTS);
    unsigned all = 0;
#define ADD_EFFECT(name, bit, words) \
    all |= EFFECT_##name & possible; \
    if (EFFECT_##name & possible) expect_same_with(EFFECT_##name, #name);
    EFFECTS_LIST(ADD_EFFECT)
#undef ADD_EFFECT
    expect_same_with(all, "all");
}

ON_EACH_BACKEND(Determinism);

// D1: what a GPU runs is what the debugger steps.
TEST(Agreement, OpenclHasTheTwinsBits)
{
    const RenderOptions samples = with_samples(20);
    const SceneData scene = busy_scene(40, 24);
    std::vector<float> opencl;
    try {
        opencl = picture_of("opencl", {}, scene, samples);
    } catch (const std::runtime_error& error) {
        GTEST_SKIP() << error.what();
    }
    EXPECT_TRUE(is_same(picture_of("twin", {}, scene, samples), opencl));
}

TEST(Agreement, DebugKernelsHaveTheTwinsBits)
{
    const RenderOptions samples = with_samples(4);
    const SceneData scene = busy_scene(40, 24);
    BackendOptions debug;
    debug.debug_kernels = true;
    EXPECT_TRUE(
        is_same(picture_of("twin", {}, scene, samples), picture_of("twin", debug, scene, samples)));
}

}  // namespace
