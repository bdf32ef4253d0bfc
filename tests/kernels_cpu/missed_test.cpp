// Paths whose ray has met nothing cost no stage of surfaces, and bring what they would have with
// them.
#include "backends/bvh_build.hpp"
#include "backends/scene_view.hpp"
#include "kernels_cpu/chunk.hpp"
#include "tests/laws/measure.hpp"

#include "common/as_cpp/path_rows.hpp"

namespace {

using namespace diptych;

class Missed : public laws::OnEachBackend {};

// busy_scene in so wide a view that most rays of the camera, and many that scatter, leave it.
SceneData wide_scene()
{
    SceneData scene = laws::busy_scene(32, 32);
    Settings& settings = scene.settings[0];
    settings.camera_right.x *= 3;
    settings.camera_right.y *= 3;
    settings.camera_right.z *= 3;
    settings.camera_up.x *= 3;
    settings.camera_up.y *= 3;
    settings.camera_up.z *= 3;
    return scene;
}

TEST_P(Missed, PathsBringWhatTheyDoStageByStage)
{
    SceneData scene = wide_scene();
    backend_->upload(scene);
    const std::vector<WorkItem> items{{0, 0, 0, 0}, {16, 0, 0, 0}, {0, 16, 0, 0}, {16, 16, 0, 0}};
    const Dispatch dispatch{items, 8};
    Results results;
    backend_->render(dispatch, results);

    std::vector<double> radiance;
    std::vector<int> missed;
    backend_->trace(dispatch, [&](const StageState& state) {
        radiance = state.planes[row_radiance];
        if (state.stage != STAGE_intersect) return;
        const auto& hit = state.planes[row_hit_triangle];
        const auto& depth = state.planes[row_depth];
        int count = 0, alive = 0;
        for (size_t i = 0; i < hit.size(); ++i) {
            alive += depth[i] >= 0;
            count += depth[i] >= 0 && hit[i] < 0;
        }
        if (alive > 0) missed.push_back(100 * count / alive);
    });
    ASSERT_GT(missed.size(), 2u);
    EXPECT_GT(missed[0], 50);  // per cent of the camera's rays
    EXPECT_GT(missed[1], 25);

    const int entries = dispatch.results();
    for (int c = 0; c < 3; ++c)
        for (int entry = 0; entry < entries; ++entry) {
            const int item = entry >> dispatch.pixel_shift;
            const int in_item = entry & ((1 << dispatch.pixel_shift) - 1);
            double exact = 0;
            float rounded = 0;
            for (int sample = 0; sample < dispatch.samples; ++sample) {
                const int path = (item * dispatch.samples + sample) << dispatch.pixel_shift;
                const double value = radiance[size_t(c * dispatch.paths() + path + in_item)];
                exact += value;
                rounded += float(value);
            }
            const float sum = results.sum_radiance[size_t(c * entries + entry)];
            ASSERT_EQ(sum, GetParam() == "double" ? float(exact) : rounded) << entry;
        }
}

ON_EACH_BACKEND(Missed);

int lanes;  // that evaluate_surface was asked for

void count_lanes(const SceneView& scene, const PathView& paths, int first, int count)
{
    lanes += count;
    kernels_scalar::set.loop(STAGE_evaluate_surface, scene.effects)(scene, paths, first, count);
}

// How many of the paths of a block are asked for their surface, where it reaches to this place of
// the picture, from -1 on the left to 1.
int lanes_of(double right)
{
    SceneBuilder builder;
    builder.place(builder.add_mesh(
        quad_mesh({-1, -1, 0}, {1 + right, 0, 0}, {0, 2, 0}, builder.add_material({}))));
    laws::look(builder, {0, 0, 1}, {0, 0, 0}, 1);
    SceneData scene = laws::finish(builder, 0);
    build_bvh(scene);
    const std::vector<const void*> buffers = buffers_of(scene);
    const SceneView scene_view{scene.effects, buffers.data(), nullptr};

    KernelSet kernels = kernels_scalar::set;
    kernels.loop = [](Stage stage, unsigned effects) -> StageLoop {
        if (stage == STAGE_evaluate_surface) return count_lanes;
        return kernels_scalar::set.loop(stage, effects);
    };
    constexpr int entries = 256, samples = 4;
    std::vector<std::vector<float>> memory;
    std::vector<void*> planes;
#define ADD_PLANE(type, name)                       \
    memory.emplace_back(size_t(entries) * 3, 0.0f); \
    planes.push_back(memory.back().data());
    RESULT_BUFFERS(ADD_PLANE)
#undef ADD_PLANE
    std::vector<void*> texture_planes(2, nullptr);
    PathView view;
    view.results = entries;
    view.samples = samples;
    view.pixel_shift = 2 * BLOCK_SHIFT;
    view.result_planes = planes.data();
    view.texture_result_planes = texture_planes.data();
    const WorkItem item{0, 0, 0, 0};
    view.items = &item;
    lanes = 0;
    Chunk(kernels, nullptr, scene_view).run(view, 0, 1);
    return lanes;
}

TEST(MissedLanes, AreLeftOutWhereNeighboursMissTogether)
{
    EXPECT_EQ(lanes_of(1), 1024);  // all of the picture
    EXPECT_EQ(lanes_of(0), 512);   // its left half
}

}  // namespace
