#include "host/render/render.hpp"

#include "host/render/forecast.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace diptych {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double first_level = 4;          // JND: where a render with only a time limit begins
constexpr double longest_dispatch = 0.25;  // seconds, where a device can leave one for later
constexpr size_t items_of_pixel = 64;      // quanta at once, likewise

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Window window_of(const Settings& settings, const RenderOptions& options)
{
    return options.pixel ? Window{options.pixel->x, options.pixel->y, 1, 1}
                         : Window{0, 0, settings.width, settings.height};
}

int film_batches(const Settings& settings, const RenderOptions& options)
{
    return is_adaptive(options) ? batch_count
                                : batches_of(options.samples, settings.sequence_quanta);
}

bool is_known(const BlockError& error)
{
    return error.worst_pixel < int(confidence * unknown_error * float(error_unit));
}

// One render: its plan, its state, and what a dispatch is made of.
class Render {
public:
    Render(Backend& backend, const SceneData& scene, const RenderOptions& options,
           RenderState state)
        : backend_(backend), options_(options), grid_(grid_of(scene.settings[0], options)),
          quanta_(plan_of(options)), state_(std::move(state)), plan_(backend.plan(scene)),
          start_(Clock::now())
    {
        Schedule& schedule = state_.schedule;
        for (const BlockState& block : schedule.blocks) {
            done_ += block.quanta;
            blocks_without_ += block.quanta == 0;
        }
        schedule.teams = is_adaptive(options_) && !options_.is_unbiased ? 2 : 1;
        schedule.turn %= schedule.teams;
        if (!is_adaptive(options_)) work_ = work_by_pass(schedule);
        for (int k = 0; k < schedule.teams && is_adaptive(options_); ++k)
            append_round((schedule.turn + k) % schedule.teams);
    }

    RenderResult run()
    {
        bool is_complete = false;
        try {
            is_complete = !lengthen_list();
            while (!is_complete && may_go_on()) {
                run_next_dispatch();
                is_complete = !lengthen_list();
            }
        } catch (const std::runtime_error& error) {
            if (!options_.failure) throw;
            *options_.failure = error.what();
            has_failed_ = true;
        }
        RenderResult result{std::move(state_.film), std::move(state_.schedule), plan_,
                            backend_.statistics(), seconds_since(start_)};
        result.scheduling_seconds = scheduling_seconds_;
        result.blocks = int(grid_.corners.size());
        result.most_samples = options_.samples;
        describe_ending(result, is_complete);
        return result;
    }

private:
    bool has_picture() const { return blocks_without_ == 0; }  // every block has a quantum

    bool is_interrupted() const { return has_failed_ || (options_.stop && options_.stop->load()); }

    bool is_time_over() const
    {
        return options_.time_limit > 0 && has_picture() &&
               (is_time_used_up_ || seconds_since(start_) >= options_.time_limit);
    }

    void describe_ending(RenderResult& result, bool is_complete) const
    {
        const bool is_at_end = std::all_of(
            result.schedule.blocks.begin(), result.schedule.blocks.end(),
            [&](const BlockState& block) { return block.quanta >= int(quanta_.size()); });
        result.is_complete = is_complete || is_at_end || !is_interrupted();
        if (!is_adaptive(options_)) {
            result.ending = result.is_complete ? Ending::SamplesDone : Ending::Interrupted;
            return;
        }
        result.target = double(target()) / error_unit;
        const std::vector<BlockError> errors = block_errors(result.film, grid_, options_.viewer);
        for (const BlockError& error : errors)
            result.unfinished_blocks += error_of(error) > target();
        const size_t finished = errors.size() - size_t(result.unfinished_blocks);
        const bool is_reached = is_complete && finished >= share_of(options_.share, errors.size());
        result.ending = is_reached       ? Ending::TargetReached
                        : is_complete    ? Ending::SamplesDone
                        : is_time_over() ? Ending::TimeOver
                                         : Ending::Interrupted;
    }

