#include "backends/work_list.hpp"

#include <algorithm>
#include <cmath>

namespace diptych {
namespace {

// Fewer items leave a device of that capacity half idle.
int least_items(const DevicePace& pace) { return std::max(1, pace.most / 16); }

}  // namespace

WorkList::WorkList(int items, int paths_per_item, std::vector<DevicePace>& paces)
    : paths_per_item_(paths_per_item), paces_(paces), left_{{0, items}}, items_(items),
      left_count_(items)
{
}

void WorkList::append(int items)
{
    const std::lock_guard lock(mutex_);
    if (left_.empty() || left_.front().first + left_.front().count < items_)
        left_.insert(left_.begin(), {items_, 0});
    left_.front().count += items;
    items_ += items;
    left_count_ += items;
    changed_.notify_all();
}

int WorkList::cut_off()
{
    const std::lock_guard lock(mutex_);
    if (!left_.empty() && left_.front().first + left_.front().count == items_) {
        left_count_ -= left_.front().count;
        items_ = left_.front().first;
        left_.erase(left_.begin());
    }
    return items_;
}

void WorkList::close()
{
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
}

int WorkList::piece(size_t device) const
{
    const DevicePace& own = paces_[device];
    double all = 0, fastest_other = 0;
    bool is_alone = true;
    for (size_t d = 0; d < paces_.size(); ++d) {
        if (!paces_[d].lives) continue;
        all += paces_[d].per_second;
        if (d == device) continue;
        is_alone = false;
        fastest_other = std::max(fastest_other, paces_[d].per_second);
    }
    if (is_alone) return std::min(left_count_, own.most);
    if (own.per_second <= 0) return std::min(left_count_, least_items(own));
    const int share = int(std::ceil(0.5 * left_count_ * own.per_second / all));
    const int count = std::min(std::clamp(share, least_items(own), own.most), left_count_);
    const bool is_in_the_way = count * fastest_other > left_count_ * own.per_second;
    return is_in_the_way ? 0 : count;
}

std::optional<Range> WorkList::cut(size_t device, int most)
{
    if (left_count_ == 0 || !paces_[device].lives) return std::nullopt;
    Range& from = left_.back();
    const int count = std::min({piece(device), from.count, most});
    if (count == 0) return std::nullopt;
    const Range taken{from.first, count};
    from.first += count;
    from.count -= count;
    if (from.count == 0) left_.pop_back();
    left_count_ -= count;
    running_count_ += count;
    return taken;
}

std::optional<Range> WorkList::take_now(size_t device, int most)
{
    const std::lock_guard lock(mutex_);
    return cut(device, most);
}

std::optional<Range> WorkList::take(size_t device, int most)
{
    std::unique_lock lock(mutex_);
    while (!is_closed_) {
        if (const std::optional<Range> range = cut(device, most)) return range;
        changed_.wait(lock);  // for the end, for more, or for what a device that fails gives back
    }
    return std::nullopt;
}

void WorkList::done(size_t device, int items, double seconds)
{
    const std::lock_guard lock(mutex_);
    DevicePace& pace = paces_[device];
    const double now = double(items) * paths_per_item_ / std::max(seconds, 1e-9);
    pace.per_second = pace.per_second > 0 ? 0.5 * (pace.per_second + now) : now;
    running_count_ -= items;
    changed_.notify_all();
}

void WorkList::forget(int items)
{
    const std::lock_guard lock(mutex_);
    running_count_ -= items;
    changed_.notify_all();
}

void WorkList::give_back(size_t device, std::span<const Range> ranges)
{
    const std::lock_guard lock(mutex_);
    paces_[device].lives = false;
    for (const Range& range : ranges) {
        left_.push_back(range);
        left_count_ += range.count;
        running_count_ -= range.count;
    }
    changed_.notify_all();
}

int WorkList::missing() const
{
    const std::lock_guard lock(mutex_);
    return left_count_ + running_count_;
}

int WorkList::left() const
{
    const std::lock_guard lock(mutex_);
    return left_count_;
}

bool WorkList::has_devices() const
{
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(paces_, &DevicePace::lives);
}

}  // namespace diptych
