// The schedule of the OpenCL backend: the answer depends on nothing but the scene and the samples.
// That the numbers themselves are right is for the tests of stages, laws and pictures.
#include "tests/backends/opencl_fixture.hpp"

#include "backends/opencl_backend.hpp"
#include "host/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <stdexcept>

using namespace diptych;

namespace {

class OpenclBackendTest : public testing::Test {
protected:
    void SetUp() override
    {
        devices_ = usable_devices();
        if (devices_.empty()) GTEST_SKIP() << "no usable OpenCL device";
    }

    // On every device in turn.
    template<class Check>
    void on_each_device(BackendOptions options, Check check)
    {
        for (const DeviceInfo& device : devices_) {
            SCOPED_TRACE(device.name);
            options.device = std::to_string(device.index);
            check(*make_opencl_backend(options));
        }
    }

    std::vector<DeviceInfo> devices_;
};

Results render(Backend& backend, SceneData& scene, const std::vector<WorkItem>& items, int samples,
               int shift = 2 * BLOCK_SHIFT)
{
    Results results;
    backend.upload(scene);
    backend.render({items, samples, shift}, results);
    return results;
}

std::string message_of(const std::function<void()>& act)
{
    try {
        act();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST_F(OpenclBackendTest, LightsTheScene)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const Results results = render(backend, scene, blocks(scene), QUANTUM);
        const double sum =
            std::accumulate(results.sum_radiance.begin(), results.sum_radiance.end(), 0.0);
        EXPECT_GT(sum, 1000);
        EXPECT_TRUE(std::isfinite(sum));
        for (const int faults : results.fault) EXPECT_EQ(faults, 0);
        EXPECT_GT(backend.statistics().rays, 40u * 24u * QUANTUM);
        EXPECT_EQ(backend.statistics().paths, 40u * 24u * QUANTUM) << "blocks reach beyond";
    });
}

TEST_F(OpenclBackendTest, DoesNotDependOnTheDispatch)
{
    SceneData scene = lamp_scene();
    const std::vector<WorkItem> items = blocks(scene);
    on_each_device({}, [&](Backend& backend) {
        const Results all = render(backend, scene, items, 4);
        for (size_t k = 0; k < items.size(); ++k) {
            const Results one = render(backend, scene, {items[k]}, 4);
            for (size_t r = 0; r < one.fault.size(); ++r) {
                const size_t at = k * one.fault.size() + r;
                ASSERT_EQ(one.sum_radiance[r], all.sum_radiance[at]);
                ASSERT_EQ(one.object_id[r], all.object_id[at]);
            }
        }
    });
}

TEST_F(OpenclBackendTest, DoesNotDependOnTheLengthOfLaunches)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const Results one = render(backend, scene, blocks(scene), QUANTUM);
        BackendOptions hurried;
        hurried.launch_milliseconds = 1e-6;
        on_each_device(hurried, [&](Backend& other) {
            EXPECT_TRUE(is_same(one, render(other, scene, blocks(scene), QUANTUM)));
        });
    });
}

// A scene whose picture is full blocks, and so many quanta of it.
SceneData full_blocks()
{
    SceneData scene = lamp_scene();
    scene.settings[0].width = 48;
    scene.settings[0].height = 32;
    return scene;
}

std::vector<WorkItem> blocks_of_quanta(const SceneData& scene, int quanta)
{
    std::vector<WorkItem> items;
    for (int q = 0; q < quanta; ++q)
        for (const WorkItem& item : blocks(scene, q * QUANTUM)) items.push_back(item);
    return items;
}

// In 4096 slots, which work on 24 pixels each.
BackendOptions few_slots()
{
    BackendOptions options;
    options.memory_bytes = 3u << 20;
    return options;
}

