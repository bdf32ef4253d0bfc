// What lies in a device's memory, and how much of it.
#pragma once

#include "backends/backend.hpp"
#include "backends/opencl_devices.hpp"

#include <span>
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

// log2 of the bytes of a page where rows of LARGE_BUFFERS are larger than the device allocates at
// once; 0: all are whole.
int page_shift(const DeviceInfo& device, const SceneData& scene);

struct SceneMemory {
    std::vector<opencl::Buffer>
        rows;  // or their first pages; in the order of the kernels' arguments
    std::vector<opencl::Buffer> pages;  // LARGE_PAGES - 1 of each row of LARGE_BUFFERS; some empty
};
SceneMemory upload_scene(const opencl::Context& context, opencl::Queue& queue,
                         const DeviceInfo& device, const SceneData& scene);

size_t bytes_of(std::span<const opencl::Buffer> buffers);

// Everything that a dispatch of the plan's size needs.
struct DispatchMemory {
    DispatchMemory() = default;
    DispatchMemory(const opencl::Context& context, const SceneData& scene, const Plan& plan,
                   int group_size);

    int paths = 0;  // slots
    int results = 0;
    std::vector<opencl::Buffer> path_planes;
    std::vector<opencl::Buffer> result_planes;
    std::vector<opencl::Buffer> texture_planes;
    std::vector<PlaneRow> texture_result_rows;
    std::vector<opencl::Buffer> texture_result_planes;
    opencl::Buffer items;
    opencl::Buffer live[2];     // lists of live paths: this bounce's and the next one's
    opencl::Buffer waiting[2];  // likewise of paths whose rays wait for textures
    opencl::Buffer sums;        // one of each work-group of the compaction
    opencl::Buffer total;

    size_t bytes() const;
    void clear_texture_results(opencl::Queue& queue) const;
    // Result entries of all rows, whose planes lie as far apart as there is room for.
    void read_results(opencl::Queue& queue, Results& rows, int first, int count) const;
    void write_results(opencl::Queue& queue, const Results& rows, int count) const;
};

// As many slots and results as fit into memory_bytes beside the scene. Throws when that is none.
Plan plan_memory(const DeviceInfo& device, const SceneData& scene, size_t memory_bytes);

}  // namespace diptych