    // In units of BlockError, at least one.
    int target() const
    {
        const double jnd = options_.error > 0
                               ? options_.error
                               : first_level * std::exp2(-0.5 * state_.schedule.level);
        return int(std::clamp(std::floor(jnd * error_unit), 1.0, 1e9));
    }

    // Whether paths stay under way from one dispatch to the next.
    bool is_streaming() const { return plan_.most_items > plan_.items; }

    // A plan's items are blocks of the largest size.
    size_t items_planned() const
    {
        if (options_.pixel) return is_streaming() ? items_of_pixel : 1;
        const size_t planned = size_t(std::max(1, plan_.most_items))
                               << (2 * BLOCK_SHIFT - grid_.pixel_shift());
        return options_.most_items > 0 ? std::min(planned, size_t(options_.most_items)) : planned;
    }

    // Fewer where the time limit would be passed by much.
    size_t items_at_once(int samples) const
    {
        const size_t planned = items_planned();
        if (options_.time_limit <= 0 || seconds_per_sample_ <= 0 || is_streaming()) return planned;
        const double left =
            std::max(options_.time_limit - seconds_since(start_), 0.05 * options_.time_limit);
        const double items = left / (seconds_per_sample_ * samples);
        return size_t(std::clamp(items, 4.0, double(planned)));
    }

    // Extends the list of work by every round that can be decided. False when nothing is left to
    // do.
    bool lengthen_list()
    {
        if (!is_adaptive(options_)) {
            if (next_ == work_.size() &&
                begin_uniform_round(state_.schedule, int(quanta_.size()))) {
                work_ = work_by_pass(state_.schedule);
                next_ = 0;
            }
            return next_ < work_.size();
        }
        const Clock::time_point start = Clock::now();
        const Schedule& schedule = state_.schedule;
        int done = 0;  // teams in a row, that have nothing left to do
        while (done < schedule.teams && is_round_done(schedule, schedule.turn)) {
            const int team = schedule.turn;
            done = begin_adaptive() ? 0 : done + 1;
            if (done == 0) append_round(team);
            if (done == schedule.teams && lower_target()) done = 0;
        }
        scheduling_seconds_ += seconds_since(start);
        return done < schedule.teams;
    }

    bool begin_adaptive()
    {
        measure_team(state_.schedule, state_.film, grid_, options_.viewer);
        forecast_.observe(state_.schedule);
        const Targets targets{target(), 4 * QUANTUM, options_.is_unbiased, options_.share};
        const int pilot = state_.schedule.pilot;
        const bool has_begun = begin_adaptive_round(state_.schedule, grid_, quanta_, targets);
        if (state_.schedule.pilot != pilot) state_.film.forget_samples();
        return has_begun;
    }

    void append_round(int team)
    {
        work_.erase(work_.begin(), work_.begin() + std::ptrdiff_t(next_));
        next_ = 0;
        const std::vector<Work> round = work_by_block(state_.schedule, quanta_, team);
        work_.insert(work_.end(), round.begin(), round.end());
    }

    // A time limit alone: when all blocks are as good as each other, the target is lowered.
    bool lower_target()
    {
        std::vector<BlockState>& blocks = state_.schedule.blocks;
        const auto has_plan_left = [&](const BlockState& block) {
            return block.quanta < int(quanta_.size());
        };
        if (options_.error > 0 || target() == 1 ||
            std::none_of(blocks.begin(), blocks.end(), has_plan_left))
            return false;
        ++state_.schedule.level;
        for (BlockState& block : blocks) block.is_done = false;
        return true;
    }

    // What is under way ends first, but for an end at once.
    bool may_go_on() const
    {
        if (is_interrupted() && options_.stops_at_once) return false;
        return items_under_way_ > 0 || !(is_interrupted() || is_time_over());
    }

    // Whether work of as many samples will follow what is listed: the older round ends before the
    // list does.
    bool will_more_follow(int samples) const
    {
        const Schedule& schedule = state_.schedule;
        if (schedule.teams == 1) return false;
        bool will_more = false;
        for_team(schedule, schedule.turn, [&](size_t b) {
            const BlockState& block = schedule.blocks[b];
            will_more = will_more || (!block.is_done && block.target < int(quanta_.size()) &&
                                      quanta_[size_t(block.target)].samples == samples);
        });
        return will_more;
    }

