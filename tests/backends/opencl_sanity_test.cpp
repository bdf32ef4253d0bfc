// A few paths through every kernel, one program compiled after the other: CTest also runs this
// under Oclgrind, which watches for invalid accesses, races and reads of what was never written.
#include "tests/backends/opencl_fixture.hpp"

#include "backends/opencl_backend.hpp"
#include "host/commands/selftest_scenes.hpp"

#include <gtest/gtest.h>

using namespace diptych;

// Textures with occlusion, indexes out of range and loops that run out of their budget.
TEST(OpenclSanity, RunsTexturesThatMisbehave)
{
    const std::vector<DeviceInfo> devices = usable_devices();
    if (devices.empty()) GTEST_SKIP() << "no usable OpenCL device";
    BackendOptions options;
    options.threads = 1;
    for (const DeviceInfo& device : devices) {
        options.device = std::to_string(device.index);
        SelftestScene selftest = std::move(selftest_scenes().at(3));
        ASSERT_STREQ(selftest.name, "procedural textures");
        SceneData scene = std::move(selftest.scene);
        ASSERT_TRUE(scene.effects & EFFECT_TEXTURE_OCCLUSION);
        scene.settings[0].max_bounces = 1;
        const std::unique_ptr<Backend> backend = make_opencl_backend(options);
        backend->upload(scene);
        Results results;
        const std::vector<WorkItem> items = {{16, 17, 0, 0}, {14, 26, 0, 0}};
        backend->render({items, 2, 0}, results);
        ASSERT_EQ(results.texture_faults.size(), 2u * TEXTURE_FAULT_COUNT);
        EXPECT_EQ(results.texture_faults[2 * TEXTURE_FAULT_NOT_FINITE], 0);
        EXPECT_GE(results.texture_faults[2 * TEXTURE_FAULT_BUDGET], 2);
        EXPECT_GE(results.texture_faults[2 * TEXTURE_FAULT_INDEX], 16);
    }
}

TEST(OpenclSanity, TracesAFewPixels)
{
    const std::vector<DeviceInfo> devices = usable_devices();
    if (devices.empty()) GTEST_SKIP() << "no usable OpenCL device";
    SceneData scene = lamp_scene();
    BackendOptions options;
    options.threads = 1;
    for (const DeviceInfo& device : devices) {
        options.device = std::to_string(device.index);
        const std::unique_ptr<Backend> backend = make_opencl_backend(options);
        backend->upload(scene);
        Results results;
        const std::vector<WorkItem> items = {{12, 14, 0, 0}, {20, 14, 0, 0}, {39, 23, 0, 0}};
        backend->render({items, 2, 0}, results);
        EXPECT_GT(results.sum_radiance[0] + results.sum_radiance[1], 0);
        EXPECT_EQ(results.sum_alpha.size(), 3u);
    }
}
