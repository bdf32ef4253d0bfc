// Tells which of a few files have been saved anew, however an editor saves: in place, or as another
// file that is renamed.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace diptych {

class FileWatcher {
public:
    using Clock = std::chrono::steady_clock;

    FileWatcher();
    ~FileWatcher();
    FileWatcher(const FileWatcher&) = delete;
    FileWatcher& operator=(const FileWatcher&) = delete;

    // Watches these, instead of those before. What they hold now is what changes are told from; of
    // a file that was written since `read_at` that is not known, and it counts as changed.
    void
    watch(const std::vector<std::filesystem::path>& files,
          std::filesystem::file_time_type read_at = std::filesystem::file_time_type::clock::now());

    // The watched files whose bytes are others than when this was last asked; of large files
    // (above 16 MiB) whose size or time is. Nothing while a save may still be under way: for
    // `settle` after the last event. A file that is gone is not a change: its rename may follow.
    std::vector<std::filesystem::path> changed();

    // Waits until changed() may have something to say, at most `seconds`; or until `other`, a file
    // descriptor (-1: none), can be read.
    void wait(double seconds, int other = -1);

    // When the first save was noticed of what changed() last returned.
    Clock::time_point noticed() const { return noticed_; }

    static constexpr std::chrono::milliseconds settle{10};

private:
    struct Stamp {
        std::filesystem::file_time_type time{};
        std::uintmax_t size = 0;
        std::optional<size_t> digest;  // of the bytes; none: not known, or too large a file
    };
    static std::optional<Stamp> stamp_of(const std::filesystem::path& file, const Stamp* last);
    void read_events();

    int events_ = -1;  // of inotify; -1: there is none, and times alone are looked at
    std::map<int, std::filesystem::path> folders_;  // by inotify's number
    std::map<std::filesystem::path, Stamp> files_;
    bool has_event_ = false;
    Clock::time_point first_event_, last_event_, last_look_;
    Clock::time_point noticed_;
};

}  // namespace diptych