    void run_next_dispatch()
    {
        const int samples = quanta_[size_t(work_[next_].quantum)].samples;
        const size_t most = std::max(items_at_once(samples), items_under_way_);
        const size_t count = dispatch_length(work_, next_, most, quanta_);
        const size_t all = dispatch_length(work_, next_, work_.size(), quanta_);
        const bool is_last = all == work_.size() - next_;
        const size_t following = all - count + (is_last && will_more_follow(samples) ? 1 : 0);
        next_ += run_dispatch({work_.data() + next_, count}, following);
    }

    // The time that what is under way still takes is left to it.
    bool is_time_for_the_rest(int samples) const
    {
        return options_.time_limit > 0 && has_picture() &&
               seconds_since(start_) + first_done_ * samples >= options_.time_limit;
    }

    // How long the first items to be done took, a sample of theirs.
    void measure_pace(double seconds, int items, int samples)
    {
        seconds_under_way_ += seconds;
        if (items == 0) return;
        const double now = seconds_under_way_ / samples;
        first_done_ = first_done_ > 0 ? std::min(first_done_, now) : now;
        seconds_per_sample_ = seconds / (double(items) * samples);
    }

    // How many of the list are done: all, or where the device has left it, the first of them.
    size_t run_dispatch(std::span<const Work> work, size_t following)
    {
        const Clock::time_point start = Clock::now();
        const int samples = quanta_[size_t(work[0].quantum)].samples;
        Wish wish = Wish::go_on;
        const auto ask = [&] {
            if (wish == Wish::finish) return wish;
            const bool is_dropped = is_interrupted() && options_.stops_at_once;
            if (is_dropped || seconds_since(start) > longest_dispatch) wish = Wish::leave;
            if (!is_dropped && (is_interrupted() || is_time_for_the_rest(samples)))
                wish = Wish::finish;
            return wish;
        };
        work_items_.clear();
        for (const Work& part : work) {
            const Pixel& corner = grid_.corners[size_t(part.block)];
            work_items_.push_back(
                {corner.x, corner.y, quanta_[size_t(part.quantum)].first_sample, 0});
        }
        if (items_under_way_ == 0) seconds_under_way_ = 0;
        Dispatch dispatch{work_items_, samples, grid_.pixel_shift()};
        const size_t done = size_t(backend_.advance(dispatch, {following, ask}, results_));
        const Clock::time_point merge = Clock::now();
        items_under_way_ = wish == Wish::finish ? 0 : work.size() - done;
        is_time_used_up_ = is_time_used_up_ || (wish == Wish::finish && !is_interrupted());
        dispatch.items = dispatch.items.first(done);
        state_.film.add(dispatch, results_);
        for (const Work& part : work.first(done)) {
            int& quanta = state_.schedule.blocks[size_t(part.block)].quanta;
            blocks_without_ -= quanta == 0;
            quanta = part.quantum + 1;
        }
        scheduling_seconds_ += seconds_since(merge);
        measure_pace(seconds_since(start), int(done), samples);
        done_ += int(done);
        const Quantum& last = quanta_[size_t(work[done > 0 ? done - 1 : 0].quantum)];
        report(last.first_sample + last.samples);
        return done;
    }

    void report(int samples)
    {
        if (options_.observe) options_.observe(state_);
        if (!options_.progress) return;
        const Statistics statistics = backend_.statistics();
        Progress progress{uniform_fraction(), seconds_since(start_), samples,
                          statistics.rays + statistics.shadow_rays};
        if (is_adaptive(options_)) {
            progress.error = error_decided_by();
            if (options_.error > 0)
                progress.fraction = forecast_.fraction(state_.schedule, target(),
                                                       int(quanta_.size()), options_.share);
            if (options_.time_limit > 0)
                progress.fraction = std::max(options_.error > 0 ? progress.fraction : 0,
                                             std::min(1.0, progress.seconds / options_.time_limit));
        }
        const double fraction = std::clamp(progress.fraction, 1e-6, 1.0);
        progress.seconds_left = progress.seconds * (1 - fraction) / fraction;
        options_.progress(progress);
    }

