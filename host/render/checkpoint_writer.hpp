// Keeps a checkpoint file up to date while a render goes on.
#pragma once

#include "host/render/checkpoint.hpp"
#include "host/render/safe_file.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace diptych {

class CheckpointWriter {
public:
    // head: as it stands when the render begins, with one slice; what this run adds is added to it.
    // seconds_between: between two writings. They become rarer when they would take more than a
    // hundredth of the time. backend: asked for its statistics.
    CheckpointWriter(std::string path, double seconds_between, CheckpointHead head,
                     const Backend& backend);
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&) = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    // After a dispatch: writes when it is time. What cannot be written now is tried again later,
    // with a notice on standard error.
    void observe(const RenderState& state);

    // Writes the state, unless it is the one that the render began with, and waits for the disk.
    // Throws std::runtime_error.
    void finish(const Film& film, const Schedule& schedule);

    int written() const { return written_; }
    double seconds_spent() const { return seconds_spent_; }  // while the render waited

private:
    using Clock = std::chrono::steady_clock;

    CheckpointHead head_now(const Schedule& schedule) const;
    void begin_writing(const RenderState& state);
    void join();  // waits for what is under way; its error becomes error_
    void tell_error();

    std::string path_;
    Clock::duration between_;
    CheckpointHead head_;
    const Backend& backend_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point due_;
    bool has_changed_ = false;
    int written_ = 0;
    double seconds_spent_ = 0;
    std::thread placing_;  // waits for the disk; the render does not
    std::atomic<bool> is_placing_ = false;
    std::string error_;  // of the writing before
};

}  // namespace diptych
