// Small renders and what they leave, for tests of checkpoints.
#pragma once

#include "host/render/checkpoint_merge.hpp"
#include "host/render/safe_file.hpp"
#include "tests/laws/measure.hpp"

#include <cstring>

namespace slices {

using namespace diptych;

// A render that may be cut short: samples [first, end), stopped after so many dispatches.
struct Wanted {
    std::string backend = "twin";
    int first = 0;
    int end = 0;
    int dispatches = 1 << 30;
    unsigned seed = 1;
};

inline Checkpoint rendered(const Wanted& wanted, std::optional<RenderState> start = std::nullopt,
                           int width = 40, int height = 24)
{
    const std::unique_ptr<Backend> backend = make_backend(wanted.backend, {});
    SceneData scene = laws::busy_scene(width, height);
    scene.settings[0].seed = wanted.seed;
    CheckpointHead head;
    head.subject = checkpoint_subject(scene, "test 1");
    head.backends = {wanted.backend};
    backend->upload(scene);

    std::atomic<bool> stop = false;
    int dispatches = 0;
    RenderOptions options;
    options.first_sample = wanted.first;
    options.samples = wanted.end;
    options.stop = &stop;
    options.most_items = 2;
    options.observe = [&](const RenderState&) { stop = ++dispatches >= wanted.dispatches; };
    RenderResult result = render(*backend, scene, options, std::move(start));
    head.slices = {slice_of(options)};
    head.slices[0].schedule = std::move(result.schedule);
    return {std::move(head), std::move(result.film)};
}

// A render of busy_scene goes on from it.
inline RenderState gone_on(Checkpoint checkpoint, int first, int end)
{
    RenderOptions options;
    options.first_sample = first;
    options.samples = end;
    const Settings settings = checkpoint.head.subject.settings;
    return continued(std::move(checkpoint), "part", settings, options);
}

inline void write(const std::string& path, const Checkpoint& checkpoint)
{
    SafeFile file(path);
    write_checkpoint(file, checkpoint.head, checkpoint.film);
    file.put_in_place();
}

// Every layer of the pictures has the same bits.
inline void expect_same_picture(const Film& a, const Film& b)
{
    const image::Picture p = a.picture(), q = b.picture();
    ASSERT_EQ(p.layers.size(), q.layers.size());
    for (size_t k = 0; k < p.layers.size(); ++k) {
        const image::Layer &one = p.layers[k], &other = q.layers[k];
        EXPECT_EQ(one.name, other.name);
        EXPECT_EQ(one.ids, other.ids) << one.name;
        ASSERT_EQ(one.pixels.size(), other.pixels.size());
        EXPECT_TRUE(one.pixels.empty() ||
                    std::memcmp(one.pixels.data(), other.pixels.data(), 4 * one.pixels.size()) == 0)
            << one.name;
    }
}

// What a function throws, as text; empty when it does not.
template<class Function>
std::string error_of(Function&& function)
{
    try {
        function();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace slices