    double uniform_fraction() const
    {
        return double(done_) / (double(quanta_.size()) * double(grid_.corners.size()));
    }

    // 95 % of the blocks have less, in JND, by the last decisions; 0 before there is any.
    double error_decided_by() const
    {
        std::vector<BlockError> errors;
        for (const BlockState& block : state_.schedule.blocks) errors.push_back(block.error);
        return std::all_of(errors.begin(), errors.end(), is_known) ? block_p95(errors) : 0;
    }

    Backend& backend_;
    const RenderOptions& options_;
    BlockGrid grid_;
    std::vector<Quantum> quanta_;
    RenderState state_;
    Plan plan_;
    Clock::time_point start_;
    Forecast forecast_;
    std::vector<Work> work_;  // rounds one after the other; from next_ on not done
    size_t next_ = 0;
    std::vector<WorkItem> work_items_;
    Results results_;
    int blocks_without_ = 0;         // any quantum
    double seconds_per_sample_ = 0;  // of a block, in the last dispatch
    double seconds_under_way_ = 0;   // since nothing was
    double first_done_ = 0;
    double scheduling_seconds_ = 0;
    long long done_ = 0;            // quanta of blocks, also before a resumption
    size_t items_under_way_ = 0;    // at most, where the last dispatch has been left
    bool is_time_used_up_ = false;  // what is left of it is too short
    bool has_failed_ = false;       // the backend
};

}  // namespace

bool is_adaptive(const RenderOptions& options)
{
    return options.error > 0 || options.time_limit > 0;
}

std::vector<Quantum> plan_of(const RenderOptions& options)
{
    if (options.time_limit <= 0 || options.first_sample > 0 || options.samples < QUANTUM)
        return quanta_of(options.first_sample, options.samples);
    std::vector<Quantum> plan = {{0, 1}, {1, 1}, {2, 2}, {4, 4}, {8, 8}};
    const std::vector<Quantum> rest = quanta_of(QUANTUM, options.samples);
    plan.insert(plan.end(), rest.begin(), rest.end());
    return plan;
}

BlockGrid grid_of(const Settings& settings, const RenderOptions& options)
{
    if (options.pixel) return grid_of_pixel(settings.width, settings.height, *options.pixel);
    const int side = image::error_block_side(settings.width, settings.height);
    return grid_of_blocks(settings.width, settings.height,
                          is_adaptive(options) ? std::countr_zero(unsigned(side)) : BLOCK_SHIFT);
}

BlockGrid error_grid(const Settings& settings)
{
    RenderOptions adaptive;
    adaptive.error = 1;
    return grid_of(settings, adaptive);
}

size_t film_bytes(const SceneData& scene, const RenderOptions& options)
{
    const Settings& settings = scene.settings.at(0);
    return Film::bytes(window_of(settings, options), film_batches(settings, options),
                       scene.textures.aovs.size());
}

size_t picture_bytes(const SceneData& scene, const RenderOptions& options)
{
    const Settings& settings = scene.settings.at(0);
    return Film::picture_bytes(size_t(settings.width) * size_t(settings.height),
                               film_batches(settings, options), scene.textures.aovs.size());
}

RenderState fresh_state(const SceneData& scene, const RenderOptions& options)
{
    const Settings& settings = scene.settings.at(0);
    const size_t blocks = grid_of(settings, options).corners.size();
    return {Film(settings.width, settings.height, window_of(settings, options),
                 film_batches(settings, options), scene.textures.aovs),
            {.blocks = std::vector<BlockState>(blocks)}};
}

RenderResult render(Backend& backend, const SceneData& scene, const RenderOptions& options,
                    std::optional<RenderState> resume)
{
    RenderState state = resume ? std::move(*resume) : fresh_state(scene, options);
    return Render(backend, scene, options, std::move(state)).run();
}

}  // namespace diptych
