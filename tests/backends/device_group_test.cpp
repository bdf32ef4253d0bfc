// Several devices give the picture of one, also when some fail on the way.
#include "backends/device_group.hpp"
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"

#include <algorithm>
#include <cstring>
#include <latch>
#include <stdexcept>

namespace {

using namespace diptych;
using namespace laws;

// The cpu backend, which fails at its n-th dispatch or update; those that never do wait in render()
// for the others to have failed.
class Failing final : public Backend {
public:
    Failing(std::string name, int fails_at, std::latch& failures)
        : name_(std::move(name)), fails_at_(fails_at), failures_(failures),
          cpu_(make_backend("cpu", {}))
    {
    }

    std::string description() const override { return name_; }
    Plan plan(const SceneData& scene) const override
    {
        Plan plan = cpu_->plan(scene);
        plan.items = plan.most_items = std::min(plan.items, 3);
        return plan;
    }
    void upload(SceneData& scene) override { cpu_->upload(scene); }
    void update_materials(const SceneData& scene) override
    {
        count();
        cpu_->update_materials(scene);
    }
    void update_textures(const SceneData& scene) override
    {
        count();
        cpu_->update_textures(scene);
    }
    void render(const Dispatch& dispatch, Results& results) override
    {
        count();
        if (fails_at_ == 0) failures_.wait();
        cpu_->render(dispatch, results);
    }
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override
    {
        cpu_->trace(dispatch, after_stage);
    }
    Statistics statistics() const override { return cpu_->statistics(); }

private:
    void count()
    {
        if (++calls_ != fails_at_) return;
        failures_.count_down();
        throw std::runtime_error("planned failure");
    }

    std::string name_;
    int fails_at_;
    std::latch& failures_;
    int calls_ = 0;
    std::unique_ptr<Backend> cpu_;
};

struct Group {
    std::vector<std::string> notices;
    std::latch failing;
    std::unique_ptr<Backend> backend;

