// The self-test passes what is right, and blames the right stage of what is not.
#include "host/commands/selftest_command.hpp"

#include "backends/cpu_backend.hpp"
#include "host/commands/selftest_scenes.hpp"
#include "tests/host/commands/faulty_kernels.hpp"

#include <gtest/gtest.h>

using namespace diptych;

namespace {

SelftestResult test_of(const std::string& name)
{
    return run_selftest(*make_backend(name, {}), *make_backend("twin", {}),
                        allowance_for(name, {}));
}

TEST(Selftest, ScenesTogetherCallForEveryEffect)
{
    unsigned effects = 0;
    for (const SelftestScene& scene : selftest_scenes()) effects |= scene.scene.effects;
    unsigned all = 0;
#define ADD_EFFECT(name, bit, words) all |= EFFECT_##name;
    EFFECTS_LIST(ADD_EFFECT)
#undef ADD_EFFECT
    EXPECT_EQ(effects, all);
}

TEST(Selftest, PassesTheProcessorsBackends)
{
    EXPECT_TRUE(test_of("twin").is_ok);
    EXPECT_TRUE(test_of("cpu").is_ok);
    EXPECT_TRUE(test_of("double").is_ok);
}

TEST(Selftest, HasARowForEveryStage)
{
    const SelftestResult result = test_of("cpu");
    // compact and accumulate are one; decide_alpha shows in the rays that it lets go on
    EXPECT_EQ(result.stages.size(), size_t(STAGE_COUNT) - 2);
    for (const StageVerdict& row : result.stages) EXPECT_GT(row.tally.values, 0) << row.stage;
}

TEST(Selftest, BlamesTheStageWithAPlantedFault)
{
    const SelftestResult result =
        run_selftest(*make_cpu_backend(kernels_faulty::set, {}), *make_backend("twin", {}), {});
    EXPECT_FALSE(result.is_ok);
    for (const StageVerdict& row : result.stages)
        EXPECT_EQ(row.is_ok, row.stage != "add_emission") << row.stage;
    ASSERT_FALSE(result.details.empty());
    EXPECT_NE(result.details[0].find("add_emission"), std::string::npos) << result.details[0];
    EXPECT_NE(result.details[0].find("radiance"), std::string::npos) << result.details[0];
}

}  // namespace
