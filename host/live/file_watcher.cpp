#include "host/live/file_watcher.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <poll.h>
#include <string_view>
#include <sys/inotify.h>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_read = std::uintmax_t(16) << 20;
// Where no events come from (network folders, targets of links), times are looked at this often.
constexpr std::chrono::milliseconds look_every{500};
// File systems stamp files by a clock that ticks this coarsely.
constexpr std::chrono::milliseconds clock_tick{20};

size_t digest_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    return std::hash<std::string_view>{}(bytes);
}

// Parent folder, and the one that a link leads to.
std::set<fs::path> folders_of(const fs::path& file)
{
    std::error_code error;
    std::set<fs::path> folders = {file.has_parent_path() ? file.parent_path() : fs::path(".")};
    const fs::path real = fs::canonical(file, error);
    if (!error) folders.insert(real.parent_path());
    return folders;
}

}  // namespace

FileWatcher::FileWatcher() : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

FileWatcher::~FileWatcher()
{
    if (events_ >= 0) close(events_);
}

std::optional<FileWatcher::Stamp> FileWatcher::stamp_of(const fs::path& file, const Stamp* last)
{
    std::error_code error;
    Stamp stamp;
    stamp.time = fs::last_write_time(file, error);
    if (error) return std::nullopt;
    stamp.size = fs::file_size(file, error);
    if (error || !fs::is_regular_file(file, error)) return std::nullopt;
    if (last && last->digest && last->time == stamp.time && last->size == stamp.size) return *last;
    if (stamp.size <= largest_read) stamp.digest = digest_of(file);
    return stamp;
}

void FileWatcher::watch(const std::vector<fs::path>& files, fs::file_time_type read_at)
{
    for (const auto& [number, folder] : folders_) inotify_rm_watch(events_, number);
    folders_.clear();
    std::map<fs::path, Stamp> stamps;
    for (const fs::path& file : files) {
        for (const fs::path& folder : folders_of(file)) {
            const int number = events_ < 0
                                   ? -1
                                   : inotify_add_watch(events_, folder.c_str(),
                                                       IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE);
            if (number >= 0) folders_[number] = folder;
        }
        const auto old = files_.find(file);
        Stamp stamp = old != files_.end() ? old->second : stamp_of(file, nullptr).value_or(Stamp{});
        if (old == files_.end() && stamp.time >= read_at - clock_tick) stamp = {};
        stamps[file] = stamp;
    }
    files_ = std::move(stamps);
    last_look_ = {};
}

void FileWatcher::read_events()
{
    alignas(inotify_event) char buffer[16384];
    for (;;) {
        const ssize_t got = events_ < 0 ? -1 : read(events_, buffer, sizeof buffer);
        if (got <= 0) return;
        for (ssize_t at = 0; at < got;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            at += ssize_t(sizeof *event + event->len);
            const auto folder = folders_.find(event->wd);
            const bool is_ours =
                (event->mask & IN_Q_OVERFLOW) != 0 ||
                (folder != folders_.end() && std::ranges::any_of(files_, [&](const auto& file) {
                     return file.first.filename() == fs::path(event->name).filename();
                 }));
            if (!is_ours) continue;
            last_event_ = Clock::now();
            if (!has_event_) first_event_ = last_event_;
            has_event_ = true;
        }
    }
}

std::vector<fs::path> FileWatcher::changed()
{
    read_events();
    const Clock::time_point now = Clock::now();
    if (has_event_ ? now - last_event_ < settle : now - last_look_ < look_every) return {};
    noticed_ = has_event_ ? first_event_ : now;
    has_event_ = false;
    last_look_ = now;
    std::vector<fs::path> changed;
    for (auto& [file, last] : files_) {
        const std::optional<Stamp> stamp = stamp_of(file, &last);
        if (!stamp) continue;
        const bool is_same =
            stamp->digest && last.digest
                ? stamp->digest == last.digest
                : !stamp->digest && stamp->time == last.time && stamp->size == last.size;
        last = *stamp;
        if (!is_same) changed.push_back(file);
    }
    return changed;
}

void FileWatcher::wait(double seconds, int other)
{
    read_events();
    const double soon = std::chrono::duration<double>(settle).count();
    const double longest = std::min(seconds, std::chrono::duration<double>(look_every).count());
    pollfd ready[2] = {{events_, POLLIN, 0}, {other, POLLIN, 0}};
    poll(ready, 2, int(1000 * (has_event_ ? soon : longest)) + 1);
}

}  // namespace diptych
