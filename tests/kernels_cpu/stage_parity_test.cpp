// Stage by stage: every row of STAGES gives the same numbers on every backend, to the bit where
// that is promised (D1), else for all but one ray in a thousand (D2).
#include "common/as_cpp/path_rows.hpp"
#include "host/commands/trace_comparison.hpp"
#include "host/scene/load.hpp"
#include "tests/laws/measure.hpp"

#include <cmath>
#include <filesystem>
#include <set>

namespace {

using namespace diptych;

// One block of the picture, so many samples a pixel.
struct OneBlock {
    std::vector<WorkItem> items{{0, 0, 0, 0}};
    Dispatch dispatch;
    explicit OneBlock(int samples) : dispatch{items, samples} {}
};

// Two that run the same sources, compared after every stage.
void expect_parity(Backend& a, Backend& b, SceneData scene, const Bound& bound,
                   double share_that_may_part)
{
    SceneData other = scene;
    a.upload(scene);
    b.upload(other);
    const OneBlock block(8);
    const TraceComparison result = compare_traces(a, b, scene.effects, block.dispatch, bound);
    int parted = 0;
    for (const char has : result.has_parted) parted += has ? 1 : 0;
    EXPECT_LE(parted, share_that_may_part * block.dispatch.paths());
    if (result.first && parted > share_that_may_part * block.dispatch.paths())
        ADD_FAILURE() << "first in " << stage_names[result.first->stage] << ", bounce "
                      << result.first->bounce << ", path " << result.first->path << ", "
                      << result.first->buffer << ": " << result.first->a << " and "
                      << result.first->b;
#define EXPECT_COMPARED(name, body, when, needs)                             \
    if (STAGE_##name != STAGE_compact && STAGE_##name != STAGE_accumulate && \
        ((needs)&USER_TEXTURE_EFFECTS) == 0) {                               \
        EXPECT_GT(result.stages[STAGE_##name].paths, 0) << #name;            \
        EXPECT_GT(result.stages[STAGE_##name].values, 0) << #name;           \
    }
    STAGES(EXPECT_COMPARED)
#undef EXPECT_COMPARED
}

TEST(StageParity, DebugKernelsEqualTheTwinInEveryStage)
{
    BackendOptions debug;
    debug.debug_kernels = true;
    expect_parity(*make_backend("twin", {}), *make_backend("twin", debug), laws::busy_scene(16, 16),
                  {}, 0);
}

TEST(StageParity, OpenclEqualsTheTwinInEveryStage)
{
    std::unique_ptr<Backend> opencl;
    try {
        opencl = make_backend("opencl", {});
    } catch (const std::runtime_error& error) {
        GTEST_SKIP() << error.what();
    }
    expect_parity(*make_backend("twin", {}), *opencl, laws::busy_scene(16, 16), {}, 0);
}

TEST(StageParity, VectorisedKernelsFollowTheTwinInEveryStage)
{
    expect_parity(*make_backend("twin", {}), *make_backend("cpu", {}), laws::busy_scene(16, 16),
                  {.ulps = 0, .relative = 0}, 0.001);
}

// Single precision parts from double where a choice is close: few paths, at these bounces.
TEST(StageParity, DoubleFollowsTheTwinInEveryStage)
{
    expect_parity(*make_backend("twin", {}), *make_backend("double", {}), laws::busy_scene(16, 16),
                  {.ulps = 0, .relative = 2e-2}, 0.05);
}

struct Rays {
    int compared = 0;
    int differing = 0;
};

// Hits of the same rays on two backends; a path is let go where its hits first differ.
Rays compare_hits(Backend& a, Backend& b, const Dispatch& dispatch)
{
    struct Hits {
        std::vector<double> depth, triangle;
    };
    const auto hits_of = [&](Backend& backend) {
        std::vector<Hits> all;
        backend.trace(dispatch, [&](const StageState& state) {
            if (state.stage == STAGE_intersect)
                all.push_back({state.planes[row_depth], state.planes[row_hit_triangle]});
        });
        return all;
    };
    const std::vector<Hits> of_a = hits_of(a), of_b = hits_of(b);
    std::vector<char> is_gone(size_t(dispatch.paths()));
    Rays rays;
    for (size_t bounce = 0; bounce < std::min(of_a.size(), of_b.size()); ++bounce) {
        for (size_t p = 0; p < is_gone.size(); ++p) {
            const bool is_alive = of_a[bounce].depth[p] >= 0 && of_b[bounce].depth[p] >= 0;
            if (!is_alive || is_gone[p]) continue;
            ++rays.compared;
            is_gone[p] = of_a[bounce].triangle[p] != of_b[bounce].triangle[p];
            rays.differing += is_gone[p] ? 1 : 0;
        }
    }
    return rays;
}

class RealScene : public testing::TestWithParam<const char*> {};

TEST_P(RealScene, EmbreeFindsTheHitsOfOurWalk)
{
    const std::string file =
        std::string(DIPTYCH_SHARED) + "/scenes/" + GetParam() + "/" + GetParam() + ".glb";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    LoadOptions options;
    options.width = options.height = 32;
    SceneData scene = load_scene(file, options);
    scene.settings[0].max_bounces = 6;
    SceneData other = scene;
    const std::unique_ptr<Backend> cpu = make_backend("cpu", {}), twin = make_backend("twin", {});
    cpu->upload(scene);
    twin->upload(other);
    std::vector<WorkItem> items;
    for (int block = 0; block < 4; ++block) items.push_back({block % 2 * 16, block / 2 * 16, 0, 0});
    const Rays rays = compare_hits(*cpu, *twin, {items, QUANTUM});
    RecordProperty("rays", rays.compared);
    RecordProperty("differing", rays.differing);
    EXPECT_GT(rays.compared, 30000);
    EXPECT_LE(rays.differing, rays.compared / 1000);
    const laws::Measurement a = laws::measure(*cpu, scene), b = laws::measure(*twin, other);
    EXPECT_NEAR(a.mean(), b.mean(), 3e-3 * b.mean());
}

INSTANTIATE_TEST_SUITE_P(Shared, RealScene, testing::Values("gi-cornell-box", "gi-lux-kitchen"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::erase(name, '-');
                             return name;
                         });

}  // namespace
