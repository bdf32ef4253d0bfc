#include "host/commands/trace_comparison.hpp"

#include "common/as_cpp/path_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace diptych {
namespace {

// For which paths a row's number means something: others hold what the arithmetic happened to
// leave, or nothing.
enum class Meaning { always, of_hits, of_lit_paths, of_survivors };

struct RowUse {
    Stage since;     // the stage of a bounce (carried rows: of the trace) that defines it
    unsigned needs;  // effects without which no stage does
    Meaning meaning;
};

// No default: a new row must say here what it is.
RowUse use_of(PathRowName row)
{
    switch (row) {
    case row_pixel:
    case row_sample:
    case row_entry:
    case row_depth:
    case row_radiance:
        return {STAGE_generate_paths, 0, Meaning::always};
    case row_ray_origin:
    case row_ray_direction:
    case row_scatter_pdf:
    case row_throughput:
        return {STAGE_generate_paths, 0, Meaning::of_survivors};
    case row_hit_triangle:
        return {STAGE_intersect, 0, Meaning::always};
    case row_hit_instance:
        return {STAGE_intersect, 0, Meaning::of_hits};
    case row_surface_kind:
        return {STAGE_evaluate_surface, 0, Meaning::always};
    case row_position:
    case row_position_error:
    case row_face_normal:
    case row_normal:
    case row_base_color:
        return {STAGE_evaluate_surface, 0, Meaning::of_hits};
    case row_metallic:
    case row_roughness:
    case row_dielectric_f0:
    case row_dielectric_f90:
        return {STAGE_evaluate_surface, EFFECT_SPECULAR, Meaning::of_hits};
    case row_emission:
    case row_emission_pdf:
        return {STAGE_evaluate_surface, EFFECT_EMISSION, Meaning::of_hits};
    case row_first_albedo:
    case row_first_normal:
    case row_first_distance:
    case row_first_object:
    case row_first_material:
        return {STAGE_record_features, 0, Meaning::always};
    case row_light_contribution:
        return {STAGE_sample_light, LIGHT_EFFECTS, Meaning::always};
    case row_shadow_origin:
    case row_shadow_direction:
    case row_shadow_distance:
    case row_is_occluded:
        return {STAGE_sample_light, LIGHT_EFFECTS, Meaning::of_lit_paths};
    }
    return {STAGE_generate_paths, 0, Meaning::always};
}

using Planes = std::vector<std::vector<double>>;

// The states of both after one stage, and after the one before.
class StageComparison {
public:
    StageComparison(const StageState& a, const StageState& b, const Planes& a_before,
                    const Planes& b_before)
        : a_(a), b_(b), a_before_(a_before), b_before_(b_before)
    {
    }

    bool is_defined(int row, unsigned effects) const
    {
        const RowUse use = use_of(PathRowName(row));
        if (a_.planes[size_t(row)].empty() || b_.planes[size_t(row)].empty()) return false;
        if (use.needs != 0 && (effects & use.needs) == 0) return false;
        if (path_rows[row].life == Life::sample && a_.bounce > 0) return false;
        return use.since <= a_.stage;
    }

    bool is_meaningful(int row, int p) const
    {
        switch (use_of(PathRowName(row)).meaning) {
        case Meaning::of_hits:
            return a_.planes[row_hit_triangle][size_t(p)] >= 0;
        case Meaning::of_lit_paths:
            return is_lit(p);
        case Meaning::of_survivors:
            return a_.planes[row_depth][size_t(p)] >= 0;
        case Meaning::always:
            break;
        }
        return true;
    }

    // Both values of component c, of path p.
    std::pair<double, double> values(int row, int c, int p) const
    {
        const size_t k = size_t(c) * size_t(a_.paths) + size_t(p);
        return {a_.planes[size_t(row)][k], b_.planes[size_t(row)][k]};
    }

    // What the stage left alone was compared when it was written.
    bool is_changed(int row, int c, int p) const
    {
        const size_t k = size_t(c) * size_t(a_.paths) + size_t(p);
        const auto differs = [&](const Planes& before, const Planes& now) {
            return before.empty() || before[size_t(row)].empty() ||
                   before[size_t(row)][k] != now[size_t(row)][k];
        };
        return use_of(PathRowName(row)).since == a_.stage || differs(a_before_, a_.planes) ||
               differs(b_before_, b_.planes);
    }

    // What a relative bound refers to.
    double scale(int row, int p) const
    {
        double most = 0;
        for (int c = 0; c < path_rows[row].components; ++c) {
            const auto [a, b] = values(row, c, p);
            most = std::max({most, std::abs(a), std::abs(b)});
        }
        return most;
    }

private:
    bool is_lit(int p) const
    {
        const std::vector<double>& light = a_.planes[row_light_contribution];
        for (int c = 0; c < 3; ++c)
            if (light[size_t(c) * size_t(a_.paths) + size_t(p)] > 0) return true;
        return false;
    }

