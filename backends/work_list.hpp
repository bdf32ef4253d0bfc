// One list of work items for several devices that work at it at the same time.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace diptych {

struct Range {
    int first = 0, count = 0;
};

// What is known of a device; kept from one list to the next.
struct DevicePace {
    int most = 1;           // items that it takes at once
    double per_second = 0;  // paths, lately; 0: not measured yet
    bool lives = true;
};

// Guided self-scheduling: a device takes a part of what is left in proportion to its speed, so that
// pieces become smaller towards the end and all devices end together. One that would need longer
// for its piece than the fastest for all that is left takes none. Who takes what decides about time
// only. Thread-safe.
class WorkList {
public:
    // paths_per_item: what speeds are measured in. paces: one of each device, outlives the list.
    WorkList(int items, int paths_per_item, std::vector<DevicePace>& paces);

    // At the end of the list. Items are taken from its beginning.
    void append(int items);
    // What nobody has taken behind the last that somebody has is not to be rendered; returns how
    // many items the list then has.
    int cut_off();
    // Nobody waits any more.
    void close();

    // Waits for items that this device should render, `most` at most; none: the list is closed.
    std::optional<Range> take(size_t device, int most);
    // The same without waiting; none: not now.
    std::optional<Range> take_now(size_t device, int most);
    void done(size_t device, int items, double seconds);
    // So many that somebody has are not to be rendered.
    void forget(int items);
    // The device has failed: its items are for the others.
    void give_back(size_t device, std::span<const Range> ranges);

    // Items that nobody has rendered, and those of them that nobody has taken.
    int missing() const;
    int left() const;
    bool has_devices() const;

private:
    std::optional<Range> cut(size_t device, int most);
    int piece(size_t device) const;

    int paths_per_item_;
    std::vector<DevicePace>& paces_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Range> left_;  // the last is taken from first; the end of the list is the first
    int items_;
    int left_count_;
    int running_count_ = 0;
    bool is_closed_ = false;
};

}  // namespace diptych
