// Executes the scheduler's lists of work in dispatches and gathers what comes back.
#pragma once

#include "host/render/block_error.hpp"
#include "host/render/film.hpp"
#include "host/render/scheduler.hpp"

#include <atomic>
#include <functional>
#include <optional>

namespace diptych {

struct Progress {
    double fraction;
    double seconds;
    int samples;  // a pixel's, of the pass under way
    unsigned long long rays;
    double error = 0;  // adaptive: 95 % of the blocks predicted less at the last round's end, JND
    double seconds_left = 0;  // from the trend of what is measured: samples, or error, or the limit
};

// Where a render stands; what it needs to go on.
struct RenderState {
    Film film;
    Schedule schedule;
};

// Beyond this many samples of a pixel a render with an error target gives up.
inline constexpr int most_adaptive_samples = 1 << 16;

enum class Ending { TargetReached, SamplesDone, TimeOver, Interrupted };

struct RenderOptions {
    int samples = 64;            // the render ends before this sample of each pixel
    int first_sample = 0;        // and begins with this one, a multiple of QUANTUM
    std::optional<Pixel> pixel;  // only this one
    // Adaptive: blocks end when their predicted error is below `error` JND. A time limit alone
    // lowers a target again and again. Whichever comes first ends the render, `samples` as well.
    double error = 0;       // 0: none
    double share = 1;       // of the blocks: so many below the target are enough
    double time_limit = 0;  // seconds; 0: none. Each pixel gets a sample whatever it says
    bool is_unbiased = false;
    image::Viewer viewer;
    std::function<void(const Progress&)> progress;
    std::function<void(const RenderState&)> observe;  // after every dispatch, on this thread
    int most_items = 0;                               // in a dispatch; 0: what the backend plans
    const std::atomic<bool>* stop = nullptr;          // looked at between dispatches, or more often
    bool stops_at_once = false;  // does not wait for paths under way; they are lost
    // What a backend throws (std::runtime_error) goes there, and the render ends as if interrupted;
    // without it, it is thrown on.
    std::string* failure = nullptr;
};

struct RenderResult {
    Film film;
    Schedule schedule;
    Plan plan;
    Statistics statistics;
    double seconds = 0;
    bool is_complete = true;  // false: interrupted
    Ending ending = Ending::SamplesDone;
    double target = 0;          // JND that all blocks were to reach when it ended; 0: uniform
    int unfinished_blocks = 0;  // above the target; with `share` some may be when it is reached
    int blocks = 0;
    int most_samples = 0;           // a pixel's, that the render would have ended at
    double scheduling_seconds = 0;  // merging, errors and decisions
};

bool is_adaptive(const RenderOptions& options);

// The sample plan. One with a time limit begins with small quanta: a first picture is there soon.
std::vector<Quantum> plan_of(const RenderOptions& options);

// How the film is divided: small pictures of an adaptive render into blocks of half the side.
BlockGrid grid_of(const Settings& settings, const RenderOptions& options);

// The blocks by which the error of a whole picture is summed up, uniform or adaptive.
BlockGrid error_grid(const Settings& settings);

// What the film will take on the host.
size_t film_bytes(const SceneData& scene, const RenderOptions& options);

// What the picture that is made of it at the end will take beside it.
size_t picture_bytes(const SceneData& scene, const RenderOptions& options);

// The state in which a render with these options begins: nothing rendered.
RenderState fresh_state(const SceneData& scene, const RenderOptions& options);

// Samples in quanta of 1, 2, 4, 8 or 16 a pixel, block by block. The picture depends neither on the
// dispatch size nor on threads nor on where a render was interrupted and resumed. scene: uploaded
// to the backend before; settings[0] holds picture size and seed. resume: of a render with the same
// options; it may have had a shorter plan.
RenderResult render(Backend& backend, const SceneData& scene, const RenderOptions& options,
                    std::optional<RenderState> resume = std::nullopt);

}  // namespace diptych
