#include "host/render/render.hpp"

#include <algorithm>
#include <chrono>

namespace diptych {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

BlockGrid grid_of(const Settings& settings, const RenderOptions& options)
{
    return options.pixel ? grid_of_pixel(settings.width, settings.height, *options.pixel)
                         : grid_of_blocks(settings.width, settings.height);
}

Window window_of(const Settings& settings, const RenderOptions& options)
{
    return options.pixel ? Window{options.pixel->x, options.pixel->y, 1, 1}
                         : Window{0, 0, settings.width, settings.height};
}

// One render: its plan, its state, and what a dispatch is made of.
class Render {
public:
    Render(Backend& backend, const SceneData& scene, const RenderOptions& options,
           RenderState state)
        : backend_(backend), options_(options), grid_(grid_of(scene.settings[0], options)),
          quanta_(quanta_of(options.first_sample, options.samples)), state_(std::move(state)),
          plan_(backend.plan(scene)), start_(Clock::now())
    {
        for (const BlockState& block : state_.schedule.blocks) done_ += block.quanta;
    }

    RenderResult run()
    {
        bool is_complete = false;
        while (finish_round() && !is_complete)
            is_complete = !begin_uniform_round(state_.schedule, int(quanta_.size()));
        const double room = double(dispatches_) * double(items_at_once());
        return {std::move(state_.film),
                std::move(state_.schedule),
                plan_,
                backend_.statistics(),
                seconds_since(start_),
                dispatches_ > 0 ? double(items_) / room : 1,
                is_complete};
    }

private:
    bool should_stop() const { return options_.stop && options_.stop->load(); }

    // A plan's items are blocks of the largest size.
    size_t items_at_once() const
    {
        if (options_.pixel) return 1;
        const size_t planned = size_t(std::max(1, plan_.items))
                               << (2 * BLOCK_SHIFT - grid_.pixel_shift());
        return options_.most_items > 0 ? std::min(planned, size_t(options_.most_items)) : planned;
    }

    // False when asked to stop before its end.
    bool finish_round()
    {
        const std::vector<Work> work = work_by_pass(state_.schedule);
        for (size_t first = 0; first < work.size();) {
            if (should_stop()) return false;
            const size_t count = dispatch_length(work, first, items_at_once(), quanta_);
            run_dispatch({work.data() + first, count});
            first += count;
        }
        return true;
    }

    void run_dispatch(std::span<const Work> work)
    {
        work_items_.clear();
        for (const Work& part : work) {
            const Pixel& corner = grid_.corners[size_t(part.block)];
            work_items_.push_back(
                {corner.x, corner.y, quanta_[size_t(part.quantum)].first_sample, 0});
        }
        const Quantum& last = quanta_[size_t(work.back().quantum)];
        const Dispatch dispatch{work_items_, last.samples, grid_.pixel_shift()};
        backend_.render(dispatch, results_);
        state_.film.add(dispatch, results_);
        for (const Work& part : work)
            state_.schedule.blocks[size_t(part.block)].quanta = part.quantum + 1;
        done_ += int(work.size());
        items_ += work.size();
        ++dispatches_;
        report(last.first_sample + last.samples);
    }

    void report(int samples)
    {
        if (options_.observe) options_.observe(state_);
        if (!options_.progress) return;
        const Statistics statistics = backend_.statistics();
        const double all = double(quanta_.size()) * double(grid_.corners.size());
        options_.progress({double(done_) / all, seconds_since(start_), samples,
                           statistics.rays + statistics.shadow_rays});
    }

    Backend& backend_;
    const RenderOptions& options_;
    BlockGrid grid_;
    std::vector<Quantum> quanta_;
    RenderState state_;
    Plan plan_;
    Clock::time_point start_;
    std::vector<WorkItem> work_items_;
    Results results_;
    long long done_ = 0;  // quanta of blocks, also before a resumption
    size_t items_ = 0;
    size_t dispatches_ = 0;
};

}  // namespace

size_t film_bytes(const Settings& settings, const RenderOptions& options)
{
    return Film::bytes(window_of(settings, options), batches_of(options.samples));
}

RenderState fresh_state(const Settings& settings, const RenderOptions& options)
{
    const size_t blocks = grid_of(settings, options).corners.size();
    return {Film(settings.width, settings.height, window_of(settings, options),
                 batches_of(options.samples)),
            {0, 0, 0, std::vector<BlockState>(blocks)}};
}

RenderResult render(Backend& backend, const SceneData& scene, const RenderOptions& options,
                    std::optional<RenderState> resume)
{
    RenderState state = resume ? std::move(*resume) : fresh_state(scene.settings.at(0), options);
    return Render(backend, scene, options, std::move(state)).run();
}

}  // namespace diptych
