#include "backends/opencl_memory.hpp"

#include "common/as_cpp/path_rows.hpp"

#include <algorithm>
#include <stdexcept>

namespace diptych {
namespace {

constexpr int paths_per_item = QUANTUM << (2 * BLOCK_SHIFT);
constexpr int results_per_item = 1 << (2 * BLOCK_SHIFT);
constexpr size_t small_items = 4;     // of a quarter of a block's pixels, in place of a block
constexpr int most_items = 1024;      // 4 million paths: what keeps the largest GPUs busy
constexpr int most_items_of_cpu = 8;  // 32 thousand paths: what stays in a processor's caches

std::string megabytes(size_t bytes) { return std::to_string((bytes >> 20) + 1) + " MB"; }

template<class Rows>
size_t plane_bytes(const Rows& rows)
{
    size_t bytes = 0;
    for (const auto& row : rows) bytes += sizeof(float) * size_t(row.components);
    return bytes;
}

#define NUMBERED_ROW(type, name) {#name, planes[row++], #type[0] == 'f'},

// Rows of TEXTURE_BUFFERS, a component for each plane.
std::vector<PlaneRow> texture_planes_of(const SceneData& scene)
{
    const auto planes = texture_planes(scene);
    size_t row = 0;
    return {TEXTURE_BUFFERS(NUMBERED_ROW)};
}

// Whether rays may wait for textures.
bool has_rounds(const SceneData& scene) { return (scene.effects & EFFECT_PROCEDURAL_ALPHA) != 0; }

size_t item_bytes(const SceneData& scene)
{
    // live, twice, and at most one sum a path; waiting, twice
    const size_t lists = (has_rounds(scene) ? 5 : 3) * sizeof(int);
    const size_t planes = plane_bytes(path_rows) + plane_bytes(texture_planes_of(scene));
    return paths_per_item * (planes + lists) +
           results_per_item *
               (plane_bytes(result_rows()) + plane_bytes(texture_result_rows(scene))) +
           small_items * sizeof(WorkItem);
}

// A buffer of the scene is one allocation.
void check_allocation(const DeviceInfo& device, const std::string& name, size_t bytes)
{
    if (bytes > device.largest_allocation)
        throw std::runtime_error("opencl: " + device.name + ": the scene's " + name + " need " +
                                 megabytes(bytes) + ", the device allocates at most " +
                                 megabytes(device.largest_allocation) +
                                 " at once; simplify the scene or use --backend cpu");
}

// Of the buffers that a dispatch needs, the largest one's share of an item.
size_t widest_buffer(const SceneData& scene)
{
    int components = 1;
    for (const PathRow& row : path_rows) components = std::max(components, row.components);
    for (const PlaneRow& row : texture_planes_of(scene))
        components = std::max(components, row.components);
    return sizeof(float) * size_t(components) * paths_per_item;
}

size_t scene_bytes(const SceneData& scene)
{
    size_t bytes = 0;
#define ADD_BYTES(type, name) bytes += scene.name.size() * sizeof(type);
    SCENE_BUFFERS(ADD_BYTES)
#undef ADD_BYTES
    return bytes;
}

// The tree that upload() will build where the scene has none yet: about one node for two triangles.
size_t structure_bytes(const SceneData& scene)
{
    if (!scene.bvh_nodes.empty()) return 0;
    return (scene.triangles.size() + 2 * scene.instances.size() + 1) *
           (sizeof(BvhNode) / 2 + sizeof(int));
}

template<class Rows>
std::vector<opencl::Buffer> planes(const opencl::Context& context, const Rows& rows, int entries)
{
    std::vector<opencl::Buffer> buffers;
    for (const auto& row : rows)
        buffers.push_back(
            context.buffer(sizeof(float) * size_t(row.components) * size_t(entries), row.name));
    return buffers;
}

}  // namespace

#define PLANE_ROW(type, name) {#name, int(sizeof(type) / sizeof(PLANE(type))), #type[0] == 'f'},

const std::vector<PlaneRow>& result_rows()
{
    static const std::vector<PlaneRow> rows = {RESULT_BUFFERS(PLANE_ROW)};
    return rows;
}

std::vector<PlaneRow> texture_result_rows(const SceneData& scene)
{
    const auto planes = texture_result_planes(scene);
    size_t row = 0;
    return {TEXTURE_RESULT_BUFFERS(NUMBERED_ROW)};
}

std::vector<opencl::Buffer> upload_scene(const opencl::Context& context, opencl::Queue& queue,
                                         const DeviceInfo& device, const SceneData& scene)
{
    std::vector<opencl::Buffer> buffers;
    const auto upload = [&](const char* name, const void* data, size_t bytes) {
        check_allocation(device, name, bytes);
        buffers.push_back(context.buffer(bytes, name));
        queue.write(buffers.back(), bytes, data);
    };
    // kernels may read element 0 of a buffer that the scene has no use for
#define UPLOAD(type, name)                                                  \
    if (scene.name.empty()) {                                               \
        const type nothing = {};                                            \
        upload(#name, &nothing, sizeof(type));                              \
    } else {                                                                \
        upload(#name, scene.name.data(), scene.name.size() * sizeof(type)); \
    }
    SCENE_BUFFERS(UPLOAD)
#undef UPLOAD
    return buffers;
}

DispatchMemory::DispatchMemory(const opencl::Context& context, const SceneData& scene,
                               int item_count, int group_size)
    : paths(item_count * paths_per_item), results(item_count * results_per_item),
      path_planes(planes(context, path_rows, paths)),
      result_planes(planes(context, result_rows(), results)),
      texture_planes(planes(context, texture_planes_of(scene), paths)),
      texture_result_planes(planes(context, texture_result_rows(scene), results)),
      items(context.buffer(sizeof(WorkItem) * small_items * size_t(item_count), "items"))
{
    for (opencl::Buffer& list : live) list = context.buffer(sizeof(int) * size_t(paths), "live");
    if (has_rounds(scene))
        for (opencl::Buffer& list : waiting)
            list = context.buffer(sizeof(int) * size_t(paths), "waiting");
    const int groups = (paths + group_size - 1) / group_size;
    sums = context.buffer(sizeof(int) * size_t(groups), "sums");
    total = context.buffer(sizeof(int), "total");
}

Plan plan_memory(const DeviceInfo& device, const SceneData& scene, size_t memory_bytes)
{
#define CHECK_ROW(type, name) check_allocation(device, #name, scene.name.size() * sizeof(type));
    SCENE_BUFFERS(CHECK_ROW)
#undef CHECK_ROW
    Plan plan;
    plan.scene_bytes = scene_bytes(scene);
    plan.structure_bytes = structure_bytes(scene);
    const size_t taken = plan.scene_bytes + plan.structure_bytes;
    const size_t budget = std::min(memory_bytes, device.memory_bytes);
    if (budget < taken + item_bytes(scene))
        throw std::runtime_error(
            "opencl: " + device.name + ": " + megabytes(budget) + " do not hold the scene (" +
            megabytes(taken) + ") and one block of paths (" + megabytes(item_bytes(scene)) + "); " +
            (budget < memory_bytes ? "choose a device with more memory" : "raise --memory"));
    const size_t widest = widest_buffer(scene);
    if (device.largest_allocation < widest)
        throw std::runtime_error("opencl: " + device.name + ": allocates at most " +
                                 megabytes(device.largest_allocation) +
                                 " at once, one block of paths needs " + megabytes(widest) +
                                 "; choose another device or --backend cpu");
    const int most = device.is_cpu ? most_items_of_cpu : most_items;
    const size_t items = std::min(
        {(budget - taken) / item_bytes(scene), device.largest_allocation / widest, size_t(most)});
    plan.items = int(std::max<size_t>(items, 1));
    plan.path_bytes = size_t(plan.items) * item_bytes(scene);
    return plan;
}

}  // namespace diptych
