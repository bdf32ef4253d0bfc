#include "host/commands/error_flags.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace diptych {
namespace {

constexpr double longest_time = 1e8;  // three years

bool parse_number(std::string_view text, double& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

double parse_error(const std::string& text)
{
    if (text.empty()) return 1;
    double value = 0;
    if (!parse_number(text, value) || !(value >= 0.01 && value <= 100))
        throw std::runtime_error(
            "--error " + text +
            ": not an error that can be aimed at; give just noticeable "
            "differences from 0.01 to 100, or no value for 1, and name the scene before");
    return value;
}

}  // namespace

void add_error_flags(CLI::App& app, ErrorFlags& flags)
{
    flags.samples_option = app.get_option("--samples");
    flags.error_option =
        app.add_option(
               "--error", flags.error,
               "Render until the predicted error is below this many just noticeable "
               "differences; without a value 1: no visible difference. --samples is then the "
               "limit")
            ->expected(0, 1)
            ->type_name("[JND]");
    flags.share_option =
        app.add_option("--share", flags.share,
                       "With --error: end when so many per cent of the blocks are below the "
                       "target; the hardest few may take as long as all others together")
            ->check(CLI::Range(1.0, 100.0))
            ->type_name("PERCENT")
            ->default_str("100");
    app.add_option(
        "--time", flags.time,
        "Render for so long, as 30s or 2m, giving samples to where the error is largest");
    app.add_flag("--unbiased", flags.is_unbiased,
                 "With --error: let 64 samples a pixel decide how many more there shall be, and "
                 "leave them out of the picture");
}

double parse_seconds(const std::string& flag, const std::string& text)
{
    double value = 0, unit = 1;
    std::string_view number = text;
    if (!number.empty()) {
        const char last = number.back();
        if (last == 's' || last == 'm' || last == 'h') {
            unit = last == 's' ? 1 : last == 'm' ? 60 : 3600;
            number.remove_suffix(1);
        }
    }
    if (!parse_number(number, value) || !(value > 0 && value * unit <= longest_time))
        throw std::runtime_error(flag + " " + text +
                                 ": not a time; give seconds above 0, or 30s, 2m, 1.5h");
    return value * unit;
}

void set_targets(const ErrorFlags& flags, int samples, RenderOptions& options)
{
    const auto is_given = [](const CLI::Option* option) { return option && option->count() > 0; };
    const bool has_error = is_given(flags.error_option);
    const bool are_samples_given = is_given(flags.samples_option);
    const bool has_time = !flags.time.empty();
    if (has_error) options.error = parse_error(flags.error);
    if (has_time) options.time_limit = parse_seconds("--time", flags.time);
    if (is_given(flags.share_option) && !has_error)
        throw std::runtime_error("--share: of the blocks below which error? add --error");
    if (is_given(flags.share_option) && flags.is_unbiased)
        throw std::runtime_error("--share: --unbiased decides for each block before any is done; "
                                 "leave one out");
    options.share = flags.share / 100;
    if (flags.is_unbiased && !has_error)
        throw std::runtime_error("--unbiased: there is nothing to decide; add --error");
    if (flags.is_unbiased && has_time)
        throw std::runtime_error(
            "--unbiased: --time would decide by the picture's own samples; leave one out");
    if (flags.is_unbiased && are_samples_given && samples <= 4 * QUANTUM)
        throw std::runtime_error(fmt::format(
            "--samples {}: nothing is left of them after the 64 of --unbiased; give more",
            samples));
    if ((has_error || has_time) && options.pixel)
        throw std::runtime_error("--pixel: its error is not known from one pixel; give --samples "
                                 "instead of --error and --time");
    options.is_unbiased = flags.is_unbiased;
    options.samples =
        (has_error || has_time) && !are_samples_given ? most_adaptive_samples : samples;
}

double target_of(const RenderResult& result, const RenderOptions& options)
{
    return options.error > 0 ? options.error : result.target;
}

std::string ending_text(const RenderResult& result, const RenderOptions& options,
                        const ErrorSummary& summary)
{
    const char* why[] = {"the target is reached", "the samples are used up", "the time is over",
                         "interrupted"};
    std::string text = "ended: " + std::string(why[int(result.ending)]);
    const bool is_cut = std::any_of(
        result.schedule.blocks.begin(), result.schedule.blocks.end(),
        [&](const BlockState& block) { return block.quanta >= options.samples / QUANTUM; });
    if (options.is_unbiased && result.ending == Ending::SamplesDone && !is_cut)
        text = "ended: what the pilot asked for is rendered";
    if (result.target > 0 &&
        (result.ending != Ending::TargetReached || result.unfinished_blocks > 0))
        text += fmt::format("; {} of {} blocks are above {:.3g} JND", result.unfinished_blocks,
                            result.blocks, target_of(result, options));
    const double bar = options.error > 0 ? options.error : 1;
    if (summary.share_unknown > 0)
        text +=
            fmt::format("\nerror: not known for {:.3g} % of the pixels, which have fewer than {} "
                        "samples; they count as wrong",
                        100 * summary.share_unknown, QUANTUM + 1);
    text +=
        fmt::format("\nerror: {}predicted {:.3g} JND (95 % of the blocks are below, at 95 % "
                    "confidence), {:.1f} % of the pixels within {:.3g} JND",
                    options.error > 0 ? fmt::format("asked for {:.3g} JND, ", options.error) : "",
                    summary.block_p95, 100 * summary.share_within, bar);
    return text;
}

}  // namespace diptych
