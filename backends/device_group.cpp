#include "backends/device_group.hpp"

#include "backends/group_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace diptych {
namespace {

// Of what each device holds, in a dispatch: few waits for the slowest.
constexpr int pieces_ahead = 4;

// Whether paths stay under way in a device from one dispatch to the next.
bool is_streaming(const Plan& plan) { return plan.most_items > plan.items; }

// That a device has at once: of one whose slots are filled again and again, an entry for each, and
// a few for those that end first.
int items_held(const Plan& plan)
{
    return is_streaming(plan) ? std::min(plan.items * (QUANTUM + QUANTUM / 4), plan.most_items)
                              : plan.most_items;
}

// A plan's items are blocks of the largest size; an OpenCL device has room for four times as many
// of smaller ones.
int most_items(int planned, int pixel_shift)
{
    return planned << std::min(2, 2 * BLOCK_SHIFT - pixel_shift);
}

class DeviceGroup final : public Backend {
public:
    DeviceGroup(std::vector<std::unique_ptr<Backend>> devices,
                std::function<void(const std::string&)> notify)
        : devices_(std::move(devices)), notify_(std::move(notify)), paces_(devices_.size()),
          held_(devices_.size()), streams_(devices_.size()), reported_(devices_.size()),
          is_dropped_(devices_.size())
    {
        if (devices_.empty()) throw std::runtime_error("devices: an empty list; name one");
    }
    ~DeviceGroup() override { halt(); }

    std::string description() const override
    {
        std::vector<std::string> names;
        for (const auto& device : devices_) names.push_back(device->description());
        return fmt::format("{} devices: {}", names.size(), fmt::join(names, " + "));
    }

    Plan plan(const SceneData& scene) const override;
    void upload(SceneData& scene) override;
    void update_materials(const SceneData& scene) override
    {
        update([&](Backend& device) { device.update_materials(scene); });
    }
    void update_textures(const SceneData& scene) override
    {
        update([&](Backend& device) { device.update_textures(scene); });
    }
    void render(const Dispatch& dispatch, Results& results) override
    {
        halt();
        advance(dispatch, {}, results);
    }
    int advance(const Dispatch& dispatch, const Pace& pace, Results& results) override;
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override;
    Statistics statistics() const override;

private:
    void begin_flight(const Dispatch& dispatch);
    void halt();
    void work(size_t device);
    void report(size_t device);
    void drop(size_t device, const std::string& reason);
    [[noreturn]] void fail();

    template<class Update>
    void update(const Update& update)
    {
        halt();
        bool is_first = true;
        for (size_t d = 0; d < devices_.size(); ++d) {
            if (!paces_[d].lives) continue;
            try {
                update(*devices_[d]);
            } catch (const std::exception& error) {
                if (is_first) throw;
                paces_[d].lives = false;
                drop(d, error.what());
            }
            is_first = false;
        }
    }

    std::vector<std::unique_ptr<Backend>> devices_;
    std::function<void(const std::string&)> notify_;
    std::vector<DevicePace> paces_;
    std::vector<int> held_;  // items that each has at most
    std::vector<char> streams_;

    mutable std::mutex mutex_;  // of what follows, which threads of devices write
    std::vector<Statistics> reported_;
    std::vector<char> is_dropped_;
    std::string last_failure_;

