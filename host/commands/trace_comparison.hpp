// Two backends run the same paths, and every stage's numbers are held against each other.
#pragma once

#include "backends/backend.hpp"

#include <array>
#include <optional>
#include <string>

namespace diptych {

// How far two numbers may lie apart and still be taken for the same: whichever of the two allows
// more. Whole numbers must be equal.
struct Bound {
    double ulps = 0;      // units in the last place of a float; denormals count as zero
    double relative = 0;  // of the larger number; in vectors, of the largest component

    std::string text() const;
};

// "4ulp" or "0.001". Throws std::runtime_error that names --bound.
Bound parse_bound(const std::string& text);

// Units in the last place between two floats (of doubles: rounded to float first). 0 for two NaN,
// infinity for one.
double ulps_between(double a, double b);

// Where a path's state parts.
struct Divergence {
    Stage stage;
    int bounce;
    int path;  // of the dispatch
    const char* buffer;
    int component;  // of a float3: 0 to 2; else -1
    double a, b;
};

struct StageTally {
    long long values = 0;  // compared: those that the stage changed
    double largest_ulps = 0;
    long long paths = 0;  // that entered the stage, over all bounces
    int parted = 0;       // that left it with a number beyond the bound, and were let go then
};

struct TraceComparison {
    std::array<StageTally, STAGE_COUNT> stages{};
    std::vector<char> has_parted;     // per path
    std::optional<Divergence> first;  // in the order of execution
};

// Traces the dispatch on both; the scene, with these effects, is uploaded to both before. Only
// paths alive at the start of a bounce are compared, only in rows that a stage of this bounce has
// defined and that mean something there.
TraceComparison compare_traces(Backend& a, Backend& b, unsigned effects, const Dispatch& dispatch,
                               const Bound& bound);

// The result entry that path p of the dispatch adds to.
int result_of_path(const Dispatch& dispatch, int p);

}  // namespace diptych
