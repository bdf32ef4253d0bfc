#include "backends/cpu_backend.hpp"

#include "backends/bvh_build.hpp"
#include "backends/scene_view.hpp"
#include "backends/textures/native_stage.hpp"
#include "kernels_cpu/chunk.hpp"
#include "kernels_cpu/parallel_for.hpp"
#include "kernels_cpu/stage_tracer.hpp"
#include "kernels_cpu/texture_rays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace diptych {
namespace {

#define COUNT_ROW(...) +1
constexpr int result_rows = 0 RESULT_BUFFERS(COUNT_ROW);
constexpr int texture_result_rows = 0 TEXTURE_RESULT_BUFFERS(COUNT_ROW);

// Of an environment: the rows' shares, the column's in each, the only node's brightness.
const float two_cells[] = {0, 0.5f, 1, 0, 1, 0, 1, 0};

class CpuBackend final : public Backend {
public:
    CpuBackend(const KernelSet& kernels, const BackendOptions& options)
        : kernels_(kernels), options_(options),
          threads_(options.threads > 0 ? options.threads
                                       : std::max(1, int(std::thread::hardware_concurrency()))),
          uses_embree_(kernels.loop(STAGE_intersect, 0) == nullptr)
    {
    }

    std::string description() const override
    {
        return fmt::format("{} kernels, {}, {} threads", kernels_.name,
                           uses_embree_ ? EmbreeScene::version() : "own BVH walk", threads_);
    }

    Plan plan(const SceneData& scene) const override
    {
        Plan plan;
        plan.texture_bytes = texel_bytes_of(scene);
        plan.scene_bytes = bytes_of(scene) - plan.texture_bytes;
        // Embree's high-quality tree takes about 100 bytes a triangle, ours 64 a node and 4 an
        // item.
        plan.structure_bytes = scene.triangles.size() * (uses_embree_ ? 100 : 40);
        const auto of_textures = texture_result_planes(scene);
        const int planes = std::accumulate(of_textures.begin(), of_textures.end(), result_rows + 6);
        const size_t result_bytes = size_t(planes) * kernels_.real_bytes << (2 * BLOCK_SHIFT);
        const size_t chunk_bytes = size_t(chunk_paths) * 80 * kernels_.real_bytes;
        const size_t fixed = chunk_bytes * threads_;
        if (options_.memory_bytes < fixed + result_bytes)
            throw std::runtime_error(fmt::format("--memory: {} KiB do not hold the paths of {} "
                                                 "threads and one block ({} KiB); raise "
                                                 "it or lower --threads",
                                                 options_.memory_bytes >> 10, threads_,
                                                 ((fixed + result_bytes) >> 10) + 1));
        const size_t room = options_.memory_bytes - fixed;
        // Beyond some hundred items a dispatch gains nothing: they run one after the other anyway.
        plan.items = int(std::clamp<size_t>(room / (4 * result_bytes), 1, 128));
        plan.most_items = plan.items;
        plan.path_bytes = fixed;
        plan.film_bytes = size_t(plan.items) * result_bytes;
        return plan;
    }

    void upload(SceneData& scene) override;
    void update_materials(const SceneData& scene) override;
    void update_textures(const SceneData& scene) override;
    void render(const Dispatch& dispatch, Results& results) override;
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override;
    Statistics statistics() const override;

private:
    void bind(const SceneData& scene);
    void add_neutral(const SceneData& scene);
    void build_embree(const SceneData& scene);
    void build_textures(const SceneData& scene);
    PathView view_results(const Dispatch& dispatch);
    std::unique_ptr<Chunk> borrow_chunk();
    void return_chunk(std::unique_ptr<Chunk> chunk);

    const KernelSet& kernels_;
    BackendOptions options_;
    int threads_;
    bool uses_embree_;