    std::unique_ptr<GroupFlight> flight_;
    std::vector<std::jthread> threads_;  // a device each, while there is a flight
};

Plan DeviceGroup::plan(const SceneData& scene) const
{
    Plan sum;
    for (size_t d = 0; d < devices_.size(); ++d) {
        if (!paces_[d].lives) continue;
        const Plan plan = devices_[d]->plan(scene);
        sum.items += plan.items;
        sum.most_items += pieces_ahead * items_held(plan);
        sum.scene_bytes += plan.scene_bytes;
        sum.texture_bytes += plan.texture_bytes;
        sum.structure_bytes += plan.structure_bytes;
        sum.path_bytes += plan.path_bytes;
        sum.film_bytes += plan.film_bytes;
    }
    return sum;
}

void DeviceGroup::upload(SceneData& scene)
{
    halt();
    if (std::none_of(paces_.begin(), paces_.end(), [](auto& pace) { return pace.lives; })) fail();
    for (size_t d = 0; d < devices_.size(); ++d) {
        reported_[d] = {};
        if (!paces_[d].lives) continue;
        devices_[d]->upload(scene);
        const Plan plan = devices_[d]->plan(scene);
        held_[d] = items_held(plan);
        streams_[d] = is_streaming(plan) ? 1 : 0;
        paces_[d].per_second = 0;
        reported_[d] = devices_[d]->statistics();
    }
}

void DeviceGroup::begin_flight(const Dispatch& dispatch)
{
    halt();
    for (size_t d = 0; d < devices_.size(); ++d)
        paces_[d].most = most_items(held_[d], dispatch.pixel_shift);
    flight_ = std::make_unique<GroupFlight>(dispatch.samples, dispatch.pixel_shift, paces_);
    for (size_t d = 0; d < devices_.size(); ++d)
        if (paces_[d].lives) threads_.emplace_back([this, d] { work(d); });
}

void DeviceGroup::halt()
{
    if (flight_) flight_->halt();
    threads_.clear();
    flight_.reset();
}

int DeviceGroup::advance(const Dispatch& dispatch, const Pace& pace, Results& results)
{
    if (!flight_ || !flight_->goes_on(dispatch)) begin_flight(dispatch);
    flight_->extend(dispatch, pace.following);
    const int all = int(dispatch.items.size());
    int done = 0;
    bool is_finishing = false;
    for (bool is_left = false; !is_left;) {
        flight_->wait();
        if (!flight_->has_devices()) fail();
        const Wish wish = pace.wish ? pace.wish() : Wish::go_on;
        if (wish == Wish::finish && !is_finishing) {
            is_finishing = true;
            flight_->finish();
        }
        const bool is_over = flight_->is_over();
        done = flight_->done();
        const bool is_list_short = pace.following > 0 && done > 0 && flight_->has_begun_all();
        is_left = wish == Wish::leave || is_list_short || done == all || (is_finishing && is_over);
    }
    flight_->take(done, results);
    if (is_finishing) halt();
    return done;
}

void DeviceGroup::work(size_t device)
{
    try {
        flight_->work(device, *devices_[device], streams_[device] != 0, [&] { report(device); });
    } catch (const std::exception& error) {
        drop(device, error.what());  // before others go on, or end
        flight_->give_back(device);
    }
}

void DeviceGroup::report(size_t device)
{
    Statistics now = devices_[device]->statistics();
    const std::lock_guard lock(mutex_);
    reported_[device] = std::move(now);
}

void DeviceGroup::drop(size_t device, const std::string& reason)
{
    const std::lock_guard lock(mutex_);
    is_dropped_[device] = 1;
    last_failure_ = fmt::format("{}: {}", devices_[device]->description(), reason);
    notify_(
        fmt::format("{}; it is dropped, what it had taken is rendered elsewhere", last_failure_));
}

void DeviceGroup::fail()
{
    halt();
    throw std::runtime_error("no device is left; the last that failed: " + last_failure_ +
                             "; name others with --device, or use --backend cpu");
}

void DeviceGroup::trace(const Dispatch& dispatch,
                        const std::function<void(const StageState&)>& after_stage)
{
    halt();
    for (size_t d = 0; d < devices_.size(); ++d)
        if (paces_[d].lives) return devices_[d]->trace(dispatch, after_stage);
    fail();
}

Statistics DeviceGroup::statistics() const
{
    const std::lock_guard lock(mutex_);
    Statistics sum;
    for (size_t d = 0; d < devices_.size(); ++d) {
        const Statistics& own = reported_[d];
        for (const auto& [stage, seconds] : own.stage_seconds) sum.stage_seconds[stage] += seconds;
        sum.setup_seconds += own.setup_seconds;
        sum.rays += own.rays;
        sum.shadow_rays += own.shadow_rays;
        sum.undecided_rays += own.undecided_rays;
        sum.allocated_bytes += own.allocated_bytes;
        sum.slot_steps += own.slot_steps;
        sum.busy_steps += own.busy_steps;
        sum.paths += own.paths;
        sum.shares.push_back({devices_[d]->description(), own.paths, is_dropped_[d] != 0});
    }
    return sum;
}

}  // namespace

std::unique_ptr<Backend> make_device_group(std::vector<std::unique_ptr<Backend>> devices,
                                           std::function<void(const std::string&)> notify)
{
    return std::make_unique<DeviceGroup>(std::move(devices), std::move(notify));
}

}  // namespace diptych
