// Textures that go wrong: their authors are told where, with what arguments, at which pixel; the
// counts are the same on every backend, whatever the threads.
#include "tests/textures/planted_scene.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>

using namespace diptych;
using nlohmann::json;

namespace {

struct Planted {
    const char* name;
    const char* source;
    json arguments;
    const char* kind;      // in the report
    int line;              // that is named
    const char* mentions;  // in the notice
};

const Planted plants[] = {
    {"one_over_zero",
     "// A pole.\nfloat3 planted(float by)\n{\n    return make_float3(1.0f / by, 0.5f, "
     "0.25f);\n}\n",
     {{"by", 0}},
     "not_finite",
     4,
     "planted(by = 0) gave (inf, 0.5, 0.25, 1)"},
    {"root_of_minus_one",
     "float4 planted(float2 of)\n{\n    return to_float4(make_float3(sqrt(of.x), of.y, 0), "
     "1.0f);\n}\n",
     {{"of", {-1, 3}}},
     "not_finite",
     3,
     "planted(of = (-1, 3)) gave ("},
    {"zero_over_zero_in_a_helper",
     "float ratio(float a, float b) { return a / b; }\n\nfloat planted(float a, float b)\n{\n"
     "    return ratio(a, b);\n}\n",
     {{"a", 0}, {"b", 0}},
     "not_finite",
     1,
     "a = 0, b = 0"},
    {"index_out_of_range",
     "float planted(int k, const float* table)\n{\n    return table[k] + table[1];\n}\n",
     {{"k", 7}, {"table", {0.25, 0.5, 0.125}}},
     "index",
     3,
     "planted(k = 7, table = (0.25, 0.5, 0.125)) gave (0.625, 0.625, 0.625, 1), 1 in this "
     "evaluation"},
    {"index_of_a_local_array",
     "float second(const float* of, int k)\n{\n    return of[k];\n}\n\n"
     "float planted(int k)\n{\n    float own[2] = {0.5f, 0.25f};\n"
     "    const float inside = own[1] + second(own, 0);\n    own[0] = inside;\n"
     "    own[k] = 0.125f;\n    return own[0] + own[1] + second(own, k);\n}\n",
     {{"k", -3}},
     "index",
     11,
     "planted.c:11: planted(k = -3) gave (0.5, 0.5, 0.5, 1), 2 in this evaluation"},
    {"endless_loop",
     "float planted(float keep)\n{\n    float x = 0.5f;\n\n    while (x < 2.0f) x *= keep;\n"
     "    return x;\n}\n",
     {{"keep", 1}},
     "budget",
     5,
     "planted.c:5: planted(keep = 1) gave (0.5, 0.5, 0.5, 1)"},
};

class PlantedFaults : public testing::TestWithParam<Planted> {
protected:
    void SetUp() override { write_planted_scene(folder_, GetParam().source, GetParam().arguments); }

    Outcome render(std::vector<std::string> more) const
    {
        std::vector<std::string> words = {
            "render", folder_ / "scene.gltf", "--samples", "2", "--json", "-", "-o", "out.exr"};
        words.insert(words.end(), planted_view.begin(), planted_view.end());
        words.insert(words.end(), more.begin(), more.end());
        return run_diptych(words, {.seconds = 200, .folder = folder_.path()});
    }

    TestFolder folder_;
};

TEST_P(PlantedFaults, AreNamedAndCountedAlikeOnEveryBackend)
{
    const Planted& planted = GetParam();
    json expected;
    for (const std::vector<std::string>& how :
         std::vector<std::vector<std::string>>{{"--backend", "twin"},
                                               {"--backend", "cpu"},
                                               {"--backend", "cpu", "--threads", "1"},
                                               {"--backend", "double"},
                                               {"--backend", "opencl"},
                                               {"--backend", "twin", "--debug-textures"}}) {
        const Outcome outcome = render(how);
        if (how[1] == "opencl" && outcome.exit_code == 2 &&
            outcome.err.find("no OpenCL") != std::string::npos)
            continue;
        ASSERT_EQ(outcome.exit_code, 0) << how[1] << outcome.text();
        EXPECT_NE(outcome.err.find(planted.mentions), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find("node planted"), std::string::npos) << outcome.err;
        json faults = json::parse(outcome.out).at("textures");
        EXPECT_EQ(json::parse(outcome.out).at("dropped_samples"), 0);
        for (auto& [kind, fault] : faults.items())
            EXPECT_EQ(fault.at("count").get<int>() > 0, kind == planted.kind) << kind;
        json& first = faults.at(planted.kind).at("first");
        EXPECT_EQ(first.at("line"), planted.line);
        EXPECT_LT(first.at("sample"), 2);
        EXPECT_EQ(first.at("bounce"), 0);
        first.erase("value");  // a NaN's sign is nobody's promise
        if (expected.is_null()) expected = faults;
        EXPECT_EQ(faults, expected) << how[1];
    }
    // every hit once, and no other path
    EXPECT_GT(expected.at(planted.kind).at("count"), 2 * 8);
    EXPECT_LT(expected.at(planted.kind).at("count"), 2 * 16 * 8);
}

TEST_P(PlantedFaults, StrictRefusesWhatIsNotFinite)
{
    const Outcome outcome = render({"--strict", "--quiet"});
    const bool is_refused = std::string(GetParam().kind) == "not_finite";
    EXPECT_EQ(outcome.exit_code, is_refused ? 2 : 0) << outcome.text();
    if (is_refused) {
        EXPECT_EQ(outcome.err_lines().size(), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find("--strict"), std::string::npos) << outcome.err;
    }
}

INSTANTIATE_TEST_SUITE_P(Textures, PlantedFaults, testing::ValuesIn(plants),
                         [](const auto& info) { return info.param.name; });

}  // namespace
