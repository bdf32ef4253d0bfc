// Renders with an error target: the same picture however it is cut up, complete at any time.
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"

#include <algorithm>
#include <cstring>

namespace {

using namespace diptych;
using namespace laws;

RenderOptions to_error(double error)
{
    RenderOptions options;
    options.error = error;
    options.samples = 512;
    return options;
}

struct Picture {
    std::vector<float> beauty;
    std::vector<uint32_t> counts;
};

Picture picture_of(const RenderResult& result)
{
    const image::Picture picture = result.film.picture();
    return {image::beauty_of(picture).pixels, image::find_layer(picture, "sample_count")->ids};
}

Picture render_with(const std::string& backend_name, const BackendOptions& backend_options,
                    const RenderOptions& options)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend(backend_name, backend_options);
    backend->upload(scene);
    return picture_of(render(*backend, scene, options));
}

bool is_same(const Picture& a, const Picture& b)
{
    return a.counts == b.counts &&
           std::memcmp(a.beauty.data(), b.beauty.data(), 4 * a.beauty.size()) == 0;
}

TEST(Adaptive, ThreadsMemoryAndDispatchesChangeNoBit)
{
    for (const char* backend : {"cpu", "twin"}) {
        BackendOptions large, small;
        large.threads = 2;
        small.threads = 1;
        small.memory_bytes = 3u << 20;
        const Picture one = render_with(backend, large, to_error(1.5));
        EXPECT_TRUE(is_same(one, render_with(backend, small, to_error(1.5)))) << backend;
        RenderOptions pieces = to_error(1.5);
        pieces.most_items = 3;
        EXPECT_TRUE(is_same(one, render_with(backend, large, pieces))) << backend;
        const auto [least, most] = std::minmax_element(one.counts.begin(), one.counts.end());
        EXPECT_EQ(*least, 64u) << "some block is easy";
        EXPECT_GT(*most, 64u) << "some block is not";
    }
}

TEST(Adaptive, GoesOnFromAnyDispatchToTheSamePicture)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    for (const bool is_unbiased : {false, true}) {
        RenderOptions options = to_error(1.5);
        options.is_unbiased = is_unbiased;
        options.most_items = 5;
        std::vector<RenderState> states;
        int calls = 0;
        options.observe = [&](const RenderState& state) {
            if (++calls % 7 == 0) states.push_back(state);
        };
        const Picture whole = picture_of(render(*backend, scene, options));
        options.observe = nullptr;
        options.most_items = 0;
        EXPECT_GT(states.size(), 2u);
        for (const RenderState& state : states)
            EXPECT_TRUE(is_same(whole, picture_of(render(*backend, scene, options, state))))
                << "from round " << state.schedule.round;
    }
}

// Rounds follow each other without a pause where paths stay under way, in 4096 slots; the picture
// is that of a backend which finishes every dispatch.
TEST(Adaptive, RoundsLeaveNoSlotsIdle)
{
    SceneData scene = busy_scene(160, 96);
    BackendOptions few_slots;
    few_slots.memory_bytes = 3u << 20;
    std::unique_ptr<Backend> opencl;
    try {
        opencl = make_backend("opencl", few_slots);
    } catch (const std::runtime_error& error) {
        GTEST_SKIP() << error.what();
    }
    opencl->upload(scene);
    RenderOptions options = to_error(0.05);
    options.samples = 128;
    const RenderResult result = render(*opencl, scene, options);
    EXPECT_GE(result.schedule.round, 8);
    const double busy = double(result.statistics.busy_steps) / double(result.statistics.slot_steps);
    RecordProperty("busy", std::to_string(busy));
    EXPECT_GT(busy, 0.95);
    const std::unique_ptr<Backend> twin = make_backend("twin", {});
    twin->upload(scene);
    EXPECT_TRUE(is_same(picture_of(result), picture_of(render(*twin, scene, options))));
}

// In a white room paths end one by one, the last after many bounces; in blocks of 8 x 8 pixels.
TEST(Adaptive, PacketsOfTheCpuHaveFewEmptyLanes)
{
    SceneBuilder builder;
    builder.place(builder.add_mesh(
        box_mesh({-1, -1, -1}, {1, 1, 1}, builder.add_material(lambert(0.98f, 0.02f)))));
    builder.set_camera({.eye = {0, 0, 0.5}, .target = {0, 0, 0}});
    builder.set_picture_size(96, 54);
    SceneData scene = builder.finish();
    scene.settings[0].max_bounces = 64;
    BackendOptions one_thread;
    one_thread.threads = 1;
    const std::unique_ptr<Backend> backend = make_backend("cpu", one_thread);
    backend->upload(scene);
    RenderOptions options = to_error(0.01);
    options.samples = 64;
    const Statistics spent = render(*backend, scene, options).statistics;
    const double busy = double(spent.busy_steps) / double(spent.slot_steps);
    RecordProperty("busy", std::to_string(busy));
    EXPECT_GT(busy, 0.97);
    EXPECT_LE(busy, 1.0);
}

