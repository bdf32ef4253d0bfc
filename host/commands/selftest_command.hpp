// `diptych selftest`: every stage of a device against twin.
#pragma once

#include "host/commands/scene_flags.hpp"
#include "host/commands/trace_comparison.hpp"

namespace CLI {
class App;
}

namespace diptych {

struct SelftestCommand {
    DeviceFlags device;
};

// What a backend may differ by from twin: how far a number, and which share of the paths that enter
// a stage may leave it elsewhere (another triangle at an edge, another branch).
struct Allowance {
    Bound bound;
    double parted_share = 0;
    std::string reason;
};
Allowance allowance_for(const std::string& backend, const BackendOptions& options);

struct StageVerdict {
    std::string stage;
    StageTally tally;
    bool is_ok = true;
};

struct SelftestResult {
    std::vector<StageVerdict> stages;  // of STAGES, those that ran
    std::vector<std::string> details;  // where a stage first failed, a line each
    bool is_ok = true;
};

// Runs the built-in scenes on both: stage by stage, then whole with compaction.
SelftestResult run_selftest(Backend& device, Backend& twin, const Allowance& allowance);

CLI::App* add_selftest_command(CLI::App& app, SelftestCommand& command);

// 0: every stage is ok; 1: one is not. Errors are thrown.
int run_selftest_command(const SelftestCommand& command);

}  // namespace diptych