TEST_F(OpenclBackendTest, GoesOnWhereItLeftADispatch)
{
    SceneData scene = full_blocks();
    const std::vector<WorkItem> items = blocks_of_quanta(scene, 6);
    on_each_device(few_slots(), [&](Backend& backend) {
        ASSERT_EQ(backend.plan(scene).items, 1);
        const Results all = render(backend, scene, items, QUANTUM);
        std::vector<float> red;
        size_t calls = 0;
        for (size_t first = 0; first < items.size(); ++calls) {
            const std::span<const WorkItem> rest = std::span(items).subspan(first);
            const Dispatch dispatch{rest.first(std::min<size_t>(rest.size(), 20))};
            Results part;
            const Pace pace{rest.size() - dispatch.items.size(), [] { return Wish::leave; }};
            const size_t done = size_t(backend.advance(dispatch, pace, part));
            ASSERT_EQ(part.fault.size(), done << (2 * BLOCK_SHIFT));
            red.insert(red.end(), part.sum_radiance.begin(),
                       part.sum_radiance.begin() + std::ptrdiff_t(part.fault.size()));
            first += done;
            ASSERT_LT(calls, 10'000u);
        }
        EXPECT_GT(calls, 30u);
        EXPECT_EQ(backend.statistics().paths, 2 * items.size() * 256 * QUANTUM);
        for (size_t r = 0; r < red.size(); ++r) ASSERT_EQ(red[r], all.sum_radiance[r]) << r;
    });
}

// Asked for another list, what was under way is forgotten; asked to finish, nothing more begins.
TEST_F(OpenclBackendTest, ForgetsWhatItLeftOrFinishesIt)
{
    SceneData scene = full_blocks();
    const std::vector<WorkItem> items = blocks_of_quanta(scene, 6);
    const std::span<const WorkItem> others = std::span(items).subspan(6, 6);
    on_each_device(few_slots(), [&](Backend& backend) {
        const Results all = render(backend, scene, items, QUANTUM);
        Results part;
        int turns = 0;
        backend.advance({items}, {0, [&] { return Wish::leave; }}, part);
        backend.render({others}, part);
        for (size_t r = 0; r < part.fault.size(); ++r)
            ASSERT_EQ(part.sum_radiance[r], all.sum_radiance[r + 6 * 256]);
        const Pace soon{6, [&] { return ++turns < 30 ? Wish::go_on : Wish::finish; }};
        const size_t done = size_t(backend.advance({items}, soon, part));
        EXPECT_GE(done, 16u);  // as many as there are slots
        EXPECT_LT(done, items.size());
        for (size_t r = 0; r < part.fault.size(); ++r)
            ASSERT_EQ(part.sum_radiance[r], all.sum_radiance[r]);
    });
}

TEST_F(OpenclBackendTest, KeepsItsSlotsBusy)
{
    SceneData scene = full_blocks();
    on_each_device(few_slots(), [&](Backend& backend) {
        backend.upload(scene);
        const std::vector<WorkItem> items = blocks_of_quanta(scene, 112);
        const size_t most = size_t(backend.plan(scene).most_items);
        Results part;
        for (size_t first = 0; first < items.size();) {
            const std::span<const WorkItem> rest = std::span(items).subspan(first);
            const size_t count = std::min(rest.size(), most);
            first += size_t(backend.advance({rest.first(count)}, {rest.size() - count, {}}, part));
        }
        const Statistics statistics = backend.statistics();
        EXPECT_EQ(statistics.paths, items.size() * 256 * QUANTUM);
        const double busy = double(statistics.busy_steps) / double(statistics.slot_steps);
        RecordProperty("busy", std::to_string(busy));
        EXPECT_GT(busy, 0.95);
        EXPECT_LE(busy, 1.0);
    });
}

TEST_F(OpenclBackendTest, GivesASinglePixelWhatThePictureGivesIt)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const Results picture = render(backend, scene, {{0, 0, 0, 0}}, 8);
        const Results pixel = render(backend, scene, {{5, 3, 0, 0}}, 8, 0);
        ASSERT_EQ(pixel.sum_alpha.size(), 1u);
        const size_t morton = 1 | 2 | 4 * 0 | 8 | 16;  // x = 101, y = 011: bits y2x2 y1x1 y0x0
        ASSERT_EQ(morton, 27u);
        EXPECT_EQ(pixel.sum_radiance[0], picture.sum_radiance[morton]);
        EXPECT_EQ(pixel.sum_distance[0], picture.sum_distance[morton]);
    });
}

