// Who takes how much, by a clock that the test keeps.
#include "backends/work_list.hpp"

#include <gtest/gtest.h>

#include <numeric>

using namespace diptych;

namespace {

// Devices of stated speeds (items a second) that work through lists in simulated time.
class Workshop {
public:
    Workshop(std::vector<double> speeds, int most)
        : speeds_(std::move(speeds)), paces_(speeds_.size()), taken(speeds_.size()),
          idle(speeds_.size())
    {
        for (DevicePace& pace : paces_) pace.most = most;
    }

    void work(int items)
    {
        WorkList list(items, 1, paces_);
        std::vector<int> rendered(size_t(items), 0);
        std::vector<std::optional<Range>> running(speeds_.size());
        std::vector<double> end(speeds_.size(), 0);
        double now = 0;
        while (list.missing() > 0) {
            for (size_t d = 0; d < speeds_.size(); ++d)
                if (!running[d] && (running[d] = list.take_now(d, paces_[d].most))) {
                    EXPECT_LE(running[d]->count, paces_[d].most);
                    end[d] = now + running[d]->count / speeds_[d];
                }
            size_t next = speeds_.size();
            for (size_t d = 0; d < speeds_.size(); ++d)
                if (running[d] && (next == speeds_.size() || end[d] < end[next])) next = d;
            ASSERT_LT(next, speeds_.size()) << "nobody works, items are left";
            const Range range = *running[next];
            now = end[next];
            for (int k = 0; k < range.count; ++k) ++rendered[size_t(range.first + k)];
            taken[next] += range.count;
            list.done(next, range.count, range.count / speeds_[next]);
            running[next].reset();
        }
        for (const int times : rendered) ASSERT_EQ(times, 1);
        seconds += now;
        for (size_t d = 0; d < speeds_.size(); ++d) idle[d] += now - end[d];
    }

private:
    std::vector<double> speeds_;
    std::vector<DevicePace> paces_;

public:
    std::vector<int> taken;
    std::vector<double> idle;  // at the ends of lists
    double seconds = 0;
};

TEST(WorkList, GivesFasterDevicesMoreAndAllEndTogether)
{
    Workshop shop({1, 3, 8}, 128);
    for (int k = 0; k < 20; ++k) shop.work(1000);
    const double all = 20 * 1000;
    EXPECT_NEAR(shop.taken[0] / all, 1.0 / 12, 0.02);
    EXPECT_NEAR(shop.taken[1] / all, 3.0 / 12, 0.03);
    EXPECT_NEAR(shop.taken[2] / all, 8.0 / 12, 0.03);
    EXPECT_LT(shop.seconds, 1.05 * all / 12);
    for (const double idle : shop.idle) EXPECT_LT(idle, 0.1 * shop.seconds);
}

TEST(WorkList, DoesNotLetASlowDeviceHoldUpTheOthers)
{
    Workshop shop({1, 1000}, 64);
    for (int k = 0; k < 20; ++k) shop.work(64);
    EXPECT_LT(shop.taken[0], 10) << "only to learn how slow it is";
    EXPECT_EQ(shop.taken[0] + shop.taken[1], 20 * 64);
}

TEST(WorkList, EqualDevicesNeverWaitForEachOther)
{
    Workshop shop({5, 5, 5, 5}, 8);
    for (const int items : {1, 2, 3, 7, 64, 65}) shop.work(items);
    EXPECT_EQ(std::accumulate(shop.taken.begin(), shop.taken.end(), 0), 142);
}

TEST(WorkList, ItemsOfADeviceThatFailsAreForTheOthers)
{
    std::vector<DevicePace> paces(2);
    for (DevicePace& pace : paces) pace.most = 100;
    WorkList list(30, 1, paces);
    const Range lost = *list.take_now(0, 100);
    list.give_back(0, {&lost, 1});
    EXPECT_EQ(list.missing(), 30);
    EXPECT_FALSE(list.take_now(0, 100));
    while (list.missing() > 0) list.done(1, list.take(1, 4)->count, 1);
    list.close();
    EXPECT_FALSE(list.take(1, 4));
}

TEST(WorkList, GrowsAtItsEndAndIsCutOffBehindWhatSomebodyHas)
{
    std::vector<DevicePace> paces(2);
    for (DevicePace& pace : paces) pace.most = 4;
    WorkList list(4, 1, paces);
    const Range first = *list.take_now(0, 4);
    list.append(6);
    const Range second = *list.take_now(1, 2);
    EXPECT_EQ(second.first, first.count);
    list.give_back(0, {&first, 1});
    EXPECT_EQ(list.left(), 10 - second.count);
    EXPECT_EQ(list.cut_off(), second.first + second.count);
    EXPECT_EQ(list.left(), first.count) << "what came back is still to be rendered";
    while (list.left() > 0) list.done(1, list.take(1, 4)->count, 1);
    list.forget(second.count);
    EXPECT_EQ(list.missing(), 0);
    list.append(1);
    EXPECT_EQ(list.take(1, 4)->first, second.first + second.count);
}

}  // namespace
