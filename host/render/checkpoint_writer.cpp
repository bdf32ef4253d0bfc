#include "host/render/checkpoint_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace diptych {
namespace {

// Of the time, for writing checkpoints.
constexpr double largest_share = 0.01;

double in_seconds(std::chrono::steady_clock::duration duration)
{
    return std::chrono::duration<double>(duration).count();
}

}  // namespace

CheckpointWriter::CheckpointWriter(std::string path, double seconds_between, CheckpointHead head,
                                   const Backend& backend)
    : path_(std::move(path)), between_(std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(seconds_between))),
      head_(std::move(head)), backend_(backend), due_(start_ + between_)
{
}

CheckpointWriter::~CheckpointWriter()
{
    if (placing_.joinable()) placing_.join();
}

CheckpointHead CheckpointWriter::head_now(const Schedule& schedule) const
{
    CheckpointHead head = head_;
    const Statistics statistics = backend_.statistics();
    head.slices.at(0).schedule = schedule;
    head.seconds += in_seconds(Clock::now() - start_);
    head.rays += statistics.rays + statistics.shadow_rays;
    head.paths += statistics.paths;
    return head;
}

void CheckpointWriter::join()
{
    if (placing_.joinable()) placing_.join();
}

void CheckpointWriter::tell_error()
{
    if (error_.empty()) return;
    fmt::print(stderr, "notice: {}; the render goes on and tries again\n", error_);
    error_.clear();
}

void CheckpointWriter::observe(const RenderState& state)
{
    has_changed_ = true;
    const Clock::time_point begin = Clock::now();
    if (begin < due_ || is_placing_) return;
    join();
    tell_error();
    try {
        begin_writing(state);
    } catch (const std::runtime_error& error) {
        error_ = error.what();
        tell_error();
    }
    const Clock::duration cost = Clock::now() - begin;
    seconds_spent_ += in_seconds(cost);
    const std::chrono::duration<double> rest = cost * (1 / largest_share);
    due_ = begin + std::max(between_, std::chrono::duration_cast<Clock::duration>(rest));
}

// The bytes go to the system here, while the film stands still; to the disk, on a thread.
void CheckpointWriter::begin_writing(const RenderState& state)
{
    auto file = std::make_unique<SafeFile>(path_);
    write_checkpoint(*file, head_now(state.schedule), state.film);
    is_placing_ = true;
    placing_ = std::thread([this, file = std::move(file)] {
        try {
            file->put_in_place();
            ++written_;
        } catch (const std::runtime_error& error) {
            error_ = error.what();
        }
        is_placing_ = false;
    });
}

void CheckpointWriter::finish(const Film& film, const Schedule& schedule)
{
    join();
    if (!has_changed_) return;
    SafeFile file(path_);
    write_checkpoint(file, head_now(schedule), film);
    file.put_in_place();
    ++written_;
    has_changed_ = false;
}

}  // namespace diptych
