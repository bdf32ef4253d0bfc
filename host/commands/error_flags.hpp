// The flags that say when a render ends: samples, error, time.
#pragma once

#include "host/render/render.hpp"

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace diptych {

struct ErrorFlags {
    std::string error;   // empty: without a value
    std::string time;    // empty: not given
    double share = 100;  // per cent
    bool is_unbiased = false;
    const CLI::Option* error_option = nullptr;  // to tell whether it was given
    const CLI::Option* samples_option = nullptr;
    const CLI::Option* share_option = nullptr;
};

void add_error_flags(CLI::App& app, ErrorFlags& flags);

// Fills in options' targets; samples: of --samples. Throws std::runtime_error that names the flag.
void set_targets(const ErrorFlags& flags, int samples, RenderOptions& options);

// "30s", "2m", "1.5h", "45": seconds.
double parse_seconds(const std::string& flag, const std::string& text);

// JND that all blocks were to reach; 0: uniform. The scheduler's own is in its unit, rounded.
double target_of(const RenderResult& result, const RenderOptions& options);

// A line that says what was asked for and what is predicted.
std::string ending_text(const RenderResult& result, const RenderOptions& options,
                        const ErrorSummary& summary);

}  // namespace diptych
