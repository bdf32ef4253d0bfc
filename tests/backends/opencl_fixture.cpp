#include "tests/backends/opencl_fixture.hpp"

#include "host/scene/scene_builder.hpp"

#include <cstring>

using namespace diptych;

SceneData lamp_scene()
{
    SceneBuilder scene;
    const int red = scene.add_material({.base_color = {0.6f, 0.1f, 0.1f, 1}, .specular = 0});
    const int lamp = scene.add_material({.emission = {5, 5, 5}});
    scene.place(scene.add_mesh(box_mesh({-1, 0, -1}, {1, 0.5, 1}, red)));
    scene.place(scene.add_mesh(quad_mesh({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp)));
    scene.set_camera({.eye = {0, 1.5, 4}, .target = {0, 0.7, 0}});
    scene.set_picture_size(40, 24);
    return scene.finish();
}

std::vector<WorkItem> blocks(const SceneData& scene, int first_sample)
{
    std::vector<WorkItem> items;
    const int size = 1 << BLOCK_SHIFT;
    for (int y = 0; y < scene.settings[0].height; y += size)
        for (int x = 0; x < scene.settings[0].width; x += size)
            items.push_back({x, y, first_sample, 0});
    return items;
}

std::vector<DeviceInfo> usable_devices()
{
    std::vector<DeviceInfo> usable;
    for (const DeviceInfo& device : list_opencl_devices())
        if (device.is_usable) usable.push_back(device);
    return usable;
}

bool is_same(const Results& a, const Results& b)
{
    bool is_same = true;
#define COMPARE(type, name)                                \
    is_same = is_same && a.name.size() == b.name.size() && \
              std::memcmp(a.name.data(), b.name.data(), a.name.size() * sizeof a.name[0]) == 0;
    RESULT_BUFFERS(COMPARE)
#undef COMPARE
    return is_same;
}
