// Pictures of a render in progress: files that are rewritten now and then, and a viewer.
#pragma once

#include "host/commands/render_command.hpp"
#include "host/image/tev_client.hpp"

#include <chrono>
#include <optional>

namespace diptych {

class ProgressPictures {
public:
    // Throws std::runtime_error for flags of no sense.
    ProgressPictures(const RenderCommand& command, const RenderOptions& options,
                     const image::WriteOptions& write);

    // Opens the viewer's picture; throws std::runtime_error where none answers.
    void begin(const Settings& settings);
    void look_at(const Film& film);  // often; most times nothing is due
    void finish(const Film& film);   // the viewer's last; files are written by who calls

private:
    void let_go_unless(bool is_there);

    using Clock = std::chrono::steady_clock;

    const RenderCommand& command_;
    const RenderOptions& options_;
    const image::WriteOptions& write_;
    double interval_ = 0;      // seconds between files; 0: none
    bool has_failed_ = false;  // a file could not be written, and that was said
    std::optional<image::TevClient> viewer_;
    Clock::time_point last_written_ = Clock::now();
    Clock::time_point last_shown_;
};

}  // namespace diptych
