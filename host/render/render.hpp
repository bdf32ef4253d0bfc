// Walks the film in dispatches and gathers what comes back.
#pragma once

#include "host/render/film.hpp"

#include <atomic>
#include <functional>
#include <optional>

namespace diptych {

struct Pixel {
    int x;
    int y;
};

struct Progress {
    double fraction;
    double seconds;
    int samples;  // a pixel's, of the pass under way
    unsigned long long rays;
};

struct RenderOptions {
    int samples = 64;
    std::optional<Pixel> pixel;  // only this one
    std::function<void(const Progress&)> progress;
    const std::atomic<bool>* stop = nullptr;  // looked at between dispatches
};

struct RenderResult {
    Film film;
    Plan plan;
    Statistics statistics;
    double seconds = 0;
    bool is_complete = true;
};

// Samples in quanta of 1, 2, 4, 8 or 16 a pixel: work item by work item, film blocks in Morton
// order, one pass over the film a quantum. The picture depends neither on the dispatch size nor on
// threads. scene: uploaded to the backend before; settings[0] holds picture size and seed.
RenderResult render(Backend& backend, const SceneData& scene, const RenderOptions& options);

// The quanta of a render, in order: first sample and number of samples (a power of two).
struct Quantum {
    int first_sample;
    int samples;
};
std::vector<Quantum> quanta_of(int samples);

// Lowest pixels of the film's blocks in Morton order.
std::vector<Pixel> blocks_of(int width, int height);

}  // namespace diptych
