// Rays per second of a whole render beside Embree's alone, on the same rays in the same packets.
// Usage: bench_rays SCENE
//
// The rays of a render are recorded: for all paths that the cpu backend runs together, the
// closest-hit rays and the shadow rays of each bounce. They are then replayed, on as many threads,
// through EmbreeScene as the renderer calls it, and through bare calls of Embree without what
// exactness costs: no filter that decides ties, no robust traversal, and nothing of the paths.
#include "backends/backend.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "host/render/render.hpp"
#include "host/scene/load.hpp"
#include "kernels_cpu/chunk.hpp"
#include "kernels_cpu/parallel_for.hpp"
#include "tests/bench/bare_embree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <sys/resource.h>

namespace diptych {
namespace {

constexpr int width = 512, height = 512;
constexpr int samples = chunk_paths >> (2 * BLOCK_SHIFT);  // of a block: one chunk of paths
constexpr int repetitions = 4;
constexpr int threads = 2;

// The planes of paths that Embree's stages read, for the rays of one bounce of a chunk.
struct Batch {
    int count = 0;
    int bounce = 0;
    bool is_shadow = false;
    // Closest hits: depth. Shadow rays: light_contribution.x, which says that there is a ray.
    std::vector<float> origin{}, direction{}, distance{}, contribution{};
    std::vector<int> depth{};

    int capacity() const { return count + 16; }  // packets read whole
};

std::vector<float> gather(const std::vector<double>& plane, const std::vector<int>& lanes,
                          int components, int paths, int capacity)
{
    std::vector<float> out(size_t(components) * size_t(capacity));
    for (int c = 0; c < components; ++c)
        for (size_t k = 0; k < lanes.size(); ++k)
            out[size_t(c) * size_t(capacity) + k] =
                float(plane[size_t(c) * size_t(paths) + size_t(lanes[k])]);
    return out;
}

Batch closest_rays(const StageState& state)
{
    std::vector<int> lanes;
    for (int i = 0; i < state.paths; ++i)
        if (state.planes[row_depth][size_t(i)] >= 0) lanes.push_back(i);
    Batch batch{.count = int(lanes.size()), .bounce = state.bounce};
    const int n = batch.capacity();
    batch.origin = gather(state.planes[row_ray_origin], lanes, 3, state.paths, n);
    batch.direction = gather(state.planes[row_ray_direction], lanes, 3, state.paths, n);
    batch.depth.assign(size_t(n), 0);
    return batch;
}

Batch shadow_rays(const StageState& state)
{
    const std::vector<double>& light = state.planes[row_light_contribution];
    const size_t n = size_t(state.paths);
    std::vector<int> lanes;
    for (size_t i = 0; i < n; ++i)
        if (light[i] > 0 || light[n + i] > 0 || light[2 * n + i] > 0) lanes.push_back(int(i));
    Batch batch{.count = int(lanes.size()), .bounce = state.bounce, .is_shadow = true};
    const int capacity = batch.capacity();
    batch.origin = gather(state.planes[row_shadow_origin], lanes, 3, state.paths, capacity);
    batch.direction = gather(state.planes[row_shadow_direction], lanes, 3, state.paths, capacity);
    batch.distance = gather(state.planes[row_shadow_distance], lanes, 1, state.paths, capacity);
    batch.contribution.assign(3 * size_t(capacity), 1.0f);
    return batch;
}

// The rays of each chunk of the render, in the order of the film's blocks.
std::vector<std::vector<Batch>> record(Backend& backend)
{
    std::vector<std::vector<Batch>> chunks;
    for (const Pixel& block : blocks_of(width, height)) {
        std::vector<Batch>& batches = chunks.emplace_back();
        const WorkItem item{block.x, block.y, 0, 0};
        // Rays are what a stage reads, so they are taken from the state before it.
        StageState before;
        backend.trace({{&item, 1}, samples}, [&](const StageState& state) {
            if (state.stage == STAGE_intersect) {
                before.bounce = state.bounce;
                batches.push_back(closest_rays(before));
            }
            if (state.stage == STAGE_occlusion) batches.push_back(shadow_rays(before));
            before = state;
        });
    }
    return chunks;
}

// Replays batches through the renderer's own calls. One for each chunk being replayed.
class Replay {
public:
    Replay(const EmbreeScene& embree, const SceneView& scene)
        : embree_(embree), scene_(scene), planes_(path_row_count), hits_(2 * (chunk_paths + 16))
    {
    }