    // Devices a, b, ...; 0: never fails
    explicit Group(const std::vector<int>& failures)
        : failing(std::ranges::count_if(failures, [](int at) { return at > 0; }))
    {
        std::vector<std::unique_ptr<Backend>> devices;
        for (const int fails_at : failures)
            devices.push_back(std::make_unique<Failing>(
                "device " + std::string(1, char('a' + devices.size())), fails_at, failing));
        backend = make_device_group(std::move(devices),
                                    [&](const std::string& line) { notices.push_back(line); });
    }
};

std::vector<float> beauty(Backend& backend, double error)
{
    SceneData scene = busy_scene(72, 40);
    backend.upload(scene);
    RenderOptions options;
    options.samples = error > 0 ? 256 : 32;
    options.error = error;
    return image::beauty_of(render(backend, scene, options).film.picture()).pixels;
}

bool is_same(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

TEST(DeviceGroup, GivesThePictureOfOneDevice)
{
    for (const double error : {0.0, 1.5}) {
        const std::vector<float> alone = beauty(*make_backend("cpu", {}), error);
        Group group({0, 0, 0});
        EXPECT_TRUE(is_same(alone, beauty(*group.backend, error))) << error;
        EXPECT_TRUE(group.notices.empty());
        const Statistics statistics = group.backend->statistics();
        ASSERT_EQ(statistics.shares.size(), 3u);
        unsigned long long paths = 0;
        for (const DeviceShare& share : statistics.shares) paths += share.paths;
        EXPECT_EQ(paths, statistics.paths);
        EXPECT_GE(paths, 72u * 40 * 32);
    }
}

TEST(DeviceGroup, DropsADeviceThatFailsAndLosesNothing)
{
    const std::vector<float> alone = beauty(*make_backend("cpu", {}), 0);
    for (const std::vector<int>& failures :
         {std::vector{1, 0}, {0, 2}, {3, 0, 1}, {1, 1, 0}, {2, 0, 2, 1}}) {
        Group group(failures);
        EXPECT_TRUE(is_same(alone, beauty(*group.backend, 0)));
        const std::vector<DeviceShare> shares = group.backend->statistics().shares;
        size_t dropped = 0;
        for (size_t d = 0; d < failures.size(); ++d) {
            if (!shares[d].is_dropped) continue;
            EXPECT_GT(failures[d], 0);
            ++dropped;
            const auto names_it = [&](const std::string& line) {
                return line.find(shares[d].device + ": planned failure") != std::string::npos;
            };
            EXPECT_EQ(std::ranges::count_if(group.notices, names_it), 1) << shares[d].device;
        }
        EXPECT_EQ(dropped, size_t(std::ranges::count_if(failures, [](int at) { return at > 0; })));
        EXPECT_EQ(group.notices.size(), dropped);
    }
}

TEST(DeviceGroup, ThrowsWhenNoDeviceIsLeft)
{
    Group group({2, 1});
    try {
        beauty(*group.backend, 0);
        FAIL() << "nobody is left to render";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no device is left"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("planned failure"), std::string::npos);
    }
    EXPECT_EQ(group.notices.size(), 2u);
}

std::vector<WorkItem> items_of(const SceneData& scene, int quanta)
{
    const Settings& picture = scene.settings[0];
    std::vector<WorkItem> items;
    for (int q = 0; q < quanta; ++q)
        for (const Pixel& corner : blocks_of(picture.width, picture.height, BLOCK_SHIFT))
            items.push_back({corner.x, corner.y, q * QUANTUM, 0});
    return items;
}

// The red sums of each item.
void append_items(std::vector<std::vector<float>>& red, const Results& results, int items)
{
    const size_t entries = size_t(1) << (2 * BLOCK_SHIFT);
    for (size_t k = 0; k < size_t(items); ++k) {
        const auto first = results.sum_radiance.begin() + std::ptrdiff_t(k * entries);
        red.emplace_back(first, first + std::ptrdiff_t(entries));
    }
}

TEST(DeviceGroup, LeavesADispatchAndGoesOnWithIt)
{
    SceneData scene = busy_scene(72, 40);
    const std::vector<WorkItem> items = items_of(scene, 4);
    const std::unique_ptr<Backend> cpu = make_backend("cpu", {});
    cpu->upload(scene);
    Results results;
    std::vector<std::vector<float>> expected, red;
    cpu->render({items}, results);
    append_items(expected, results, int(items.size()));

    Group group({0, 0, 0});
    group.backend->upload(scene);
    int times_left = 0;
    for (size_t first = 0; first < items.size();) {
        const std::span<const WorkItem> rest = std::span(items).subspan(first);
        const size_t listed = std::min<size_t>(rest.size(), 20);
        int asked = 0;
        const auto wish = [&] { return ++asked > 1 ? Wish::leave : Wish::go_on; };
        const int done =
            group.backend->advance({rest.first(listed)}, {rest.size() - listed, wish}, results);
        ASSERT_LE(size_t(done), listed);
        append_items(red, results, done);
        first += size_t(done);
        times_left += size_t(done) < listed ? 1 : 0;
    }
    EXPECT_EQ(red, expected);
    EXPECT_GT(times_left, 0) << "every dispatch was over before it could be left";
    EXPECT_EQ(group.backend->statistics().paths, 72u * 40 * 4 * QUANTUM);
}

TEST(DeviceGroup, FinishesWhatItHasBegunAndNothingElse)
{
    SceneData scene = busy_scene(72, 40);
    const std::vector<WorkItem> items = items_of(scene, 64);
    Group group({0, 0});
    group.backend->upload(scene);
    Results results;
    std::vector<std::vector<float>> expected, red;
    const int done = group.backend->advance({items}, {0, [] { return Wish::finish; }}, results);
    ASSERT_GT(done, 0);
    ASSERT_LT(size_t(done), items.size() / 2);
    append_items(red, results, done);
    group.backend->render({std::span(items).first(size_t(done))}, results);
    append_items(expected, results, done);
    EXPECT_EQ(red, expected);
}

TEST(DeviceGroup, AnUpdateThatTheFirstRefusesChangesNone)
{
    SceneData scene = busy_scene(16, 16);
    Group group({1, 0});
    group.backend->upload(scene);
    EXPECT_THROW(group.backend->update_materials(scene), std::runtime_error);
    EXPECT_TRUE(group.notices.empty());
    Group other({0, 1});
    other.backend->upload(scene);
    other.backend->update_textures(scene);
    EXPECT_EQ(other.notices.size(), 1u);
    EXPECT_TRUE(other.backend->statistics().shares[1].is_dropped);
}

}  // namespace