TEST_F(OpenclBackendTest, ShowsTheStateAfterEachStage)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        backend.upload(scene);
        std::vector<int> defined(STAGE_COUNT, -1);
        int stages = 0;
        const std::vector<WorkItem> items = {{0, 0, 0, 0}};
        backend.trace({items, 1}, [&](const StageState& state) {
            ++stages;
            EXPECT_EQ(state.paths, 256);
            if (state.bounce > 0) return;
            defined[state.stage] = 0;
            for (const std::vector<double>& plane : state.planes) {
                EXPECT_EQ(plane.size() % 256, 0u);
                defined[state.stage] += !plane.empty();
            }
        });
        EXPECT_GT(stages, 8);
        EXPECT_GT(defined[STAGE_generate_paths], 3);
        EXPECT_EQ(defined[STAGE_intersect], defined[STAGE_generate_paths] + 2);
        EXPECT_GT(defined[STAGE_evaluate_surface], defined[STAGE_intersect]);
        EXPECT_EQ(defined[STAGE_compact], -1);
    });
}

TEST_F(OpenclBackendTest, ChangesWithAPlantedFault)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const Results right = render(backend, scene, blocks(scene), 2);
        BackendOptions faulty;
        faulty.plant_fault = "sqrt";
        on_each_device(faulty, [&](Backend& other) {
            EXPECT_FALSE(is_same(right, render(other, scene, blocks(scene), 2)));
        });
    });
}

TEST_F(OpenclBackendTest, StaysCloseWithFastMath)
{
    SceneData scene = lamp_scene();
    const auto mean_of = [&](Backend& backend) {
        const Results results = render(backend, scene, blocks(scene), QUANTUM);
        return std::accumulate(results.sum_radiance.begin(), results.sum_radiance.end(), 0.0);
    };
    on_each_device({}, [&](Backend& exact) {
        BackendOptions fast;
        fast.fast_math = true;
        on_each_device(fast, [&](Backend& other) {
            EXPECT_NEAR(mean_of(other) / mean_of(exact), 1.0, 0.01);
            EXPECT_NE(other.description().find("fast math"), std::string::npos);
        });
    });
}

TEST_F(OpenclBackendTest, NamesDeviceProgramFileAndLineOfACompilerError)
{
    SceneData scene = lamp_scene();
    BackendOptions faulty;
    faulty.plant_fault = "nonsense";
    on_each_device(faulty, [&](Backend& backend) {
        const std::string message = message_of([&] { backend.upload(scene); });
        EXPECT_NE(message.find("clBuildProgram"), std::string::npos) << message;
        EXPECT_NE(message.find("kernels_cl/faults.h:"), std::string::npos) << message;
        EXPECT_NE(message.find("program "), std::string::npos) << message;
    });
}

TEST_F(OpenclBackendTest, SaysHowMuchMemoryIsMissing)
{
    SceneData scene = lamp_scene();
    BackendOptions small;
    small.memory_bytes = 1 << 19;
    on_each_device(small, [&](Backend& backend) {
        const std::string message = message_of([&] { backend.plan(scene); });
        EXPECT_NE(message.find("--memory"), std::string::npos) << message;
    });
}

TEST_F(OpenclBackendTest, PlansWithinTheMemoryWhateverThePicture)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const Plan plan = backend.plan(scene);
        EXPECT_GE(plan.items, 1);
        EXPECT_LE(plan.bytes(), 512u << 20);
        scene.settings[0].width = scene.settings[0].height = 16384;
        EXPECT_EQ(backend.plan(scene).items, plan.items);
    });
}

