// What lies in a device's memory, and how much of it.
#pragma once

#include "backends/backend.hpp"
#include "backends/opencl_devices.hpp"

#include <vector>

namespace diptych {

// A row of RESULT_BUFFERS, or of TEXTURE_BUFFERS.
struct PlaneRow {
    const char* name;
    int components;
    bool is_real;
};
const std::vector<PlaneRow>& result_rows();
// Rows of TEXTURE_RESULT_BUFFERS, a component for each plane that the scene asks for.
std::vector<PlaneRow> texture_result_rows(const SceneData& scene);

// Buffers in the order of the rows, which is the order of the kernels' arguments.
std::vector<opencl::Buffer> upload_scene(const opencl::Context& context, opencl::Queue& queue,
                                         const DeviceInfo& device, const SceneData& scene);

// Everything that a dispatch of `items` work items needs.
struct DispatchMemory {
    DispatchMemory() = default;
    DispatchMemory(const opencl::Context& context, const SceneData& scene, int items,
                   int group_size);

    int paths = 0;  // what it has room for
    int results = 0;
    std::vector<opencl::Buffer> path_planes;
    std::vector<opencl::Buffer> result_planes;
    std::vector<opencl::Buffer> texture_planes;
    std::vector<opencl::Buffer> texture_result_planes;
    opencl::Buffer items;
    opencl::Buffer live[2];     // lists of live paths: this bounce's and the next one's
    opencl::Buffer waiting[2];  // likewise of paths whose rays wait for textures
    opencl::Buffer sums;        // one of each work-group of the compaction
    opencl::Buffer total;
};

// As many work items as fit into memory_bytes beside the scene. Throws when that is none.
Plan plan_memory(const DeviceInfo& device, const SceneData& scene, size_t memory_bytes);

}  // namespace diptych
