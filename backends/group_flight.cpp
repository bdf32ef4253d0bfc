#include "backends/group_flight.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace diptych {
namespace {

constexpr double longest_piece = 0.25;  // seconds, of a device that cannot leave one half done
constexpr std::chrono::milliseconds between_wishes{10};

// Entries of all planes: `count` of them, from `first` on, of a part that has `of_part`, to those
// from `at` on of a whole that has `of_whole`.
struct Placing {
    size_t first, count, of_part, at, of_whole;
};

template<class Row>
void place(Row& whole, const Row& part, const Placing& entries)
{
    whole.resize(part.size() / entries.of_part * entries.of_whole);
    for (size_t plane = 0; plane * entries.of_part < part.size(); ++plane)
        std::copy_n(part.begin() + std::ptrdiff_t(plane * entries.of_part + entries.first),
                    entries.count,
                    whole.begin() + std::ptrdiff_t(plane * entries.of_whole + entries.at));
}

void place(Results& whole, const Results& part, const Placing& entries)
{
#define PLACE(type, name) place(whole.name, part.name, entries);
    RESULT_BUFFERS(PLACE)
    TEXTURE_RESULT_BUFFERS(PLACE)
#undef PLACE
}

}  // namespace

GroupFlight::GroupFlight(int samples, int pixel_shift, std::vector<DevicePace>& paces)
    : samples_(samples), pixel_shift_(pixel_shift), paces_(paces),
      list_(0, samples << pixel_shift, paces), holdings_(paces.size())
{
}

bool GroupFlight::goes_on(const Dispatch& dispatch) const
{
    return begins_with(dispatch, items_, samples_, pixel_shift_);
}

void GroupFlight::extend(const Dispatch& dispatch, size_t following)
{
    const std::span<const WorkItem> more = dispatch.items.subspan(items_.size());
    {
        const std::lock_guard lock(mutex_);
        items_.insert(items_.end(), more.begin(), more.end());
    }
    following_ = following;
    if (!more.empty()) list_.append(int(more.size()));
}

void GroupFlight::finish()
{
    following_ = 0;
    is_finishing_ = true;
    list_.cut_off();
}

void GroupFlight::halt()
{
    is_halted_ = true;
    list_.close();
}

void GroupFlight::wait()
{
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, between_wishes, [&] { return has_news_; });
    has_news_ = false;
}

void GroupFlight::tell()
{
    const std::lock_guard lock(mutex_);
    has_news_ = true;
    changed_.notify_all();
}

int GroupFlight::done() const
{
    const std::lock_guard lock(mutex_);
    int end = taken_;
    for (auto part = parts_.find(end); part != parts_.end(); part = parts_.find(end))
        end += part->second.count;
    return end - taken_;
}

void GroupFlight::take(int count, Results& results)
{
    const std::lock_guard lock(mutex_);
    for (int at = 0; at < count;) {
        const auto part = parts_.find(taken_);
        const size_t entries = size_t(part->second.count) << pixel_shift_;
        place(results, part->second.results,
              {0, entries, entries, size_t(at) << pixel_shift_, size_t(count) << pixel_shift_});
        at += part->second.count;
        taken_ += part->second.count;
        parts_.erase(part);
    }
    items_.erase(items_.begin(), items_.begin() + count);
}

void GroupFlight::add(Holding& holding, const Range& range)
{
    const std::lock_guard lock(mutex_);
    const auto first = items_.begin() + (range.first - taken_);
    holding.ranges.push_back(range);
    holding.items.insert(holding.items.end(), first, first + range.count);
}

void GroupFlight::hand_in(Holding& holding, int done, const Results& results)
{
    const std::lock_guard lock(mutex_);
    for (int first = 0; first < done;) {
        Range& range = holding.ranges.front();
        const int count = std::min(range.count, done - first);
        Part& part = parts_[range.first];
        part.count = count;
        const size_t entries = size_t(count) << pixel_shift_;
        place(part.results, results,
              {size_t(first) << pixel_shift_, entries, size_t(done) << pixel_shift_, 0, entries});
        first += count;
        range.first += count;
        range.count -= count;
        if (range.count == 0) holding.ranges.erase(holding.ranges.begin());
    }
    holding.items.erase(holding.items.begin(), holding.items.begin() + done);
}

void GroupFlight::work(size_t device, Backend& backend, bool streams,
                       const std::function<void()>& observe)
{
    using Clock = std::chrono::steady_clock;
    Holding& held = holdings_[device];
    const DevicePace& pace = paces_[device];
    const double paths_per_item = double(samples_ << pixel_shift_);
    double seconds = 0;  // since something was done
    Results results;
    while (!is_halted_) {
        const bool is_idle = held.items.empty();
        const double paced = longest_piece * pace.per_second / paths_per_item;
        const int most = streams || pace.per_second <= 0
                             ? pace.most
                             : int(std::clamp(paced, 1.0, double(pace.most)));
        const int room = most - int(held.items.size());
        const std::optional<Range> more =
            is_idle ? list_.take(device, most) : list_.take_now(device, room);
        if (is_idle && !more) return;
        if (more) add(held, *more);
        const bool is_all_begun = list_.left() == 0;
        bool is_last = false;
        const auto wish = [&] {
            if (is_halted_ || (is_all_begun && list_.left() > 0)) return Wish::leave;
            is_last = is_finishing_;
            return is_last ? Wish::finish : Wish::go_on;
        };
        const bool gets_more = more || room <= 0;
        const size_t following = gets_more ? size_t(list_.left()) + following_ : 0;
        const Clock::time_point start = Clock::now();
        const int done =
            backend.advance({held.items, samples_, pixel_shift_}, {following, wish}, results);
        seconds += std::chrono::duration<double>(Clock::now() - start).count();
        if (is_halted_) return;
        observe();
        if (done > 0) {
            hand_in(held, done, results);
            list_.done(device, done, std::exchange(seconds, 0));
        }
        if (is_last) {  // it has begun no more of them
            list_.forget(int(held.items.size()));
            held = {};
        }
        tell();
    }
}

void GroupFlight::give_back(size_t device)
{
    list_.give_back(device, std::exchange(holdings_[device], {}).ranges);
    tell();
}

}  // namespace diptych
