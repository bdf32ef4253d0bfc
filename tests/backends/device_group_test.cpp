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
