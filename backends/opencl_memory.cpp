#include "backends/opencl_memory.hpp"

#include "common/as_cpp/path_rows.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace diptych {
namespace {

constexpr int paths_per_item = QUANTUM << (2 * BLOCK_SHIFT);
constexpr int results_per_item = 1 << (2 * BLOCK_SHIFT);
constexpr size_t small_items = 4;     // of a quarter of a block's pixels, in place of a block
constexpr int most_items = 256;       // a million paths: what keeps the largest GPUs busy
constexpr int most_items_of_cpu = 8;  // 32 thousand paths: what stays in a processor's caches
// Results of a dispatch a slot: while the last of them are under way, others must have room.
constexpr int results_per_slot = 4;
constexpr int least_results_per_slot = 1;

std::string amount(size_t bytes)
{
    const bool is_small = bytes < (10u << 20);
    const size_t unit = is_small ? 1u << 10 : 1u << 20;
    return std::to_string((bytes + unit - 1) / unit) + (is_small ? " KiB" : " MiB");
}

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

// The slots of an item's paths.
size_t slots_bytes(const SceneData& scene)
{
    // live, twice, and at most one sum a path; waiting, twice
    const size_t lists = (has_rounds(scene) ? 5 : 3) * sizeof(int);
    const size_t planes = plane_bytes(path_rows) + plane_bytes(texture_planes_of(scene));
    return paths_per_item * (planes + lists);
}

// An item in a list of work, with its results.
size_t listed_bytes(const SceneData& scene)
{
    return results_per_item *
               (plane_bytes(result_rows()) + plane_bytes(texture_result_rows(scene))) +
           small_items * sizeof(WorkItem);
}

int listed_items(int items, int results_a_slot)
{
    return items * results_a_slot * (paths_per_item / results_per_item);
}

bool is_large(const std::string& name)
{
#define IS_NAMED(type, row, log_bytes) || name == #row
    return false LARGE_BUFFERS(IS_NAMED);
#undef IS_NAMED
}

// A buffer of the scene is one allocation, or some pages.
void check_allocation(const DeviceInfo& device, int shift, const std::string& name, size_t bytes)
{
    const size_t room =
        is_large(name) && shift > 0 ? size_t(LARGE_PAGES) << shift : device.largest_allocation;
    if (bytes > room)
        throw std::runtime_error(
            "opencl: " + device.name + ": the scene's " + name + " need " + amount(bytes) +
            ", the device allocates at most " + amount(device.largest_allocation) + " at once" +
            (is_large(name) ? "; " + std::to_string(LARGE_PAGES) + " pages hold " + amount(room)
                            : "") +
            "; simplify the scene or use --backend cpu");
}

// Of the buffers that a dispatch needs, the largest one's share of an item.
size_t widest_buffer(const SceneData& scene, int results_a_slot)
{
    const auto widest = [](int entries, const auto& rows) {
        int components = 1;
        for (const auto& row : rows) components = std::max(components, row.components);
        return sizeof(float) * size_t(components) * size_t(entries);
    };
    const int results = paths_per_item * results_a_slot;
    return std::max({widest(paths_per_item, path_rows),
                     widest(paths_per_item, texture_planes_of(scene)),
                     widest(results, result_rows()), widest(results, texture_result_rows(scene))});
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

int page_shift(const DeviceInfo& device, const SceneData& scene)
{
    size_t largest = 0;
#define FIND_LARGEST(type, name, log_bytes)                \
    static_assert(sizeof(type) == size_t(1) << log_bytes); \
    largest = std::max(largest, scene.name.size() * sizeof(type));
    LARGE_BUFFERS(FIND_LARGEST)
#undef FIND_LARGEST
    return largest > device.largest_allocation ? int(std::bit_width(device.largest_allocation)) - 1
                                               : 0;
}

SceneMemory upload_scene(const opencl::Context& context, opencl::Queue& queue,
                         const DeviceInfo& device, const SceneData& scene)
{
    SceneMemory memory;
    const int shift = page_shift(device, scene);
    const size_t page = shift > 0 ? size_t(1) << shift : ~size_t(0);
    const auto upload = [&](const char* name, const void* data, size_t bytes) {
        opencl::Buffer buffer = context.buffer(bytes, name);
        queue.write(buffer, bytes, data);
        return buffer;
    };
    // kernels may read element 0 of a buffer that the scene has no use for
#define UPLOAD(type, name)                                                         \
    {                                                                              \
        const type nothing = {};                                                   \
        const size_t bytes = scene.name.size() * sizeof(type);                     \
        const void* data = scene.name.empty() ? &nothing : scene.name.data();      \
        check_allocation(device, shift, #name, bytes);                             \
        const size_t whole = is_large(#name) ? std::min(bytes, page) : bytes;      \
        memory.rows.push_back(upload(#name, data, std::max(whole, sizeof(type)))); \
    }
    SCENE_BUFFERS(UPLOAD)
#undef UPLOAD
    const auto upload_pages = [&](const char* name, const void* data, size_t bytes) {
        for (size_t k = 1; k < LARGE_PAGES; ++k) {
            const size_t first = k * (bytes > page ? page : bytes);
            opencl::Buffer buffer;
            if (first < bytes)
                buffer = upload(name, static_cast<const char*>(data) + first,
                                std::min(bytes - first, page));
            memory.pages.push_back(std::move(buffer));
        }
    };
#define UPLOAD_PAGES(type, name, log_bytes) \
    upload_pages(#name, scene.name.data(), scene.name.size() * sizeof(type));
    LARGE_BUFFERS(UPLOAD_PAGES)
#undef UPLOAD_PAGES
    return memory;
}

DispatchMemory::DispatchMemory(const opencl::Context& context, const SceneData& scene,
                               const Plan& plan, int group_size)
    : paths(plan.items * paths_per_item), results(plan.most_items * results_per_item),
      path_planes(planes(context, path_rows, paths)),
      result_planes(planes(context, result_rows(), results)),
      texture_planes(planes(context, texture_planes_of(scene), paths)),
      texture_result_rows(diptych::texture_result_rows(scene)),
      texture_result_planes(planes(context, texture_result_rows, results)),
      items(context.buffer(sizeof(WorkItem) * small_items * size_t(plan.most_items), "items"))
{
    for (opencl::Buffer& list : live) list = context.buffer(sizeof(int) * size_t(paths), "live");
    if (has_rounds(scene))
        for (opencl::Buffer& list : waiting)
            list = context.buffer(sizeof(int) * size_t(paths), "waiting");
    const int groups = (paths + group_size - 1) / group_size;
    sums = context.buffer(sizeof(int) * size_t(groups), "sums");
    total = context.buffer(sizeof(int), "total");
}

size_t bytes_of(std::span<const opencl::Buffer> buffers)
{
    size_t bytes = 0;
    for (const opencl::Buffer& buffer : buffers) bytes += buffer.bytes();
    return bytes;
}

size_t DispatchMemory::bytes() const
{
    return bytes_of(path_planes) + bytes_of(result_planes) + bytes_of(texture_planes) +
           bytes_of(texture_result_planes) + bytes_of(live) + bytes_of(waiting) + items.bytes() +
           sums.bytes() + total.bytes();
}

// Written, not filled, and whole: Oclgrind notices neither that fills initialise nor where in a
// buffer a part is written.
void DispatchMemory::clear_texture_results(opencl::Queue& queue) const
{
    for (const opencl::Buffer& buffer : texture_result_planes) {
        const std::vector<char> nothing(buffer.bytes());
        queue.write(buffer, nothing.size(), nothing.data());
    }
}

namespace {

// use(values, row, buffer) for every row of results.
template<class Rows, class Use>
void for_result_rows(const DispatchMemory& memory, Rows& rows, const Use& use)
{
    size_t row = 0;
#define USE_ROW(type, name) use(rows.name, result_rows()[row], memory.result_planes[row]), ++row;
    RESULT_BUFFERS(USE_ROW)
#undef USE_ROW
    row = 0;
#define USE_ROW(type, name) \
    use(rows.name, memory.texture_result_rows[row], memory.texture_result_planes[row]), ++row;
    TEXTURE_RESULT_BUFFERS(USE_ROW)
#undef USE_ROW
}

}  // namespace

void DispatchMemory::read_results(opencl::Queue& queue, Results& rows, int first, int count) const
{
    for_result_rows(*this, rows, [&](auto& to, const PlaneRow& row, const opencl::Buffer& buffer) {
        to.resize(size_t(row.components) * size_t(count));
        const size_t element = sizeof to[0];
        for (size_t c = 0; c < size_t(row.components); ++c)
            queue.read(buffer, element * size_t(count), to.data() + c * size_t(count),
                       element * (c * size_t(results) + size_t(first)));
    });
}

void DispatchMemory::write_results(opencl::Queue& queue, const Results& rows, int count) const
{
    for_result_rows(
        *this, rows, [&](const auto& from, const PlaneRow& row, const opencl::Buffer& buffer) {
            const size_t element = sizeof from[0];
            for (size_t c = 0; c < size_t(row.components); ++c)
                queue.write(buffer, element * size_t(count), from.data() + c * size_t(count),
                            element * c * size_t(results));
        });
}

Plan plan_memory(const DeviceInfo& device, const SceneData& scene, size_t memory_bytes)
{
    const int shift = page_shift(device, scene);
#define CHECK_ROW(type, name) \
    check_allocation(device, shift, #name, scene.name.size() * sizeof(type));
    SCENE_BUFFERS(CHECK_ROW)
#undef CHECK_ROW
    Plan plan;
    plan.texture_bytes = texel_bytes_of(scene);
    plan.scene_bytes = bytes_of(scene) - plan.texture_bytes;
    plan.structure_bytes = structure_bytes(scene);
    const size_t taken = plan.bytes();
    const size_t budget = std::min(memory_bytes, device.memory_bytes);
    const auto needed = [&](int results_a_slot) {
        return slots_bytes(scene) + size_t(listed_items(1, results_a_slot)) * listed_bytes(scene);
    };
    const size_t least = needed(least_results_per_slot);
    if (budget < taken + least)
        throw std::runtime_error(
            "opencl: " + device.name + ": " + amount(budget) + " do not hold the scene (" +
            amount(taken) + ") and one block of paths (" + amount(least) + "); " +
            (budget < memory_bytes ? "choose a device with more memory" : "raise --memory"));
    const size_t narrowest = widest_buffer(scene, least_results_per_slot);
    if (device.largest_allocation < narrowest)
        throw std::runtime_error("opencl: " + device.name + ": allocates at most " +
                                 amount(device.largest_allocation) +
                                 " at once, one block of paths needs " + amount(narrowest) +
                                 "; choose another device or --backend cpu");
    const int most = device.is_cpu ? most_items_of_cpu : most_items;
    const auto items_of = [&](int results_a_slot) {
        return int(std::min({(budget - taken) / needed(results_a_slot),
                             device.largest_allocation / widest_buffer(scene, results_a_slot),
                             size_t(most)}));
    };
    const int results_a_slot =
        items_of(results_per_slot) > 0 ? results_per_slot : least_results_per_slot;
    plan.items = items_of(results_a_slot);
    plan.most_items = listed_items(plan.items, results_a_slot);
    plan.path_bytes = size_t(plan.items) * slots_bytes(scene);
    plan.film_bytes = size_t(plan.most_items) * listed_bytes(scene);
    return plan;
}

}  // namespace diptych
