#include "backends/device_group.hpp"

#include "backends/work_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace diptych {
namespace {

constexpr int pieces_ahead = 4;  // of each device, in a dispatch: few waits for the slowest

// Of a device whose slots are filled again and again: enough to keep them busy, so few that what is
// left can be shared.
int piece_items(const Plan& plan) { return std::clamp(4 * plan.items, 1, plan.most_items); }

// A plan's items are blocks of the largest size; an OpenCL device has room for four times as many
// of smaller ones.
int most_items(int planned, int pixel_shift)
{
    return planned << std::min(2, 2 * BLOCK_SHIFT - pixel_shift);
}

// The rows of `part`, `count` entries, to those of the whole from entry `first` on.
template<class Row>
void place(Row& whole, const Row& part, int entries, int first, int count)
{
    for (size_t plane = 0; plane * size_t(entries) < whole.size(); ++plane)
        std::copy_n(part.begin() + std::ptrdiff_t(plane * size_t(count)), count,
                    whole.begin() + std::ptrdiff_t(plane * size_t(entries)) + first);
}

class DeviceGroup final : public Backend {
public:
    DeviceGroup(std::vector<std::unique_ptr<Backend>> devices,
                std::function<void(const std::string&)> notify)
        : devices_(std::move(devices)), notify_(std::move(notify)), paces_(devices_.size()),
          paths_(devices_.size())
    {
        if (devices_.empty()) throw std::runtime_error("devices: an empty list; name one");
    }

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
    void render(const Dispatch& dispatch, Results& results) override;
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override;
    Statistics statistics() const override;

private:
    void make_room(const Dispatch& dispatch, Results& results) const;
    void work(size_t device, WorkList& list, const Dispatch& dispatch, Results& results);
    void drop(size_t device, const std::string& reason);
    [[noreturn]] void fail() const;

    template<class Update>
    void update(const Update& update)
    {
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
    std::vector<int> planned_;
    std::vector<unsigned long long> paths_;  // that each has rendered and that count
    std::array<int, std::tuple_size_v<decltype(texture_result_planes({}))>> texture_planes_{};
    std::mutex failures_;
    std::string last_failure_;
};

Plan DeviceGroup::plan(const SceneData& scene) const
{
    Plan sum;
    for (size_t d = 0; d < devices_.size(); ++d) {
        if (!paces_[d].lives) continue;
        const Plan plan = devices_[d]->plan(scene);
        sum.items += plan.items;
        sum.most_items += pieces_ahead * piece_items(plan);
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
    if (std::none_of(paces_.begin(), paces_.end(), [](auto& pace) { return pace.lives; })) fail();
    planned_.assign(devices_.size(), 1);
    std::fill(paths_.begin(), paths_.end(), 0);
    texture_planes_ = texture_result_planes(scene);
    for (size_t d = 0; d < devices_.size(); ++d) {
        if (!paces_[d].lives) continue;
        devices_[d]->upload(scene);
        planned_[d] = piece_items(devices_[d]->plan(scene));
        paces_[d].per_second = 0;
    }
}

void DeviceGroup::make_room(const Dispatch& dispatch, Results& results) const
{
    const size_t entries = size_t(dispatch.results());
#define RESIZE(type, name) results.name.resize(entries*(sizeof(type) / sizeof(PLANE(type))));
    RESULT_BUFFERS(RESIZE)
#undef RESIZE
    size_t row = 0;
#define RESIZE(type, name) results.name.resize(entries* size_t(texture_planes_[row++]));
    TEXTURE_RESULT_BUFFERS(RESIZE)
#undef RESIZE
}

void DeviceGroup::render(const Dispatch& dispatch, Results& results)
{
    make_room(dispatch, results);
    for (size_t d = 0; d < devices_.size(); ++d)
        paces_[d].most = most_items(planned_.at(d), dispatch.pixel_shift);
    const int paths_per_item = dispatch.samples << dispatch.pixel_shift;
    WorkList list(int(dispatch.items.size()), paths_per_item, paces_);
    {
        std::vector<std::jthread> threads;
        std::vector<size_t> living;
        for (size_t d = 0; d < devices_.size(); ++d)
            if (paces_[d].lives) living.push_back(d);
        for (const size_t d : living)
            threads.emplace_back([&, d] { work(d, list, dispatch, results); });
    }
    if (list.missing() > 0) fail();
}

void DeviceGroup::work(size_t device, WorkList& list, const Dispatch& dispatch, Results& results)
{
    using Clock = std::chrono::steady_clock;
    Results part;
    while (const std::optional<Range> range = list.take(device)) {
        Dispatch piece = dispatch;
        piece.items = dispatch.items.subspan(size_t(range->first), size_t(range->count));
        try {
            const Clock::time_point start = Clock::now();
            devices_[device]->render(piece, part);
            const int first = range->first << dispatch.pixel_shift;
#define PLACE(type, name) \
    place(results.name, part.name, dispatch.results(), first, piece.results());
            RESULT_BUFFERS(PLACE)
            TEXTURE_RESULT_BUFFERS(PLACE)
#undef PLACE
            const std::chrono::duration<double> taken = Clock::now() - start;
            paths_[device] += unsigned(piece.paths());
            list.done(device, *range, taken.count());
        } catch (const std::exception& error) {
            drop(device, error.what());  // before others go on, or end
            list.give_back(device, *range);
            return;
        }
    }
}

void DeviceGroup::drop(size_t device, const std::string& reason)
{
    const std::lock_guard lock(failures_);
    last_failure_ = fmt::format("{}: {}", devices_[device]->description(), reason);
    notify_(
        fmt::format("{}; it is dropped, what it had taken is rendered elsewhere", last_failure_));
}

void DeviceGroup::fail() const
{
    throw std::runtime_error("no device is left; the last that failed: " + last_failure_);
}

void DeviceGroup::trace(const Dispatch& dispatch,
                        const std::function<void(const StageState&)>& after_stage)
{
    for (size_t d = 0; d < devices_.size(); ++d)
        if (paces_[d].lives) return devices_[d]->trace(dispatch, after_stage);
    fail();
}

Statistics DeviceGroup::statistics() const
{
    Statistics sum;
    for (size_t d = 0; d < devices_.size(); ++d) {
        const Statistics own = devices_[d]->statistics();
        for (const auto& [stage, seconds] : own.stage_seconds) sum.stage_seconds[stage] += seconds;
        sum.setup_seconds += own.setup_seconds;
        sum.rays += own.rays;
        sum.shadow_rays += own.shadow_rays;
        sum.undecided_rays += own.undecided_rays;
        sum.allocated_bytes += own.allocated_bytes;
        sum.slot_steps += own.slot_steps;
        sum.busy_steps += own.busy_steps;
        sum.paths += paths_[d];
        sum.shares.push_back({devices_[d]->description(), paths_[d], !paces_[d].lives});
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
