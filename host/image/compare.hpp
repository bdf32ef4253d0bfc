// `diptych compare`: two pictures, or a list of pairs, judged by metrics against limits.
#pragma once

#include "host/image/flip.hpp"
#include "host/image/visible_error.hpp"

#include <iosfwd>
#include <string>
#include <vector>

namespace diptych::image {

struct CompareOptions {
    std::string reference;             // A; with `backends`, the scene
    std::string test;                  // B
    std::vector<std::string> metrics;  // empty: all of METRICS
    std::vector<double> limits;        // empty, or one for each metric
    std::string layer;                 // empty: the beauty
    std::string heat_map;              // where the FLIP map goes; empty: nowhere
    double pixels_per_degree = FLIP_PIXELS_PER_DEGREE;
    Viewer viewer;  // for JND, of linear pictures
    bool json = false;
    std::string json_file;  // empty: standard output
    std::string manifest;   // a list of comparisons instead of A and B
    std::string junit;      // where the manifest's JUnit XML goes; empty: standard output
    std::string backends;   // "A,B" as given; the caller renders then, nothing here reads it
};

// What can be measured and limited. "bias" is limited by its absolute value, everything else as it
// is.
constexpr const char* METRICS[] = {"rmse",      "relmse",      "mean",     "max",      "bias",
                                   "flip.mean", "flip.median", "flip.p99", "flip.max", "jnd.rms",
                                   "jnd.p95",   "jnd.blocks",  "yee"};
// Measured where the test has the layer predicted_error.
constexpr const char* PREDICTION_METRIC = "jnd.broken";

struct Measurement {
    std::string metric;
    double value = 0;
    bool limited = false;
    double limit = 0;
    bool within = true;
};

struct CompareResult {
    std::vector<Measurement> measurements;
    std::string json;    // one object, see the manual
    bool within = true;  // all limits
};

// Compares one pair and writes its heat map. Throws std::runtime_error for pictures that cannot be
// read or differ in size or kind, and for unknown metrics.
CompareResult compare_pictures(const CompareOptions& options);

// The command: prints the report to `out`, one line for an error to `err`. Returns 0 within all
// given limits, 1 outside, 2 on error. Does not look at `backends`.
int compare_command(const CompareOptions& options, std::ostream& out, std::ostream& err);

// The same for a manifest: a JSON list of {"name", "reference", "test", "limits": {METRIC: MAX,
// ...}} and, if wanted, "layer", "ppd", "heat_map". Paths are relative to the manifest's folder.
// Every comparison runs; an error in one is the result 2 at the end.
int compare_manifest(const CompareOptions& options, std::ostream& out, std::ostream& err);

}  // namespace diptych::image
