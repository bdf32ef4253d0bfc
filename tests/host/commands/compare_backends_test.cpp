// Two renders by the same samples: judged as pictures, and traced where they part.
#include "host/commands/compare_backends.hpp"

#include "backends/cpu_backend.hpp"
#include "host/commands/selftest_scenes.hpp"
#include "tests/host/commands/faulty_kernels.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <stdexcept>

using namespace diptych;

namespace {

constexpr int samples = 4;

CompareBackendsCommand small_command(const std::string& backends)
{
    CompareBackendsCommand command;
    command.compare.backends = backends;
    command.scene.size = "32x32";
    command.scene.samples = samples;
    command.is_quiet = true;
    return command;
}

TEST(CompareBackends, NamesStageBouncePixelAndValuesOfAPlantedFault)
{
    SceneData scene = selftest_scenes()[0].scene;
    const auto right = make_backend("twin", {});
    const auto wrong = make_cpu_backend(kernels_faulty::set, {});
    right->upload(scene);
    wrong->upload(scene);
    RenderOptions options;
    options.samples = samples;
    const image::Picture a = render(*right, scene, options).film.picture();
    const image::Picture b = render(*wrong, scene, options).film.picture();
    const std::vector<Pixel> pixels = differing_pixels(a, b, {});
    ASSERT_GT(pixels.size(), 100u);
    const auto found = find_divergence(*right, *wrong, scene, samples, pixels, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->divergence.stage, STAGE_add_emission);
    EXPECT_STREQ(found->divergence.buffer, "radiance");
    EXPECT_NE(found->divergence.a, found->divergence.b);
    const auto is_named = [&](const Pixel& p) { return p.x == found->x && p.y == found->y; };
    EXPECT_TRUE(std::any_of(pixels.begin(), pixels.begin() + 16, is_named));
    EXPECT_LT(found->sample, samples);

    // nothing to find among right ones
    EXPECT_TRUE(differing_pixels(a, a, {}).empty());
    EXPECT_FALSE(find_divergence(*right, *right, scene, samples, pixels, {}));
    // a bound wider than the fault forgives it
    EXPECT_FALSE(find_divergence(*right, *wrong, scene, samples, {pixels[0]}, {0, 2}));
}

TEST(CompareBackends, TellsInJson)
{
    CompareBackendsCommand command = small_command("twin,double");
    command.compare.json = true;
    command.bound = "0ulp";
    std::ostringstream out;
    EXPECT_EQ(run_compare_backends(command, out), 1) << "no float is as exact as a double";
    const nlohmann::json report = nlohmann::json::parse(out.str());
    EXPECT_EQ(report["reference"], "twin");
    EXPECT_EQ(report["test"], "double");
    EXPECT_GT(report["differing_pixels"], 100);
    EXPECT_EQ(report["divergence"]["stage"], "generate_paths");
    EXPECT_EQ(report["divergence"]["values"].size(), 2u);
    EXPECT_TRUE(report["flip"].contains("mean"));
    EXPECT_FALSE(report["within"]);
}

TEST(CompareBackends, JudgesByDefaultWhatCanBeExpected)
{
    for (const char* pair : {"cpu,twin", "twin,twin", "cpu,double"}) {
        std::ostringstream out;
        EXPECT_EQ(run_compare_backends(small_command(pair), out), 0) << pair << "\n" << out.str();
    }
}

TEST(CompareBackends, ObeysGivenLimits)
{
    CompareBackendsCommand command = small_command("cpu,double");
    command.compare.metrics = {"rmse"};
    command.compare.limits = {1e-12};
    std::ostringstream out;
    EXPECT_EQ(run_compare_backends(command, out), 1);
    EXPECT_NE(out.str().find("ABOVE"), std::string::npos) << out.str();
    command.compare.limits = {1};
    EXPECT_EQ(run_compare_backends(command, out), 0);
}

TEST(CompareBackends, RefusesWhatItCannotCompare)
{
    std::ostringstream out;
    for (const char* names : {"cpu", "cpu,", ",cpu", "cpu,twin,double", "cpu,nonsense"})
        EXPECT_THROW(run_compare_backends(small_command(names), out), std::runtime_error) << names;
    CompareBackendsCommand command = small_command("cpu,twin");
    command.compare.test = "second.exr";
    EXPECT_THROW(run_compare_backends(command, out), std::runtime_error);
}

}  // namespace
