#include "host/commands/texture_fault_report.hpp"

#include "backends/textures/texture_replay.hpp"
#include "common/textures/procedural.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace diptych {
namespace {

using nlohmann::json;

constexpr size_t most_numbers = 16;  // of an array, printed
// By kind; the line of a loop is there in any case.
constexpr TextureReplay::Build build_for[] = {TextureReplay::Build::watched_values,
                                              TextureReplay::Build::plain,
                                              TextureReplay::Build::watched_indexes};
constexpr const char* kind_names[] = {"not_finite", "budget", "index"};

bool has_fault(const TextureStepValue& step, int kind)
{
    if (kind == TEXTURE_FAULT_BUDGET) return step.fault_line != 0;
    if (kind == TEXTURE_FAULT_INDEX) return step.clamped != 0;
    return !std::ranges::all_of(step.value, [](double x) { return std::abs(x) <= FLOAT_MAX; });
}

TextureFaultPlace place_of(const SceneData& scene, const TextureHit& hit,
                           const TextureStepValue& step)
{
    const TextureAttachment& attachment = scene.textures.attachments.at(size_t(step.attachment));
    const TextureFunction& function = scene.textures.functions.at(size_t(attachment.function));
    TextureFaultPlace place{hit.pixel & 0xffff,
                            int(unsigned(hit.pixel) >> 16),
                            hit.sample,
                            hit.depth,
                            attachment.node,
                            function.entry,
                            function.file,
                            0,
                            {},
                            text_of_numbers({step.value.begin(), step.value.end()}, false),
                            step.clamped};
    const json about = json::parse(function.description, nullptr, false);
    place.line = about.is_object() ? about.value("line", 0) : 0;
    if (step.fault_line != 0) place.line = step.fault_line;
    place.arguments = arguments_text(function, step);
    return place;
}

// The first step with the fault by sample, bounce and order of the steps; those for layers of the
// picture come after the surface's.
std::optional<TextureFaultPlace> find_first(Backend& backend, SceneData& scene,
                                            TextureReplay& replay, const TextureFault& fault,
                                            int kind)
{
    std::optional<TextureFaultPlace> first;
    const WorkItem item{fault.x, fault.y, fault.first_sample, 0};
    backend.trace({{&item, 1}, fault.samples, 0}, [&](const StageState& state) {
        if (state.stage != STAGE_intersect) return;
        for (const int lookup : {LOOKUP_SURFACE, LOOKUP_AOV})
            for (const TexturedPath& path : textured_hits(scene, state, lookup)) {
                const TextureHit& hit = path.hit;
                if (lookup == LOOKUP_AOV && hit.depth > 0) continue;
                if (first &&
                    std::tie(first->sample, first->bounce) <= std::tie(hit.sample, hit.depth))
                    continue;
                const std::vector<TextureStepValue> steps = replay.run(hit, lookup);
                const auto at = std::ranges::find_if(
                    steps, [&](const TextureStepValue& step) { return has_fault(step, kind); });
                if (at != steps.end()) first = place_of(scene, hit, *at);
            }
    });
    return first;
}

}  // namespace

std::string arguments_text(const TextureFunction& function, const TextureStepValue& step)
{
    std::string text;
    for (size_t a = 0; a < function.arguments.size(); ++a)
        text +=
            (a == 0 ? "" : ", ") + function.arguments[a].name + " = " +
            text_of_numbers(step.arguments[a], !function.arguments[a].type.starts_with("float"));
    return text;
}

std::string text_of_numbers(const std::vector<double>& numbers, bool is_whole)
{
    std::string text;
    for (size_t k = 0; k < std::min(numbers.size(), most_numbers); ++k)
        text += (k == 0 ? "" : ", ") +
                (is_whole ? fmt::format("{:.0f}", numbers[k]) : fmt::format("{:.9g}", numbers[k]));
    if (numbers.size() > most_numbers) text += fmt::format(", ... {} in all", numbers.size());
    return numbers.size() == 1 ? text : "(" + text + ")";
}

TextureFaultReport find_texture_faults(Backend& backend, const std::string& name, SceneData& scene,
                                       const TextureFaults& faults)
{
    TextureFaultReport report{faults, {}};
    if (!faults.any()) return report;
    for (int kind = 0; kind < TEXTURE_FAULT_COUNT; ++kind) {
        const TextureFault& fault = faults.of_kind[size_t(kind)];
        if (fault.count == 0) continue;
        try {
            TextureReplay replay(scene, name == "double", build_for[kind]);
            report.first[size_t(kind)] = find_first(backend, scene, replay, fault, kind);
        } catch (const std::runtime_error& error) {  // no compiler: counts and pixels are known
            fmt::print(stderr, "notice: {}\n", error.what());
        }
    }
    return report;
}

std::string texture_fault_text(const TextureFaultReport& report, int kind)
{
    const TextureFault& fault = report.faults.of_kind[size_t(kind)];
    std::string text;
    if (kind == TEXTURE_FAULT_NOT_FINITE)
        text = fmt::format("{} results of textures were not finite and were replaced by 0",
                           fault.count);
    else if (kind == TEXTURE_FAULT_BUDGET)
        text = fmt::format("{} evaluations of textures ran out of their {} turns of loops",
                           fault.count, TEXTURE_BUDGET);
    else
        text =
            fmt::format("{} indexes in textures were out of range and were clamped", fault.count);
    const std::optional<TextureFaultPlace>& at = report.first[size_t(kind)];
    if (!at)
        return text + fmt::format(", the first at pixel {},{} samples {} to {}", fault.x, fault.y,
                                  fault.first_sample, fault.first_sample + fault.samples - 1);
    text += fmt::format(", the first in node {}, {}:{}: {}({}) gave {}", at->node, at->file,
                        at->line, at->function, at->arguments, at->value);
    if (kind == TEXTURE_FAULT_INDEX) text += fmt::format(", {} in this evaluation,", at->clamped);
    return text +
           fmt::format(" at pixel {},{} sample {} bounce {}", at->x, at->y, at->sample, at->bounce);
}

json texture_fault_json(const TextureFaultReport& report)
{
    json all = json::object();
    for (int kind = 0; kind < TEXTURE_FAULT_COUNT; ++kind) {
        const TextureFault& fault = report.faults.of_kind[size_t(kind)];
        json one = {{"count", fault.count}};
        if (const std::optional<TextureFaultPlace>& at = report.first[size_t(kind)])
            one["first"] = {{"node", at->node},     {"function", at->function},
                            {"file", at->file},     {"line", at->line},
                            {"x", at->x},           {"y", at->y},
                            {"sample", at->sample}, {"bounce", at->bounce},
                            {"value", at->value},   {"arguments", at->arguments}};
        else if (fault.count > 0)
            one["first"] = {{"x", fault.x}, {"y", fault.y}};
        all[kind_names[kind]] = one;
    }
    return all;
}

}  // namespace diptych
