// How the host drives a device, whatever it is. The schedule (kernel launches, tasks, compaction)
// is the backend's own.
#pragma once

#include "backends/scene_data.hpp"

#include "common/stages/stages.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace diptych {

// A batch of work items, at most Plan::items of them, each with `samples` samples a pixel: a power
// of two up to QUANTUM.
struct Dispatch {
    std::span<const WorkItem> items;
    int samples = QUANTUM;
    int pixel_shift = 2 * BLOCK_SHIFT;  // or 0: an item is one pixel

    int paths() const { return int(items.size()) * samples << pixel_shift; }
    int results() const { return int(items.size()) << pixel_shift; }
};

// Whether a dispatch begins with what is under way, of so many samples and pixels each.
inline bool begins_with(const Dispatch& dispatch, std::span<const WorkItem> items, int samples,
                        int pixel_shift)
{
    const auto is_same = [](const WorkItem& a, const WorkItem& b) {
        return a.x == b.x && a.y == b.y && a.first_sample == b.first_sample;
    };
    return dispatch.samples == samples && dispatch.pixel_shift == pixel_shift &&
           items.size() <= dispatch.items.size() &&
           std::equal(items.begin(), items.end(), dispatch.items.begin(), is_same);
}

// How many paths of the first `items` of a dispatch have a pixel in the picture: blocks at its
// edges reach beyond.
inline unsigned long long paths_in_picture(const Dispatch& dispatch, int items,
                                           const Settings& picture)
{
    const int side = 1 << (dispatch.pixel_shift / 2);
    unsigned long long pixels = 0;
    for (const WorkItem& item : dispatch.items.first(size_t(items)))
        pixels += unsigned(std::min(side, picture.width - item.x)) *
                  unsigned(std::min(side, picture.height - item.y));
    return pixels * unsigned(dispatch.samples);
}

// Sums over the samples of each work item, a vector per result row; float3 rows are three planes of
// `results` entries, those of textures as many as texture_result_planes says. The double backend
// narrows on the way out.
struct Results {
#define RESULT_VECTOR(type, name) std::vector<PLANE(type)> name;
    RESULT_BUFFERS(RESULT_VECTOR)
    TEXTURE_RESULT_BUFFERS(RESULT_VECTOR)
#undef RESULT_VECTOR
};

// The state of all paths of a dispatch after one stage, widened to double; planes in the order of
// PATH_BUFFERS.
struct StageState {
    Stage stage;
    int bounce;
    int paths;
    std::vector<std::vector<double>> planes;  // empty for rows that no stage so far has defined
    // What a stage of textures gave, plane by plane: the row texture_row_of(stage).
    std::vector<double> texture_results = {};
};

// What a backend will allocate, known before it does.
struct Plan {
    // Work items whose paths are under way at once: M = items * QUANTUM << (2 * BLOCK_SHIFT) slots.
    // So many a call of trace() takes.
    int items = 0;
    int most_items = 0;  // that a dispatch may have: the slots of paths that end take the next ones
    size_t scene_bytes = 0;      // buffers of the scene, on the device, but for the next two
    size_t texture_bytes = 0;    // texels
    size_t structure_bytes = 0;  // acceleration structure, estimated where a library builds it
    size_t path_bytes = 0;       // path state
    size_t film_bytes = 0;       // blocks of the film that paths are summed in, on the device

    size_t bytes() const
    {
        return scene_bytes + texture_bytes + structure_bytes + path_bytes + film_bytes;
    }
};

// What one of several devices has rendered.
struct DeviceShare {
    std::string device;  // its description
    unsigned long long paths = 0;
    bool is_dropped = false;
};

// What becomes of a dispatch that is under way.
enum class Wish {
    go_on,
    leave,   // return now: what has begun goes on in the next dispatch
    finish,  // begin nothing new, and return when what has begun has ended
};

// How a long list of work is done piece by piece while paths stay under way.
struct Pace {
    size_t following = 0;        // items of equal size: no need to wait for the last paths
    std::function<Wish()> wish;  // asked often; none: go on to the end
};

// Counted and timed since upload().
struct Statistics {
    std::map<std::string, double> stage_seconds;  // summed over threads
    double setup_seconds = 0;                     // structures, programs
    // OpenCL's count every path that was launched, whether it still had a ray to trace or not.
    unsigned long long rays = 0;
    unsigned long long shadow_rays = 0;
    unsigned long long undecided_rays = 0;  // see most_alpha_layers
    unsigned long long paths = 0;
    size_t allocated_bytes = 0;  // of what a Plan counts but a library's structure; cpu: paths only
    // Of every step that all slots of a dispatch take together: slots, and those with a live path.
    // The lanes of packets where a processor takes them as they come.
    unsigned long long slot_steps = 0;
    unsigned long long busy_steps = 0;
    std::vector<DeviceShare> shares = {};  // where there are several devices
};

struct BackendOptions {
    // OpenCL: index or part of the name; empty: the first that works. Or a list, see
    // backends/device_list.hpp; --memory is then each device's.
    std::string device;
    int threads = 0;  // 0: as many as the machine has
    size_t memory_bytes = 512u << 20;
    double launch_milliseconds = 200;
    bool fast_math = false;       // opencl: allow contraction and native functions
    bool debug_kernels = false;   // twin: the library built for a debugger
    bool debug_textures = false;  // compile procedural textures for a debugger
    std::string generated_dir;    // also write the generated code of textures there
    std::string use_generated;    // run the (edited) code of textures that lies there instead
    std::string plant_fault;      // tests: name of a planted fault, see kernels_cl/faults.h
};

class Backend {
public:
    virtual ~Backend() = default;

    virtual std::string description() const = 0;  // "cpu (Embree 3.13.5, AVX2, 2 threads)"
    virtual Plan plan(const SceneData& scene) const = 0;
    // Completes the scene with the trees that the device walks, if it does. The scene must outlive
    // the backend's use of it.
    virtual void upload(SceneData& scene) = 0;

    // After upload(), of the same scene, in which nothing else has changed. The materials and the
    // arguments of textures behind them, as many as there were: moves bytes, compiles nothing.
    virtual void update_materials(const SceneData& scene) = 0;
    // The texture stage anew, from other texts of the same functions (same arguments, attributes
    // and requests). Throws like upload(); the backend then goes on with the stage it had.
    virtual void update_textures(const SceneData& scene) = 0;

    // Runs every stage for every path. The result of an item does not depend on what else is in the
    // dispatch. Adding samples to a result entry goes in ascending order, from zero (ids from -1).
    virtual void render(const Dispatch& dispatch, Results& results) = 0;

    // The same, but may return before the end: how many of the items, from the first on, are done;
    // `results` is then that of a dispatch of these. A next dispatch that begins with the others
    // goes on with what is under way, any other forgets it.
    virtual int advance(const Dispatch& dispatch, const Pace&, Results& results)
    {
        render(dispatch, results);
        return int(dispatch.items.size());
    }

    // The same, stage by stage without compaction, showing the state after each stage; for
    // comparison, not for speed.
    virtual void trace(const Dispatch& dispatch,
                       const std::function<void(const StageState&)>& after_stage) = 0;

    virtual Statistics statistics() const = 0;
};

// Names of the stages, by Stage.
inline constexpr const char* stage_names[] = {
#define STAGE_NAME(name, body, when, needs) #name,
    STAGES(STAGE_NAME)
#undef STAGE_NAME
};

// Names: cpu, opencl, twin, double; a list of devices is a backend whatever the name. Throws
// std::runtime_error for others, or when the device cannot be used.
std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options);

}  // namespace diptych
