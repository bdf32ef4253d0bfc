// A render that was interrupted or divided gives the bits of the one that was not.
#include "tests/host/render/rendered_slice.hpp"

#include <algorithm>
#include <random>

namespace {

using namespace slices;

class Checkpoints : public testing::TestWithParam<const char*> {};

TEST_P(Checkpoints, GoOnWhereverTheyStopped)
{
    const int samples = 200;
    const Checkpoint whole = rendered({GetParam(), 0, samples});
    for (const int dispatches : {1, 2, 7, 20}) {
        SCOPED_TRACE(dispatches);
        Checkpoint part = rendered({GetParam(), 0, samples, dispatches});
        ASSERT_FALSE(is_complete(part.head.slices[0]));
        part = rendered({GetParam(), 0, samples, 3}, gone_on(std::move(part), 0, samples));
        part = rendered({GetParam(), 0, samples}, gone_on(std::move(part), 0, samples));
        EXPECT_TRUE(is_complete(part.head.slices[0]));
        expect_same_picture(part.film, whole.film);
    }
}

TEST_P(Checkpoints, GoOnToMoreSamples)
{
    const Checkpoint whole = rendered({GetParam(), 0, 200});
    for (const int fewer : {16, 48, 128, 192}) {
        SCOPED_TRACE(fewer);
        Checkpoint part = rendered({GetParam(), 0, fewer});
        part = rendered({GetParam(), 0, 200}, gone_on(std::move(part), 0, 200));
        expect_same_picture(part.film, whole.film);
        Checkpoint stopped = rendered({GetParam(), 0, fewer, 5});
        stopped = rendered({GetParam(), 0, 200}, gone_on(std::move(stopped), 0, 200));
        expect_same_picture(stopped.film, whole.film);
    }
}

TEST_P(Checkpoints, MergeToTheBitsOfOneRender)
{
    const int bounds[] = {0, 16, 64, 176, 304, 410};
    std::vector<Checkpoint> parts;
    for (int k = 0; k < 5; ++k) parts.push_back(rendered({GetParam(), bounds[k], bounds[k + 1]}));
    const Checkpoint whole = rendered({GetParam(), 0, 410});
    std::vector<int> order = {0, 1, 2, 3, 4};
    for (int turn = 0; turn < 6; ++turn) {
        Checkpoint all = parts[size_t(order[0])];
        for (size_t k = 1; k < 5; ++k) {
            expect_mergeable(all.head, "all", parts[size_t(order[k])].head, "part");
            add_checkpoint(all, parts[size_t(order[k])]);
        }
        ASSERT_EQ(all.head.slices.size(), 1u);
        EXPECT_EQ(all.head.slices[0].first, 0);
        EXPECT_EQ(all.head.slices[0].end, 410);
        EXPECT_TRUE(is_complete(all.head.slices[0]));
        expect_same_picture(all.film, whole.film);
        std::shuffle(order.begin(), order.end(), std::minstd_rand(unsigned(turn + 1)));
    }
}

// Blocks with samples of their own number, and decisions on the way.
TEST_P(Checkpoints, GoOnTowardsAnErrorTarget)
{
    const int width = 64, height = 48;
    SceneData scene = laws::busy_scene(width, height);
    const std::unique_ptr<Backend> backend = make_backend(GetParam(), {});
    CheckpointHead head;
    head.subject = checkpoint_subject(scene, "test 1");
    backend->upload(scene);
    RenderOptions options;
    options.samples = 2048;
    options.error = 0.5;
    options.most_items = 64;
    const RenderResult whole = render(*backend, scene, options);
    const std::vector<BlockState>& blocks = whole.schedule.blocks;
    EXPECT_TRUE(std::any_of(blocks.begin(), blocks.end(), [&](const BlockState& block) {
        return block.quanta != blocks[0].quanta;
    })) << "all blocks have the same samples";

    std::optional<RenderState> state;
    for (int pauses = 0;; ++pauses) {
        std::atomic<bool> stop = false;
        int dispatches = 0;
        RenderOptions part = options;
        part.stop = &stop;
        part.observe = [&](const RenderState&) { stop = ++dispatches >= 7; };
        RenderResult result = render(*backend, scene, part, std::move(state));
        if (result.is_complete) {
            EXPECT_GT(pauses, 2);
            expect_same_picture(result.film, whole.film);
            break;
        }
        head.block_shift = grid_of(scene.settings[0], options).shift;
        head.slices = {slice_of(options)};
        head.slices[0].schedule = std::move(result.schedule);
        state = continued({head, std::move(result.film)}, "part", scene.settings[0], options);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Checkpoints, testing::Values("cpu", "twin"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Merging, AcceptsOtherBackendsAndSaysSo)
{
    Checkpoint all = rendered({"cpu", 0, 64});
    const Checkpoint more = rendered({"twin", 64, 128});
    expect_mergeable(all.head, "a", more.head, "b");
    add_checkpoint(all, more);
    EXPECT_EQ(all.head.backends, (std::vector<std::string>{"cpu", "twin"}));
    EXPECT_TRUE(all.film.has_standard_error());

    const Checkpoint whole = rendered({"cpu", 0, 128});
    const image::Picture mixed = all.film.picture(), pure = whole.film.picture();
    const image::Layer& error = *image::find_layer(pure, "standard_error");
    const std::vector<float>&a = image::beauty_of(mixed).pixels, &b = image::beauty_of(pure).pixels;
    double squares = 0, expected = 0;
    for (size_t p = 0; p < error.pixels.size() / 3; ++p)
        for (size_t c = 0; c < 3; ++c) {
            squares += std::pow(double(a[p * 4 + c]) - double(b[p * 4 + c]), 2);
            expected += std::pow(double(error.pixels[p * 3 + c]), 2);
        }
    EXPECT_LE(squares, expected) << "half of the samples are the same ones";
}

TEST(Merging, KeepsWhatIsApartAndJoinsItLater)
{
    const Checkpoint middle = rendered({.first = 64, .end = 96});
    Checkpoint all = rendered({.first = 0, .end = 64});
    add_checkpoint(all, rendered({.first = 96, .end = 128}));
    ASSERT_EQ(all.head.slices.size(), 2u);
    EXPECT_NE(error_of([&] { gone_on(all, 0, 128); }).find("apart"), std::string::npos);
    add_checkpoint(all, middle);
    ASSERT_EQ(all.head.slices.size(), 1u);
    const Checkpoint more = rendered({.end = 160}, gone_on(std::move(all), 0, 160));
    expect_same_picture(more.film, rendered({.end = 160}).film);
}

TEST(Merging, RefusesWhatIsOfAnotherPictureAndNamesBoth)
{
    const Checkpoint a = rendered({.end = 16});
    const auto refusal = [&](const Checkpoint& b) {
        return error_of([&] { expect_mergeable(a.head, "one", b.head, "two"); });
    };
    const auto expect = [&](const Checkpoint& b, const std::string& words) {
        const std::string error = refusal(b);
        EXPECT_EQ(error.find("one and two: "), 0u) << error;
        EXPECT_NE(error.find(words), std::string::npos) << error;
    };
    EXPECT_EQ(refusal(rendered({.first = 16, .end = 32})), "");
    expect(rendered({.end = 32}), "both hold samples 0..16");
    expect(rendered({.first = 16, .end = 32, .seed = 9}), "seed (1 and 9)");
    expect(rendered({.first = 16, .end = 32}, std::nullopt, 24, 40), "size (40x24 and 24x40)");
    Checkpoint b = rendered({.first = 16, .end = 32});
    const CheckpointSubject same = b.head.subject;
    b.head.subject.settings.camera_origin.x += 1;
    expect(b, "camera");
    b.head.subject = same;
    b.head.subject.settings.max_bounces = 3;
    expect(b, "bounces (");
    b.head.subject = same;
    b.head.subject.scene[0] = 'x';
    expect(b, "scene (");
    b.head.subject = same;
    b.head.subject.program = "test 2";
    expect(b, "program (test 1 and test 2)");
    b.head.subject = same;
    b.head.subject.settings.scene_radius += 1;
    expect(b, "settings");
}

TEST(Merging, SubjectFollowsTheSceneAndNotTheBackend)
{
    SceneData scene = laws::busy_scene(8, 8);
    const std::string before = checkpoint_subject(scene, "").scene;
    const std::unique_ptr<Backend> twin = make_backend("twin", {});
    twin->upload(scene);
    EXPECT_EQ(checkpoint_subject(scene, "").scene, before);
    scene.materials[0].roughness += 0.001f;
    EXPECT_NE(checkpoint_subject(scene, "").scene, before);
    scene.materials[0].roughness = laws::busy_scene(8, 8).materials[0].roughness;
    EXPECT_EQ(checkpoint_subject(scene, "").scene, before);
    TextureFunction function;
    function.id = "f";
    function.opencl = "one";
    scene.textures.functions.push_back(function);
    const std::string textured = checkpoint_subject(scene, "").scene;
    EXPECT_NE(textured, before);
    scene.textures.functions[0].opencl = "two";
    EXPECT_NE(checkpoint_subject(scene, "").scene, textured)
        << "an edited texture is another scene";
}

TEST(Continuing, RefusesWhatDoesNotFit)
{
    const Checkpoint some = rendered({.end = 40});
    const auto refusal = [&](int first, int end) {
        return error_of([&] { gone_on(some, first, end); });
    };
    EXPECT_EQ(refusal(0, 40), "");
    EXPECT_NE(refusal(0, 32).find("more than up to 32"), std::string::npos);
    EXPECT_NE(refusal(0, 64).find("within a group of 16"), std::string::npos);
    EXPECT_NE(refusal(16, 64).find("not from 16 on"), std::string::npos);
    EXPECT_NE(refusal(0, 32).find("--restart"), std::string::npos);
}

}  // namespace