TEST(Adaptive, ATimeLimitLeavesACompletePicture)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    RenderOptions options;
    options.samples = most_adaptive_samples;
    options.time_limit = 1e-9;
    const RenderResult result = render(*backend, scene, options);
    EXPECT_EQ(result.ending, Ending::TimeOver);
    EXPECT_TRUE(result.is_complete);
    for (const uint32_t count : picture_of(result).counts) ASSERT_EQ(count, 1u);
}

TEST(Adaptive, ALooseTargetIsReachedAndSaidToBe)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    const RenderResult reached = render(*backend, scene, to_error(50));
    EXPECT_EQ(reached.ending, Ending::TargetReached);
    EXPECT_EQ(reached.unfinished_blocks, 0);
    const RenderResult missed = render(*backend, scene, to_error(0.05));
    EXPECT_EQ(missed.ending, Ending::SamplesDone);
    EXPECT_GT(missed.unfinished_blocks, 0);
}

// The hardest blocks need not hold up the others, and the picture is the same wherever it was left.
TEST(Adaptive, AShareOfTheBlocksIsEnough)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    RenderOptions options = to_error(1.5);
    options.samples = 1 << 16;  // a block of heavy tails takes more than 1 << 14
    const RenderResult all = render(*backend, scene, options);
    EXPECT_EQ(all.unfinished_blocks, 0);
    options.share = 0.8;
    options.most_items = 5;
    std::optional<RenderState> state;
    int calls = 0;
    options.observe = [&](const RenderState& now) {
        if (++calls == 20) state = now;
    };
    const RenderResult most = render(*backend, scene, options);
    EXPECT_EQ(most.ending, Ending::TargetReached);
    EXPECT_GT(most.unfinished_blocks, 0);
    EXPECT_LE(most.unfinished_blocks, 0.2 * most.blocks);
    const auto quanta = [](const RenderResult& result) {
        int sum = 0;
        for (const BlockState& block : result.schedule.blocks) sum += block.quanta;
        return sum;
    };
    EXPECT_LT(quanta(most), 0.9 * quanta(all));
    options.observe = nullptr;
    options.most_items = 0;
    ASSERT_TRUE(state);
    EXPECT_TRUE(is_same(picture_of(most), picture_of(render(*backend, scene, options, state))));
    options.share = 1;  // and it goes on to all
    const RenderResult rest =
        render(*backend, scene, options, RenderState{most.film, most.schedule});
    EXPECT_EQ(rest.unfinished_blocks, 0);
}

// One batch alone does not know how wrong it is: that is not called right.
TEST(Adaptive, WhatNobodyMeasuredIsNotCalledRight)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    RenderOptions options = to_error(1);
    options.samples = QUANTUM;
    const RenderResult result = render(*backend, scene, options);
    EXPECT_EQ(result.ending, Ending::SamplesDone);
    EXPECT_EQ(result.unfinished_blocks, result.blocks);
    const BlockGrid grid = error_grid(scene.settings[0]);
    const ErrorSummary summary = summarise_error(result.film, grid, options.viewer, 1);
    EXPECT_NEAR(summary.share_unknown, 1, 1e-9);
    EXPECT_GT(summary.block_p95, 90);
    EXPECT_LT(summary.share_within, 0.05);
    for (const float error : predicted_error(result.film, options.viewer)) ASSERT_GT(error, 90);
    options.samples = 2 * QUANTUM;
    const RenderResult judged = render(*backend, scene, options);
    EXPECT_EQ(summarise_error(judged.film, grid, options.viewer, 1).share_unknown, 0);
}

// Where blocks meet the error changes no more from pixel to pixel than within them.
TEST(Adaptive, BlockEdgesDoNotShow)
{
    SceneData scene = busy_scene(72, 40);
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    backend->upload(scene);
    const RenderOptions options = to_error(1.5);
    const RenderResult result = render(*backend, scene, options);
    RenderOptions longer;
    longer.samples = 1024;
    scene.settings[0].seed = 77;
    backend->upload(scene);
    const RenderResult reference = render(*backend, scene, longer);
    const auto error = [&](int x, int y) {
        return double(image::lightness(result.film.radiance(x, y), options.viewer) -
                      image::lightness(reference.film.radiance(x, y), options.viewer));
    };
    const int side = image::error_block_side(72, 40);
    double square[2] = {0, 0};  // of steps within blocks, and from one to the next
    int steps[2] = {0, 0};
    const auto add = [&](double step, bool is_across) {
        square[is_across] += step * step;
        ++steps[is_across];
    };
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 72; ++x) {
            if (x > 0) add(error(x, y) - error(x - 1, y), x % side == 0);
            if (y > 0) add(error(x, y) - error(x, y - 1), y % side == 0);
        }
    EXPECT_GT(steps[1], 500);
    const double ratio = square[1] / steps[1] / (square[0] / steps[0]);
    EXPECT_GT(ratio, 0.7);
    EXPECT_LT(ratio, 1.3);
}

TEST(Adaptive, APixelsFilmIsOnePixel)
{
    const SceneData scene = busy_scene(72, 40);
    RenderOptions options;
    options.pixel = Pixel{3, 4};
    EXPECT_LT(film_bytes(scene, options), 1000u);
    options.pixel.reset();
    EXPECT_GT(film_bytes(scene, options), size_t(72 * 40 * 100));
}

}  // namespace
