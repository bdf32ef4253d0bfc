// The schedule of the OpenCL backend: the answer depends on nothing but the scene and the samples.
// That the numbers themselves are right is for the tests of stages, laws and pictures.
#include "tests/backends/opencl_fixture.hpp"

#include "backends/opencl_backend.hpp"

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
        EXPECT_EQ(backend.statistics().paths, blocks(scene).size() * 256 * QUANTUM);
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
        EXPECT_LE(plan.scene_bytes + plan.path_bytes + plan.structure_bytes, 512u << 20);
        scene.settings[0].width = scene.settings[0].height = 16384;
        EXPECT_EQ(backend.plan(scene).items, plan.items);
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

TEST_F(OpenclBackendTest, RefusesByNumbersWhatIsTooLargeForOneAllocation)
{
    const NarrowDevice limit(256u << 20);
    SceneData scene = lamp_scene();
    scene.texels_8.resize((300u << 20) / sizeof(uint));
    on_each_device({}, [&](Backend& backend) {
        const std::string message = message_of([&] { backend.plan(scene); });
        EXPECT_NE(message.find("texels_8 need 301 MB"), std::string::npos) << message;
        EXPECT_NE(message.find("at most 257 MB"), std::string::npos) << message;
        scene.texels_8.resize((200u << 20) / sizeof(uint));
        EXPECT_EQ(message_of([&] { backend.plan(scene); }), "");
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
