// What several devices have under way from one dispatch to the next, so that none waits for
// another.
#pragma once

#include "backends/backend.hpp"
#include "backends/work_list.hpp"

#include <atomic>
#include <map>

namespace diptych {

// One thread lists work and takes finished items from the list's beginning; each device works in
// a thread of its own, until halt(). Items are numbered as they are listed, and all have as many
// samples and pixels.
class GroupFlight {
public:
    // paces: one of each device, outlives the flight.
    GroupFlight(int samples, int pixel_shift, std::vector<DevicePace>& paces);

    // Whether the dispatch begins with what has been listed and not been taken.
    bool goes_on(const Dispatch& dispatch) const;
    // Lists what the dispatch has more. following: as in Pace.
    void extend(const Dispatch& dispatch, size_t following);
    // Nothing is begun any more, and nothing else may be listed.
    void finish();
    // Nobody works any more; what is under way is forgotten.
    void halt();

    // Until something has happened since the last time, but not for long.
    void wait();
    // Items that are done, from the list's beginning on.
    int done() const;
    bool is_over() const { return list_.missing() == 0; }
    bool has_begun_all() const { return list_.left() == 0; }
    bool has_devices() const { return list_.has_devices(); }
    // Takes the first `count`, which are done.
    void take(int count, Results& results);

    // In a device's thread: renders until halt(), and observes after each of its dispatches. Throws
    // what the device throws; then give_back() leaves what the device had to the others.
    void work(size_t device, Backend& backend, bool streams, const std::function<void()>& observe);
    void give_back(size_t device);

private:
    // What a device has and has not done, in its order.
    struct Holding {
        std::vector<Range> ranges;
        std::vector<WorkItem> items;
    };
    struct Part {
        int count;
        Results results;
    };

    void add(Holding& holding, const Range& range);
    void hand_in(Holding& holding, int done, const Results& results);
    void tell();

    const int samples_;
    const int pixel_shift_;
    std::vector<DevicePace>& paces_;
    WorkList list_;
    std::vector<Holding> holdings_;  // each for its device's thread
    std::atomic<bool> is_halted_ = false;
    std::atomic<bool> is_finishing_ = false;
    std::atomic<size_t> following_ = 0;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool has_news_ = false;        // since the last wait
    std::vector<WorkItem> items_;  // listed and not taken
    int taken_ = 0;                // the number of the first of them
    std::map<int, Part> parts_;    // done and not taken, by the number of their first item
};

}  // namespace diptych