TEST_F(OpenclBackendTest, AllocatesAsMuchFor1MegapixelAsFor64)
{
    SceneData scene = lamp_scene();
    on_each_device({}, [&](Backend& backend) {
        const auto allocated = [&](int side) {
            scene.settings[0].width = scene.settings[0].height = side;
            const WorkItem corners[] = {{0, 0, 0, 0}, {side - 16, side - 16, 0, 0}};
            const Results results = render(backend, scene, {corners[0], corners[1]}, 1);
            EXPECT_EQ(results.sum_alpha.size(), 512u);
            const Plan plan = backend.plan(scene);
            const size_t planned = plan.bytes();
            const size_t bytes = backend.statistics().allocated_bytes;
            EXPECT_LE(bytes, planned + 1024);  // an element where the scene has none
            EXPECT_GT(double(bytes), 0.95 * double(planned));
            return double(bytes);
        };
        EXPECT_NEAR(allocated(8192) / allocated(1024), 1, 0.01);
    });
}

// As on a device with narrow limits.
class NarrowDevice {
public:
    explicit NarrowDevice(size_t bytes)
    {
        setenv("DIPTYCH_LARGEST_ALLOCATION", std::to_string(bytes).c_str(), 1);
    }
    ~NarrowDevice() { unsetenv("DIPTYCH_LARGEST_ALLOCATION"); }
};

