#include "host/commands/render_checkpoint.hpp"

#include "host/commands/error_flags.hpp"
#include "host/render/checkpoint_merge.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <tuple>

namespace diptych {
namespace {

[[noreturn]] void refuse(const std::string& flag, const std::string& text, const std::string& what)
{
    throw std::runtime_error(fmt::format("{} {}: {}", flag, text, what));
}

std::string joined(const std::vector<std::string>& names)
{
    return fmt::format("{}", fmt::join(names, ", "));
}

void go_on_from(const CheckpointHead& old, CheckpointHead& head)
{
    for (const std::string& backend : old.backends)
        if (std::count(head.backends.begin(), head.backends.end(), backend) == 0)
            head.backends.push_back(backend);
    std::sort(head.backends.begin(), head.backends.end());
    head.seconds = old.seconds;
    head.rays = old.rays;
    head.paths = old.paths;
}

std::string how_far(const CheckpointHead& head, const Slice& slice)
{
    if (slice.error <= 0 && !slice.is_timed)
        return fmt::format("{:.0f} % of samples {}..{}", 100 * fraction_done(head), slice.first,
                           slice.end);
    const std::vector<BlockState>& blocks = slice.schedule.blocks;
    return fmt::format("{} of {} blocks done, up to {} samples a pixel",
                       std::count_if(blocks.begin(), blocks.end(),
                                     [](const BlockState& block) { return block.is_done; }),
                       blocks.size(), done_end(slice));
}

// backends: those that will have had a part in it.
void tell_beginning(const std::string& file, const CheckpointHead& old,
                    const std::vector<std::string>& backends)
{
    if (backends.size() > 1)
        fmt::print(stderr, "notice: {} was begun on {}: the picture will be by {}\n", file,
                   joined(old.backends), joined(backends));
    for (const Slice& slice : old.slices)
        fmt::print(stderr, "going on from {}: {}, {:.1f} s so far\n", file, how_far(old, slice),
                   old.seconds);
}

// "128..512" of a plan of `samples`: first and end.
std::pair<int, int> parse_range(const std::string& text, int samples)
{
    const size_t dots = text.find("..");
    int first = 0, end = 0;
    const auto parse = [&](size_t from, size_t to, int& value) {
        const auto result = std::from_chars(text.data() + from, text.data() + to, value);
        return result.ec == std::errc{} && result.ptr == text.data() + to;
    };
    if (dots == std::string::npos || !parse(0, dots, first) || !parse(dots + 2, text.size(), end) ||
        first < 0 || first >= end)
        refuse("--range", text, "not a range of samples; give A..B, as 0..128");
    if (end > samples)
        refuse("--range", text,
               fmt::format("beyond the last of --samples {}; give the samples of the whole picture "
                           "with --samples",
                           samples));
    if (first % QUANTUM != 0 || (end % QUANTUM != 0 && end != samples))
        refuse("--range", text,
               fmt::format("cuts a group of {0} samples; give multiples of {0}", QUANTUM));
    return {first, end};
}

}  // namespace

void add_checkpoint_flags(CLI::App& app, CheckpointFlags& flags)
{
    app.add_option("--checkpoint", flags.file,
                   "Keep the render's state in this file, and go on from it where it exists: the "
                   "picture is the one of a render that was never interrupted");
    app.add_option("--every", flags.every,
                   "Time between two writings of the checkpoint, as 10s (if not given), 5m, 1h; "
                   "longer where writing would take more than 1 % of the time");
    app.add_flag("--restart", flags.is_restart, "Begin anew, whatever the checkpoint holds");
    app.add_option("--range", flags.range,
                   "Render only samples A..B of each pixel, A to B - 1, of the --samples of the "
                   "whole; diptych merge puts the checkpoints of such slices together");
}

void set_range(const std::string& text, RenderOptions& options)
{
    if (text.empty()) return;
    if (is_adaptive(options))
        refuse("--range", text,
               "slices have a number of samples; leave out --error and --time, and give --samples");
    std::tie(options.first_sample, options.samples) = parse_range(text, options.samples);
}

RenderCheckpoint::RenderCheckpoint(const CheckpointFlags& flags)
    : flags_(flags),
      seconds_between_(parse_seconds("--every", flags.every.empty() ? "10s" : flags.every))
{
    if (flags_.file.empty() && !flags_.every.empty())
        throw std::runtime_error("--every: there is no checkpoint to write; name it with "
                                 "--checkpoint, or leave --every out");
    if (flags_.file.empty() && flags_.is_restart)
        throw std::runtime_error("--restart: there is no checkpoint to begin anew; name it with "
                                 "--checkpoint, or leave --restart out");
    if (flags_.file.empty()) return;
    lock_.emplace(flags_.file);
    {
        SafeFile probe(flags_.file);
    }
    std::error_code ignored;
    if (!flags_.is_restart && std::filesystem::exists(flags_.file, ignored))
        found_ = read_checkpoint(flags_.file);
}

std::optional<RenderState> RenderCheckpoint::begin(const SceneData& scene,
                                                   const RenderOptions& options,
                                                   const std::string& backend_name,
                                                   const Backend& backend, bool is_quiet)
{
    if (flags_.file.empty()) return std::nullopt;
    const Settings& settings = scene.settings.at(0);
    CheckpointHead head;
    head.subject = checkpoint_subject(scene, "diptych " DIPTYCH_VERSION);
    head.backends = {backend_name};
    head.block_shift = grid_of(settings, options).shift;
    head.slices = {slice_of(options)};
    head.planned = std::max(settings.samples, options.samples);
    std::optional<RenderState> state;
    if (found_) {
        const CheckpointHead& old = found_->head;
        expect_same_subject(old, flags_.file, head.subject);
        expect_same_plan(old, flags_.file, settings, options);
        go_on_from(old, head);
        if (!is_quiet) tell_beginning(flags_.file, old, head.backends);
        state = continued(std::move(*found_), flags_.file, settings, options);
        found_.reset();
        earlier_seconds_ = head.seconds;
    }
    writer_.emplace(flags_.file, seconds_between_, std::move(head), backend);
    return state;
}

void RenderCheckpoint::observe(const RenderState& state)
{
    if (writer_) writer_->observe(state);
}

std::string RenderCheckpoint::finish(const Film& film, const Schedule& schedule)
{
    try {
        if (writer_) writer_->finish(film, schedule);
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

}  // namespace diptych