    const SceneData* scene_ = nullptr;
    std::vector<const void*> buffers_;
    SceneView scene_view_;
    Settings neutral_settings_;
    std::vector<uint> neutral_normals_;
    std::vector<uint> neutral_tangents_;
    std::vector<float4> neutral_colors_;
    std::unique_ptr<EmbreeScene> embree_;
    std::unique_ptr<NativeStage> textures_;

    std::vector<unsigned char> result_memory_;
    std::vector<void*> result_planes_;
    std::vector<void*> texture_result_planes_;
    std::mutex chunks_mutex_;
    std::vector<std::unique_ptr<Chunk>> chunks_;
    double setup_seconds_ = 0;
    unsigned long long paths_ = 0;
};

int result_components(int row)
{
    static constexpr int components[] = {
#define COMPONENTS(type, name) (#type[0] == 'f' && #type[5] == '3') ? 3 : 1,
        RESULT_BUFFERS(COMPONENTS)};
    return components[row];
}

bool is_real_texture_result(int row)
{
    static constexpr bool is_real[] = {
#define IS_REAL(type, name) #type[0] == 'f',
        TEXTURE_RESULT_BUFFERS(IS_REAL)
#undef IS_REAL
    };
    return is_real[row];
}

bool is_real_result(int row)
{
    static constexpr bool is_real[] = {
#define IS_REAL(type, name) #type[0] == 'f',
        RESULT_BUFFERS(IS_REAL)};
    return is_real[row];
}

void CpuBackend::upload(SceneData& scene)
{
    const auto start = std::chrono::steady_clock::now();
    chunks_.clear();
    paths_ = 0;
    scene_ = &scene;
    if (!uses_embree_ && scene.bvh_nodes.empty()) build_bvh(scene);
    bind(scene);
    add_neutral(scene);
    if (uses_embree_) build_embree(scene);
    build_textures(scene);
    setup_seconds_ =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void CpuBackend::bind(const SceneData& scene)
{
    const std::vector<const void*> buffers = buffers_of(scene);
    buffers_.assign(buffers.begin(), buffers.end());  // in place: chunks know where they lie
    scene_view_.effects = scene.effects;
    scene_view_.buffers = buffers_.data();
}

// A vectorised loop may be compiled for more effects than the scene has; what it then reads at
// every vertex must exist and mean nothing.
void CpuBackend::add_neutral(const SceneData& scene)
{
    const unsigned covered = kernels_.covered_effects(scene.effects);
    neutral_settings_ = scene.settings.at(0);
    if (neutral_settings_.environment_width == 0) {  // one black texel, two cells
        neutral_settings_.environment_width = neutral_settings_.environment_height = 1;
        neutral_settings_.cell_columns = 1;
        neutral_settings_.cell_rows = 2;
        neutral_settings_.environment_scale = make_float4(0, 0, 0, 0);
    }
    buffers_[0] = &neutral_settings_;
    const size_t vertices = scene.positions.size();
    const auto replace = [&](auto& neutral, const auto& own, auto value, int row) {
        if (!own.empty()) return;
        neutral.assign(std::max<size_t>(vertices, 1), value);
        buffers_[row] = neutral.data();
    };
    int row = 0;
    int normals = 0, tangents = 0, colors = 0, cells = 0;
#define FIND_ROW(type, name)                                         \
    if (std::string_view(#name) == "normals") normals = row;         \
    if (std::string_view(#name) == "tangents") tangents = row;       \
    if (std::string_view(#name) == "colors") colors = row;           \
    if (std::string_view(#name) == "environment_cells") cells = row; \
    ++row;
    SCENE_BUFFERS(FIND_ROW)
    if (scene.environment_cells.empty()) buffers_[cells] = two_cells;
    if (covered & EFFECT_SMOOTH_NORMALS)
        replace(neutral_normals_, scene.normals, NORMAL_FLAT, normals);
    if (covered & EFFECT_NORMAL_MAP) replace(neutral_tangents_, scene.tangents, 0u, tangents);
    if (covered & EFFECT_VERTEX_COLOR)
        replace(neutral_colors_, scene.colors, make_float4(1, 1, 1, 1), colors);
}

void CpuBackend::build_embree(const SceneData& scene)
{
    std::vector<EmbreeMesh> meshes;
    for (size_t k = 0; k < scene.instances.size(); ++k) {
        const Instance& instance = scene.instances[k];
        const Triangle* triangles = scene.triangles.data() + instance.first_triangle;
        meshes.push_back({reinterpret_cast<const float*>(scene.positions.data()),
                          scene.positions.size(), reinterpret_cast<const int*>(triangles),
                          instance.triangle_count, instance.first_triangle,
                          k == 0 ? nullptr : &instance.to_world_x.x});
    }
    embree_.reset();
    embree_ =
        std::make_unique<EmbreeScene>(meshes.data(), int(meshes.size()), threads_, scene.effects);
}

void CpuBackend::build_textures(const SceneData& scene)
{
    if ((scene.effects & EFFECT_PROCEDURAL) == 0) {
        scene_view_.textures = nullptr;
        return;
    }
    NativeStageOptions options;
    options.kind = kernels_.real_bytes == 8 ? NativeStageKind::reference
                   : uses_embree_           ? NativeStageKind::vector
                                            : NativeStageKind::scalar;
    options.is_debug = options_.debug_textures;
    options.generated_dir = options_.generated_dir;
    options.use_generated = options_.use_generated;
    auto stage = std::make_unique<NativeStage>(scene, options);
    chunks_.clear();  // they run the old one
    paths_ = 0;
    textures_ = std::move(stage);
    if (uses_embree_) textures_->set_tracer(trace_texture_ray_by_ray, embree_.get());
    scene_view_.textures = &textures_->kernels();
}

// The kernels read the scene where the host has it.
void CpuBackend::update_materials(const SceneData& scene)
{
    scene_ = &scene;
    bind(scene);
    add_neutral(scene);
}

void CpuBackend::update_textures(const SceneData& scene) { build_textures(scene); }

PathView CpuBackend::view_results(const Dispatch& dispatch)
{
    const int entries = dispatch.results();
    size_t bytes = 0;
    std::vector<size_t> offsets;
    const auto reserve = [&](bool is_real, int planes) {
        offsets.push_back(bytes);
        const size_t element = is_real ? size_t(kernels_.real_bytes) : 4;
        bytes += element * size_t(planes) * size_t(entries);
        bytes = (bytes + 63) & ~size_t(63);
    };
    for (int row = 0; row < result_rows; ++row)
        reserve(is_real_result(row), result_components(row));
    for (int row = 0; row < texture_result_rows; ++row)
        reserve(is_real_texture_result(row), texture_result_planes(*scene_)[size_t(row)]);
    result_memory_.assign(bytes + 64, 0);
    auto* base =
        result_memory_.data() + (64 - reinterpret_cast<std::uintptr_t>(result_memory_.data()) % 64);
    result_planes_.clear();
    for (int row = 0; row < result_rows; ++row)
        result_planes_.push_back(base + offsets[size_t(row)]);
    texture_result_planes_.clear();
    for (int row = 0; row < texture_result_rows; ++row)
        texture_result_planes_.push_back(base + offsets[size_t(result_rows + row)]);
    int row = 0;
#define SET_IDS(type, name)                                               \
    if (std::string_view(#name).ends_with("_id"))                         \
        std::fill_n(static_cast<int*>(result_planes_[row]), entries, -1); \
    ++row;
    RESULT_BUFFERS(SET_IDS)
    PathView view;
    view.results = entries;
    view.samples = dispatch.samples;
    view.pixel_shift = dispatch.pixel_shift;
    view.items = dispatch.items.data();
    view.result_planes = result_planes_.data();
    view.texture_result_planes = texture_result_planes_.data();
    return view;
}

template<class To>
void narrow(std::vector<To>& out, const void* plane, size_t count, bool is_double)
{
    out.resize(count);
    if (is_double)
        std::copy_n(static_cast<const double*>(plane), count, out.begin());
    else
        std::copy_n(static_cast<const To*>(plane), count, out.begin());
}

void CpuBackend::render(const Dispatch& dispatch, Results& results)
{
    const PathView view = view_results(dispatch);
    const int items = int(dispatch.items.size());
    const int at_once = std::clamp(items / (4 * threads_), 1,
                                   Chunk::items_at_once(dispatch.samples, dispatch.pixel_shift));
    parallel_for(threads_, (items + at_once - 1) / at_once, [&](int k) {
        std::unique_ptr<Chunk> chunk = borrow_chunk();
        const int first = k * at_once;
        chunk->run(view, first, std::min(at_once, items - first));
        return_chunk(std::move(chunk));
    });
    paths_ += paths_in_picture(dispatch, items, scene_->settings[0]);
    int row = 0;
#define COPY_RESULT(type, name)                                         \
    narrow(results.name, result_planes_[row],                           \
           size_t(result_components(row)) * size_t(dispatch.results()), \
           is_real_result(row) && kernels_.real_bytes == 8);            \
    ++row;
    RESULT_BUFFERS(COPY_RESULT)
#undef COPY_RESULT
    row = 0;
#define COPY_RESULT(type, name)                                                      \
    narrow(results.name, texture_result_planes_[row],                                \
           size_t(texture_result_planes(*scene_)[row]) * size_t(dispatch.results()), \
           is_real_texture_result(row) && kernels_.real_bytes == 8);                 \
    ++row;
    TEXTURE_RESULT_BUFFERS(COPY_RESULT)
#undef COPY_RESULT
}

std::unique_ptr<Chunk> CpuBackend::borrow_chunk()
{
    const std::lock_guard lock(chunks_mutex_);
    if (chunks_.empty()) return std::make_unique<Chunk>(kernels_, embree_.get(), scene_view_);
    std::unique_ptr<Chunk> chunk = std::move(chunks_.back());
    chunks_.pop_back();
    return chunk;
}

void CpuBackend::return_chunk(std::unique_ptr<Chunk> chunk)
{
    const std::lock_guard lock(chunks_mutex_);
    chunks_.push_back(std::move(chunk));
}

void CpuBackend::trace(const Dispatch& dispatch,
                       const std::function<void(const StageState&)>& after_stage)
{
    StageTracer tracer(kernels_, embree_.get(), scene_view_, view_results(dispatch),
                       dispatch.paths());
    tracer.run([&](Stage stage, int bounce, std::vector<std::vector<double>> planes) {
        StageState state{stage, bounce, dispatch.paths(), std::move(planes)};
        state.texture_results = tracer.texture_results(stage);
        after_stage(state);
    });
}

Statistics CpuBackend::statistics() const
{
    Statistics statistics;
    statistics.setup_seconds = setup_seconds_;
    statistics.paths = paths_;
    statistics.allocated_bytes = result_memory_.size();
    for (const auto& chunk : chunks_) {
#define ADD_STAGE(name, body, when, needs) \
    statistics.stage_seconds[#name] += chunk->stage_seconds[STAGE_##name];
        STAGES(ADD_STAGE)
        statistics.rays += chunk->rays;
        statistics.shadow_rays += chunk->shadow_rays;
        statistics.undecided_rays += chunk->undecided_rays;
        statistics.allocated_bytes += chunk->bytes();
        statistics.slot_steps += chunk->slot_steps;
        statistics.busy_steps += chunk->busy_steps;
    }
    return statistics;
}

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(const KernelSet& kernels, const BackendOptions& options)
{
    return std::make_unique<CpuBackend>(kernels, options);
}

}  // namespace diptych