TEST_F(OpenclBackendTest, RendersTheSameInSmallAllocations)
{
    SceneData scene = lamp_scene();
    const std::vector<WorkItem> one = {blocks(scene)[0]};
    on_each_device({}, [&](Backend& wide) {
        const Results expected = render(wide, scene, one, QUANTUM);
        const NarrowDevice limit(100'000);  // two blocks of a float3
        on_each_device({}, [&](Backend& narrow) {
            EXPECT_EQ(narrow.plan(scene).items, 2);
            EXPECT_TRUE(is_same(expected, render(narrow, scene, one, QUANTUM)));
        });
    });
    const NarrowDevice limit(10'000);
    on_each_device({}, [&](Backend& narrow) {
        const std::string message = message_of([&] { narrow.plan(scene); });
        EXPECT_NE(message.find("one block of paths needs"), std::string::npos) << message;
    });
}

// A ball of many triangles with a picture on it, whose texels begin after `before` others, under a
// lamp of many, on many copies of a tile.
SceneData painted_ball(size_t before)
{
    Picture picture{160, 160, {}, {}, true, 0};
    for (unsigned k = 0; k < 4 * 160 * 160; ++k) picture.bytes.push_back(uint8_t(k * k >> 9));
    SceneBuilder builder;
    const int image = builder.add_image(picture);
    const int paint = builder.add_material({.base_texture = {.image = image}});
    const int lamp = builder.add_material({.emission = {5, 5, 5}});
    builder.place(builder.add_mesh(sphere_mesh({0, 0, 0}, 1, 72, paint)));
    builder.place(builder.add_mesh(sphere_mesh({0, 2, 0}, 0.5, 32, lamp)));
    const int tile = builder.add_mesh(quad_mesh({-1.5, -1, -1.5}, {0, 0, 0.1}, {0.1, 0, 0}, paint));
    for (int k = 0; k < 900; ++k)
        builder.place(tile, translation(0.1 * (k % 30), 0, 0.1 * (k / 30)));
    builder.set_camera({.eye = {0, 1, 3}, .target = {0, 0, 0}});
    builder.set_picture_size(32, 32);
    SceneData scene = builder.finish();
    scene.texels_8.insert(scene.texels_8.begin(), before, 0u);
    for (Image& i : scene.images) i.first_texel += int(before);
    return scene;
}

// Geometry, tree and texels in pages of 64 KiB.
TEST_F(OpenclBackendTest, RendersTheSameFromPages)
{
    SceneData scene = painted_ball(0);
    on_each_device({}, [&](Backend& wide) {
        const Results expected = render(wide, scene, blocks(scene), QUANTUM);
        EXPECT_GT(scene.triangles.size() * sizeof(Triangle), 1u << 16);
        EXPECT_GT(scene.bvh_nodes.size() * sizeof(BvhNode), 2u << 16);
        EXPECT_GT(scene.texels_8.size() * sizeof(uint), 1u << 16);
        EXPECT_GT(scene.lights.size() * sizeof(Light), 1u << 16);
        EXPECT_GT(scene.instances.size() * sizeof(Instance), 1u << 16);
        const NarrowDevice limit(100'000);
        on_each_device({}, [&](Backend& narrow) {
            EXPECT_TRUE(is_same(expected, render(narrow, scene, blocks(scene), QUANTUM)));
        });
    });
}

// A device with 256 MiB at once, texels of 300.
TEST_F(OpenclBackendTest, RendersTexelsBeyondOneAllocationOf256MiB)
{
    SceneData near = painted_ball(0);
    SceneData far = painted_ball((300u << 20) / sizeof(uint));
    const NarrowDevice limit(256u << 20);
    BackendOptions options;
    options.memory_bytes = 1u << 30;
    on_each_device(options, [&](Backend& backend) {
        const Results expected = render(backend, near, blocks(near), 2);
        EXPECT_TRUE(is_same(expected, render(backend, far, blocks(far), 2)));
    });
}

TEST_F(OpenclBackendTest, RefusesByNumbersWhatIsTooLargeForItsAllocations)
{
    const NarrowDevice limit(1u << 20);
    SceneData scene = lamp_scene();
    scene.texels_8.resize((5u << 20) / sizeof(uint));
    on_each_device({}, [&](Backend& backend) {
        const std::string message = message_of([&] { backend.plan(scene); });
        EXPECT_NE(message.find("texels_8 need 5120 KiB"), std::string::npos) << message;
        EXPECT_NE(message.find("at most 1024 KiB at once; 4 pages hold 4096 KiB; simplify"),
                  std::string::npos)
            << message;
        scene.texels_8.resize((4u << 20) / sizeof(uint));
        EXPECT_EQ(message_of([&] { backend.plan(scene); }), "");
        const std::vector<Material> materials = scene.materials;
        scene.materials.resize((2u << 20) / sizeof(Material));
        const std::string whole = message_of([&] { backend.plan(scene); });
        EXPECT_NE(whole.find("materials need 2048 KiB"), std::string::npos) << whole;
        EXPECT_NE(whole.find("at most 1024 KiB at once; simplify"), std::string::npos) << whole;
        scene.materials = materials;
    });
}

TEST_F(OpenclBackendTest, CompilesOnceForAllItsRuns)
{
    const auto folder = std::filesystem::temp_directory_path() / "diptych-opencl-backend-test";
    std::filesystem::remove_all(folder);
    setenv("DIPTYCH_CACHE_DIR", folder.c_str(), 1);
    SceneData scene = lamp_scene();
    Results first;
    on_each_device({}, [&](Backend& backend) { first = render(backend, scene, blocks(scene), 1); });
    std::vector<std::filesystem::path> entries;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        entries.push_back(entry.path());
    EXPECT_GE(entries.size(), 8 * devices_.size());

    // truncated, damaged and foreign entries are built anew
    for (size_t k = 0; k < entries.size(); ++k)
        if (k % 2 == 0) std::filesystem::resize_file(entries[k], 100 * (k % 3));
    Results again;
    on_each_device({}, [&](Backend& backend) { again = render(backend, scene, blocks(scene), 1); });
    EXPECT_TRUE(is_same(first, again));
    for (const auto& entry : entries) EXPECT_GT(std::filesystem::file_size(entry), 300u);
    unsetenv("DIPTYCH_CACHE_DIR");
    std::filesystem::remove_all(folder);
}

}  // namespace
