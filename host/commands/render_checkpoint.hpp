// --checkpoint, --every, --restart and --range of `diptych render`.
#pragma once

#include "host/render/checkpoint_writer.hpp"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace diptych {

struct CheckpointFlags {
    std::string file;
    std::string every;  // empty: 10s
    std::string range;
    bool is_restart = false;
};

void add_checkpoint_flags(CLI::App& app, CheckpointFlags& flags);

// "128..512" of the samples in options: sets the first and the end. Both are whole quanta, or the
// plan's end. Empty: leaves the whole plan. Throws std::runtime_error.
void set_range(const std::string& text, RenderOptions& options);

// A render's checkpoint file, locked while this lives; nothing when the flags name none.
class RenderCheckpoint {
public:
    // Reads what exists. Throws std::runtime_error when it is not one to go on from, when its
    // folder cannot be written, or when another process writes it.
    explicit RenderCheckpoint(const CheckpointFlags& flags);

    // scene: before upload. The state to go on from, if there is one.
    std::optional<RenderState> begin(const SceneData& scene, const RenderOptions& options,
                                     const std::string& backend_name, const Backend& backend,
                                     bool is_quiet);

    void observe(const RenderState& state);

    // Writes the last state. What went wrong, for the end of the program; empty: nothing.
    std::string finish(const Film& film, const Schedule& schedule);

    double earlier_seconds() const { return earlier_seconds_; }
    const CheckpointWriter* writer() const { return writer_ ? &*writer_ : nullptr; }

private:
    CheckpointFlags flags_;
    double seconds_between_;
    double earlier_seconds_ = 0;
    std::optional<FileLock> lock_;
    std::optional<Checkpoint> found_;
    std::optional<CheckpointWriter> writer_;
};

}  // namespace diptych
