// What a render tells besides its picture: the lines on the terminal, the JSON report, the
// picture's metadata.
#pragma once

#include "host/commands/render_command.hpp"
#include "host/commands/texture_fault_report.hpp"
#include "host/render/audit.hpp"
#include "host/render/render.hpp"

#include <cstdio>

namespace diptych {

// Lines before the render: effects, memory, notices.
void print_plan(const SceneData& scene, const Backend& backend, const Plan& plan,
                const RenderOptions& options);

// A bar when standard error is a terminal, a line now and then when not.
class ProgressBar {
public:
    ProgressBar();
    void show(const Progress& progress);
    void finish();

private:
    bool is_terminal_;
    double last_shown_ = -1;
    double last_fraction_ = 0;
};

// Where a sample stopped being finite.
struct FaultPlace {
    int x, y, sample, bounce;
    std::string stage, buffer;
};
// Renders the film's first faulty pixel again, stage by stage.
std::optional<FaultPlace> find_fault(Backend& backend, const Faults& faults, int samples);

std::string json_report(const RenderCommand& command, const SceneData& scene,
                        const RenderOptions& options, const Backend& backend,
                        const RenderResult& result, const image::Picture& picture,
                        const std::optional<FaultPlace>& fault, const TextureFaultReport& textures,
                        const std::optional<ErrorSummary>& error,
                        const std::optional<Audit>& audited, const CheckpointWriter* checkpoint);

void add_metadata(image::Picture& picture, const RenderCommand& command, const SceneData& scene,
                  const Backend& backend, const RenderResult& result);

// Of the slots that steps were taken with, the share that had a live path.
double slots_busy(const Statistics& statistics);

// SHA-256 over everything of the scene that a device sees.
std::string scene_hash(const SceneData& scene);

}  // namespace diptych