    const StageState& a_;
    const StageState& b_;
    const Planes& a_before_;
    const Planes& b_before_;
};

bool is_within(double a, double b, double ulps, double scale, const Bound& bound)
{
    return ulps <= bound.ulps || std::abs(a - b) <= bound.relative * scale;
}

// Compares one path after one stage; false when it has parted.
bool compare_path(const StageComparison& states, const StageState& a, unsigned effects, int p,
                  const Bound& bound, TraceComparison& comparison)
{
    StageTally& tally = comparison.stages[a.stage];
    ++tally.paths;
    for (int row = 0; row < path_row_count; ++row) {
        if (!states.is_defined(row, effects) || !states.is_meaningful(row, p)) continue;
        const int components = path_rows[row].components;
        for (int c = 0; c < components; ++c) {
            if (!states.is_changed(row, c, p)) continue;
            const auto [x, y] = states.values(row, c, p);
            ++tally.values;
            const double ulps =
                path_rows[row].is_real ? ulps_between(x, y) : (x == y ? 0 : HUGE_VAL);
            const bool is_same = path_rows[row].is_real
                                     ? is_within(x, y, ulps, states.scale(row, p), bound)
                                     : x == y;
            if (path_rows[row].is_real) tally.largest_ulps = std::max(tally.largest_ulps, ulps);
            if (is_same) continue;
            if (!comparison.first)
                comparison.first = Divergence{
                    a.stage, a.bounce, p, path_rows[row].name, components > 1 ? c : -1, x, y};
            ++tally.parted;
            return false;
        }
    }
    return true;
}

// The same for what a stage of textures gave, which lies in no row of the path. What it did not
// write is zero, or from an earlier bounce, on both.
bool compare_textures(const StageState& a, const StageState& b, int p, const Bound& bound,
                      TraceComparison& comparison)
{
    StageTally& tally = comparison.stages[a.stage];
    if (a.texture_results.empty() || a.planes[row_hit_triangle][size_t(p)] < 0) return true;
    for (size_t k = size_t(p); k < std::min(a.texture_results.size(), b.texture_results.size());
         k += size_t(a.paths)) {
        const double x = a.texture_results[k], y = b.texture_results[k];
        const double ulps = ulps_between(x, y);
        ++tally.values;
        tally.largest_ulps = std::max(tally.largest_ulps, ulps);
        if (is_within(x, y, ulps, std::max(std::abs(x), std::abs(y)), bound)) continue;
        if (!comparison.first)
            comparison.first =
                Divergence{a.stage, a.bounce, p, "what textures are given", -1, x, y};
        ++tally.parted;
        return false;
    }
    return true;
}

}  // namespace

std::string Bound::text() const
{
    if (relative > 0) return fmt::format("{} relative", relative);
    return ulps > 0 ? fmt::format("{} ulp", ulps) : "bit-identical";
}

Bound parse_bound(const std::string& text)
{
    const bool is_ulps = text.ends_with("ulp");
    const char* end = text.data() + text.size() - (is_ulps ? 3 : 0);
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end || !(value >= 0 && value < 1e9))
        throw std::runtime_error("--bound " + text +
                                 ": not a bound; give units in the last place, as 4ulp, or a "
                                 "relative difference, as 0.001");
    return is_ulps ? Bound{value, 0} : Bound{0, value};
}

double ulps_between(double a, double b)
{
    const auto ordered = [](double value) {
        const float x = float(value);
        if (std::abs(x) < std::numeric_limits<float>::min()) return std::int64_t(0);
        const auto bits = std::int64_t(std::bit_cast<std::uint32_t>(x) & 0x7fffffffu) - 0x007fffff;
        return x < 0 ? -bits : bits;
    };
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0 : HUGE_VAL;
    return double(std::abs(ordered(a) - ordered(b)));
}

TraceComparison compare_traces(Backend& a, Backend& b, unsigned effects, const Dispatch& dispatch,
                               const Bound& bound)
{
    std::vector<StageState> recorded;
    a.trace(dispatch, [&](const StageState& state) { recorded.push_back(state); });

    TraceComparison comparison;
    comparison.has_parted.assign(size_t(dispatch.paths()), 0);
    std::vector<char> is_alive(size_t(dispatch.paths()), 1);
    size_t step = 0;
    Planes b_before;
    const Planes nothing;
    b.trace(dispatch, [&](const StageState& state) {
        if (step >= recorded.size()) return;  // there, all paths that have not parted are dead
        const StageState& other = recorded[step];
        const StageComparison states(other, state, step > 0 ? recorded[step - 1].planes : nothing,
                                     b_before);
        for (int p = 0; p < dispatch.paths(); ++p) {
            if (!is_alive[size_t(p)] || comparison.has_parted[size_t(p)]) continue;
            if (!compare_path(states, other, effects, p, bound, comparison) ||
                !compare_textures(other, state, p, bound, comparison))
                comparison.has_parted[size_t(p)] = 1;
            is_alive[size_t(p)] = other.planes[row_depth][size_t(p)] >= 0;
        }
        b_before = state.planes;
        ++step;
    });
    return comparison;
}

int result_of_path(const Dispatch& dispatch, int p)
{
    const int in_item = p & ((1 << dispatch.pixel_shift) - 1);
    const int item = p / (dispatch.samples << dispatch.pixel_shift);
    return item << dispatch.pixel_shift | in_item;
}

}  // namespace diptych
