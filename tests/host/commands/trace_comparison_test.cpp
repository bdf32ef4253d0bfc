// A path's state, stage by stage, on two backends: equal where they are, named where they part.
#include "host/commands/trace_comparison.hpp"

#include "backends/cpu_backend.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "host/commands/selftest_scenes.hpp"
#include "tests/host/commands/faulty_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace diptych;

namespace {

constexpr WorkItem block = {16, 16, 0, 0};

// Against twin.
TraceComparison compare(std::unique_ptr<Backend> backend, SceneData& scene, const Bound& bound)
{
    const auto twin = make_backend("twin", {});
    twin->upload(scene);
    backend->upload(scene);
    return compare_traces(*backend, *twin, scene.effects, {{&block, 1}, 4}, bound);
}

std::unique_ptr<Backend> faulty_backend() { return make_cpu_backend(kernels_faulty::set, {}); }

TEST(TraceComparison, ABackendAgreesWithItself)
{
    for (SelftestScene& scene : selftest_scenes()) {
        const TraceComparison same = compare(make_backend("twin", {}), scene.scene, {});
        EXPECT_FALSE(same.first) << scene.name;
        for (const StageTally& tally : same.stages) EXPECT_EQ(tally.largest_ulps, 0);
        EXPECT_GT(same.stages[STAGE_sample_bsdf].values, 1000);
        EXPECT_GT(same.stages[STAGE_occlusion].values, 10);
    }
}

// Kernels for a debugger, and the vectorised ones, have no numbers of their own.
TEST(TraceComparison, DebugAndVectorisedKernelsGiveTheSameBits)
{
    BackendOptions debugging;
    debugging.debug_kernels = true;
    for (SelftestScene& scene : selftest_scenes()) {
        const TraceComparison debug = compare(make_backend("twin", debugging), scene.scene, {});
        EXPECT_FALSE(debug.first) << scene.name;
        const TraceComparison vector = compare(make_backend("cpu", {}), scene.scene, {});
        for (const Stage stage : {STAGE_generate_paths, STAGE_evaluate_surface, STAGE_add_emission,
                                  STAGE_sample_light, STAGE_sample_bsdf})
            EXPECT_EQ(vector.stages[stage].largest_ulps, 0)
                << scene.name << " " << stage_names[stage];
    }
}

TEST(TraceComparison, NamesTheStageThatAPlantedFaultSpoils)
{
    for (SelftestScene& scene : selftest_scenes()) {
        SCOPED_TRACE(scene.name);
        const TraceComparison spoilt = compare(faulty_backend(), scene.scene, {});
        if ((scene.scene.effects & EFFECT_ENVIRONMENT) == 0) {
            EXPECT_FALSE(spoilt.first);
            continue;
        }
        ASSERT_TRUE(spoilt.first);
        EXPECT_EQ(spoilt.first->stage, STAGE_add_emission);
        EXPECT_STREQ(spoilt.first->buffer, "radiance");
        EXPECT_NE(spoilt.first->a, spoilt.first->b);
        for (int stage = 0; stage < STAGE_COUNT; ++stage)
            EXPECT_EQ(spoilt.stages[size_t(stage)].parted > 0, stage == STAGE_add_emission)
                << stage_names[stage] << ": what parted is let go, and spoils no other stage";
    }
}

TEST(TraceComparison, DoublePrecisionStaysNear)
{
    SceneData scene = selftest_scenes()[1].scene;
    const TraceComparison exact = compare(make_backend("double", {}), scene, {});
    EXPECT_TRUE(exact.first);
    const TraceComparison near = compare(make_backend("double", {}), scene, {0, 1e-3});
    int parted = 0;
    for (const StageTally& tally : near.stages) parted += tally.parted;
    EXPECT_LE(parted, 10);
}

TEST(TraceComparison, CountsUnitsInTheLastPlace)
{
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ulps_between(1, 1), 0);
    EXPECT_EQ(ulps_between(1, std::nextafterf(1.0f, 2.0f)), 1);
    EXPECT_EQ(ulps_between(-1, std::nextafterf(-1.0f, 2.0f)), 1);
    EXPECT_EQ(ulps_between(0.0, -0.0), 0);
    EXPECT_EQ(ulps_between(1e-40, 0), 0) << "denormals count as zero";
    EXPECT_EQ(ulps_between(std::numeric_limits<float>::min(), 0), 1);
    EXPECT_EQ(ulps_between(std::numeric_limits<float>::min(), -std::numeric_limits<float>::min()),
              2);
    EXPECT_EQ(ulps_between(std::numeric_limits<float>::max(), infinity), 1);
    EXPECT_EQ(ulps_between(std::nan(""), std::nan("")), 0);
    EXPECT_EQ(ulps_between(std::nan(""), 1), infinity);
}

TEST(TraceComparison, ReadsBounds)
{
    EXPECT_EQ(parse_bound("4ulp").ulps, 4);
    EXPECT_EQ(parse_bound("4ulp").relative, 0);
    EXPECT_EQ(parse_bound("1e-3").relative, 1e-3);
    for (const char* text : {"", "ulp", "-1", "nan", "3 ulp", "1e99", "0.1x"})
        EXPECT_THROW(parse_bound(text), std::runtime_error) << text;
}

TEST(TraceComparison, FindsTheResultOfAPath)
{
    const WorkItem items[2] = {};
    const Dispatch blocks{items, 4};
    EXPECT_EQ(result_of_path(blocks, 0), 0);
    EXPECT_EQ(result_of_path(blocks, 256), 0);
    EXPECT_EQ(result_of_path(blocks, 1023), 255);
    EXPECT_EQ(result_of_path(blocks, 1024 + 256 + 7), 256 + 7);
    const Dispatch pixels{items, 4, 0};
    EXPECT_EQ(result_of_path(pixels, 3), 0);
    EXPECT_EQ(result_of_path(pixels, 4), 1);
}

}  // namespace