    void run(const Batch& batch)
    {
        const auto set = [&](PathRowName row, const void* plane) {
            planes_[row] = const_cast<void*>(plane);
        };
        PathView view;
        view.capacity = batch.capacity();
        view.planes = planes_.data();
        set(row_is_occluded, hits_.data());
        set(row_hit_triangle, hits_.data());
        set(row_hit_instance, hits_.data() + chunk_paths + 16);
        if (batch.is_shadow) {
            set(row_shadow_origin, batch.origin.data());
            set(row_shadow_direction, batch.direction.data());
            set(row_shadow_distance, batch.distance.data());
            set(row_light_contribution, batch.contribution.data());
            embree_.occlusion(scene_, view, batch.count);
        } else {
            set(row_ray_origin, batch.origin.data());
            set(row_ray_direction, batch.direction.data());
            set(row_depth, batch.depth.data());
            embree_.intersect(scene_, view, batch.count, batch.bounce == 0);
        }
    }

private:
    const EmbreeScene& embree_;
    SceneView scene_;
    std::vector<void*> planes_;
    std::vector<int> hits_;
};

void run_bare(const BareEmbree& embree, const Batch& batch)
{
    const BareRays rays{batch.count, batch.capacity(), batch.origin.data(), batch.direction.data(),
                        batch.is_shadow ? batch.distance.data() : nullptr};
    if (batch.is_shadow)
        embree.occlude(rays);
    else
        embree.intersect(rays, batch.bounce == 0);
}

std::vector<EmbreeMesh> meshes_of(const SceneData& scene)
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
    return meshes;
}

double processor_seconds()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Arm {
    const char* name;
    std::function<void()> run;
    double wall = 1e30, processor = 1e30;  // least of the repetitions
};

void time_interleaved(std::vector<Arm>& arms)
{
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        for (Arm& arm : arms) {
            const auto start = std::chrono::steady_clock::now();
            const double before = processor_seconds();
            arm.run();
            arm.processor = std::min(arm.processor, processor_seconds() - before);
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            arm.wall = std::min(arm.wall, elapsed.count());
        }
    }
}

SceneData load(const char* file)
{
    LoadOptions options;
    options.width = width;
    options.height = height;
    SceneData scene = load_scene(file, options);
    scene.settings[0].seed = 1;
    scene.settings[0].max_bounces = 64;
    if (scene.effects & EFFECT_ALPHA)
        throw std::runtime_error(fmt::format(
            "{}: alpha: its rays ask materials, which a replay does not; give another scene",
            file));
    return scene;
}

void print(const std::vector<Arm>& arms, double rays)
{
    fmt::print("  {:<44}  Mrays/s    CPU ns a ray  render is\n", "");
    for (const Arm& arm : arms)
        fmt::print("  {:<44}  {:7.2f}  {:14.1f}  {:9.3f}\n", arm.name, rays / arm.wall * 1e-6,
                   arm.processor / rays * 1e9, arm.processor / arms.front().processor);
}

void run(const char* file)
{
    SceneData scene = load(file);
    BackendOptions options;
    options.threads = threads;
    const std::unique_ptr<Backend> backend = make_backend("cpu", options);
    backend->upload(scene);
    const std::vector<std::vector<Batch>> chunks = record(*backend);
    long closest = 0, shadow = 0;
    for (const auto& batches : chunks)
        for (const Batch& batch : batches) (batch.is_shadow ? shadow : closest) += batch.count;

    const std::vector<EmbreeMesh> meshes = meshes_of(scene);
    const EmbreeScene embree(meshes.data(), int(meshes.size()), threads, false);
    const BareEmbree bare(meshes, threads, false), robust(meshes, threads, true);
    const std::vector<const void*> no_buffers(32);
    const SceneView view{scene.effects, no_buffers.data()};
    const auto replay = [&](const auto& body) {
        parallel_for(threads, int(chunks.size()), [&](int k) { body(chunks[size_t(k)]); });
    };
    const auto replay_bare = [&](const BareEmbree& with) {
        replay([&](const std::vector<Batch>& batches) {
            for (const Batch& batch : batches) run_bare(with, batch);
        });
    };
    RenderOptions whole;
    whole.samples = samples;
    std::vector<Arm> arms = {
        {"whole render", [&] { render(*backend, scene, whole); }},
        {"Embree as the renderer calls it",
         [&] {
             replay([&](const std::vector<Batch>& batches) {
                 Replay paths(embree, view);
                 for (const Batch& batch : batches) paths.run(batch);
             });
         }},
        {"bare Embree, robust: no tie-break", [&] { replay_bare(robust); }},
        {"bare Embree: no tie-break, not robust", [&] { replay_bare(bare); }},
    };
    time_interleaved(arms);

    const double rays = double(closest + shadow);
    fmt::print("{} x {}, {} samples, {} threads: {} closest-hit rays, {} shadow rays\n", width,
               height, samples, threads, closest, shadow);
    const Statistics statistics = backend->statistics();
    const double rendered = double(statistics.rays + statistics.shadow_rays) / repetitions;
    if (rendered != rays)
        fmt::print("  note: the render cast {:.0f} rays, {:+.3f} % of those recorded\n", rendered,
                   100 * (rendered / rays - 1));
    print(arms, rays);
    for (size_t k = 1; k < arms.size(); ++k)
        fmt::print("  whole render at {:.2f} of: {} ({:.2f} by processor time)\n",
                   arms[k].wall / arms[0].wall, arms[k].name,
                   arms[k].processor / arms[0].processor);
}

}  // namespace
}  // namespace diptych

int main(int count, char** arguments)
{
    if (count != 2) {
        fmt::print(stderr, "usage: bench_rays SCENE\n");
        return 2;
    }
    fmt::print("Rays per second of a whole render against Embree alone on the same rays.\n"
               "Goal: whole render at 0.75 or more of raw Embree.\n");
    try {
        diptych::run(arguments[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_rays: {}\n", error.what());
        return 1;
    }
}
