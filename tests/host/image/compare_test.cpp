// The command: exit codes, JSON, heat map, manifest.
#include "host/image/compare_cli.hpp"
#include "host/image/image.hpp"
#include "tests/host/image/scratch_folder.hpp"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

using namespace diptych::image;
using nlohmann::json;

static Picture plain(int width, int height, float value)
{
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.layers.push_back(beauty_layer(std::vector<float>(size_t(width) * height * 4, value)));
    return picture;
}

struct Ran {
    int code;
    std::string out, err;
};

// The command as typed.
static Ran run(std::vector<std::string> arguments)
{
    CLI::App app;
    CompareOptions options;
    CLI::App* compare = add_compare_command(app, options);
    arguments.insert(arguments.begin(), "compare");
    std::reverse(arguments.begin(), arguments.end());
    app.parse(arguments);
    EXPECT_TRUE(*compare);
    std::ostringstream out, err;
    const int code = compare_command(options, out, err);
    return {code, out.str(), err.str()};
}

class Compare : public testing::Test {
protected:
    void SetUp() override
    {
        write_picture(a, plain(20, 10, 0.5f));
        write_picture(b, plain(20, 10, 0.6f));
    }
    ScratchFolder folder;
    std::string a = folder / "a.exr", b = folder / "b.exr";
};

TEST_F(Compare, ExitCodesFollowTheLimits)
{
    EXPECT_EQ(run({a, b}).code, 0);
    EXPECT_EQ(run({a, b, "--metric", "rmse", "--max", "0.11"}).code, 0);
    EXPECT_EQ(run({a, b, "--metric", "rmse", "--max", "0.09"}).code, 1);
    EXPECT_EQ(
        run({a, b, "--metric", "rmse", "--max", "0.11", "--metric", "flip", "--max", "0.0001"})
            .code,
        1);
    EXPECT_EQ(run({b, a, "--metric", "bias", "--max", "0.09"}).code, 1)
        << "a negative bias counts too";
    EXPECT_EQ(run({a, a, "--metric", "max", "--max", "0"}).code, 0);
}

TEST_F(Compare, ErrorsAreOneLineAndCodeTwo)
{
    write_picture(folder / "wide.exr", plain(21, 10, 0.5f));
    write_picture(folder / "display.png", plain(20, 10, 0.5f));
    const std::vector<std::vector<std::string>> wrong = {
        {a},
        {a, folder / "none.exr"},
        {a, folder / "wide.exr"},
        {a, folder / "display.png"},
        {a, b, "--metric", "beauty"},
        {a, b, "--metric", "rmse", "--metric", "max", "--max", "1"},
        {a, b, "--max", "1"},
        {a, b, "--metric", "rmse", "--max", "-1"},
        {a, b, "--ppd", "0"},
        {a, b, "--layer", "albedo"},
        {a, b, "-o", folder / "map.xyz"},
        {"--manifest", folder / "none.json"},
    };
    for (const auto& arguments : wrong) {
        const Ran ran = run(arguments);
        EXPECT_EQ(ran.code, 2) << ran.out;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        EXPECT_EQ(ran.err.rfind("diptych: ", 0), 0u) << ran.err;
    }
}

TEST_F(Compare, JsonHoldsEveryMetric)
{
    const Ran ran = run({a, b, "--json"});
    const json report = json::parse(ran.out);
    for (const char* metric : METRICS) EXPECT_TRUE(report.at(metric).is_number()) << metric;
    EXPECT_NEAR(report["rmse"].get<double>(), 0.1, 1e-6);
    EXPECT_NEAR(report["bias"].get<double>(), 0.1, 1e-6);
    EXPECT_EQ(report["flip.mean"], report["flip"]["mean"]);
    EXPECT_EQ(report["flip"]["kind"], "HDR");
    EXPECT_EQ(report["flip"]["exposures"].size(), 3u);
    EXPECT_EQ(report["within"], true);

    EXPECT_EQ(json::parse(run({"--json", a, b}).out)["rmse"], report["rmse"]) << "also in front";

    const Ran some = run({a, b, "--metric", "mean", "--max", "0.01", "--json", folder / "r.json"});
    EXPECT_EQ(some.code, 1);
    EXPECT_NE(some.out.find("ABOVE"), std::string::npos) << "text when the JSON goes to a file";
    const json written = json::parse(bytes_of(folder / "r.json"));
    EXPECT_FALSE(written.contains("flip.mean")) << "only what was asked for";
    EXPECT_EQ(written["limits"][0]["within"], false);
}

TEST_F(Compare, BiasGetsAnIntervalFromStandardErrorLayers)
{
    Picture picture = plain(20, 10, 0.6f);
    picture.layers.push_back(standard_error_layer(std::vector<float>(600, 0.05f)));
    write_picture(b, picture);
    const json report = json::parse(run({a, b, "--json"}).out);
    const double half = 1.959964 * 0.05 / std::sqrt(200.0);
    EXPECT_NEAR(report["bias_details"]["interval"][0].get<double>(), 0.1 - half, 1e-6);
    EXPECT_NEAR(report["bias_details"]["interval"][1].get<double>(), 0.1 + half, 1e-6);
    EXPECT_NE(run({a, b}).out.find("95 % interval"), std::string::npos);
}

// Half of the pixels are right, and said to be; of the others, half are said to be.
TEST_F(Compare, PredictionsAreHeldAgainstTheReference)
{
    Picture picture = plain(20, 10, 0.5f);
    std::vector<float> predicted(200, 0.9f);
    for (size_t pixel = 0; pixel < 100; ++pixel) {
        for (size_t c = 0; c < 3; ++c) picture.layers[0].pixels[4 * pixel + c] = 0.6f;
        if (pixel % 2 == 0) predicted[pixel] = 4;
    }
    EXPECT_EQ(run({a, b, "--metric", "jnd.broken"}).code, 2) << "nothing is predicted";
    picture.layers.push_back(predicted_error_layer(predicted));
    write_picture(b, picture);
    const json report = json::parse(run({a, b, "--json"}).out);
    // L* of 0.5 is 76.0693, of 0.6 81.8382; 2 of them are a JND
    EXPECT_NEAR(report["jnd.p95"].get<double>(), 2.88445, 1e-3);
    EXPECT_NEAR(report["jnd.rms"].get<double>(), 2.88445 / std::sqrt(2.0), 1e-3);
    EXPECT_NEAR(report["jnd.broken"].get<double>(), 1.0 / 3, 1e-9);
    EXPECT_NEAR(report["jnd.blocks"].get<double>(), 3.0 / 6, 1e-9) << "of 8 x 8 pixels";
    EXPECT_EQ(run({a, b, "--metric", "jnd.broken", "--max", "0.3"}).code, 1);
    EXPECT_EQ(run({a, b, "--metric", "jnd.rms", "--max", "0", "--exposure", "4"}).code, 0)
        << "both are white";
    const std::string filmic = run({a, b, "--metric", "jnd.rms", "--view", "filmic", "--json"}).out;
    EXPECT_NE(json::parse(filmic)["jnd.rms"], report["jnd.rms"]);
}

TEST_F(Compare, HeatMapIsMagma)
{
    EXPECT_EQ(run({a, a, "-o", folder / "map.png"}).code, 0);
    const Picture map = read_picture(folder / "map.png");
    EXPECT_EQ(map.width, 20);
    EXPECT_EQ(beauty_of(map).pixels[0], 0);
    EXPECT_NEAR(beauty_of(map).pixels[2], 4 / 255.0, 1e-6) << "magma begins at 0, 0, 4";
}

TEST_F(Compare, HelpSaysEverything)
{
    CLI::App app;
    CompareOptions options;
    const std::string help = add_compare_command(app, options)->help();
    for (const char* word :
         {"--metric", "--max", "--ppd", "--json", "--manifest", "--junit", "--layer", "--output",
          "--backends", "flip.mean", "Exit code", "heat_map"})
        EXPECT_NE(help.find(word), std::string::npos) << word;
    for (const char* metric : {"rmse", "relmse", "bias", "yee"})
        EXPECT_NE(help.find(metric), std::string::npos) << metric;
}

TEST_F(Compare, ManifestRunsAllAndWritesJunit)
{
    put_bytes(folder / "list.json", R"([
        {"name": "fine", "reference": "a.exr", "test": "b.exr", "limits": {"rmse": 0.2, "flip.mean": 1}, "heat_map": "m.png"},
        {"name": "far <&> off", "reference": "a.exr", "test": "b.exr", "limits": {"rmse": 0.01}, "ppd": 30}])");
    const Ran ran = run({"--manifest", folder / "list.json", "--junit", folder / "out.xml"});
    EXPECT_EQ(ran.code, 1);
    EXPECT_NE(ran.out.find("within  fine"), std::string::npos) << ran.out;
    const std::string xml = bytes_of(folder / "out.xml");
    EXPECT_NE(xml.find("tests=\"2\" failures=\"1\" errors=\"0\""), std::string::npos) << xml;
    EXPECT_NE(xml.find("name=\"far &lt;&amp;&gt; off\""), std::string::npos);
    EXPECT_NE(xml.find("<failure message=\"rmse is 0.1, above 0.01\"/>"), std::string::npos);
    EXPECT_EQ(read_picture(folder / "m.png").width, 20);

    put_bytes(folder / "list.json", R"([
        {"reference": "a.exr", "test": "none.exr", "limits": {"rmse": 1}},
        {"name": "fine", "reference": "a.exr", "test": "b.exr", "limits": {"rmse": 1}}])");
    const Ran missing = run({"--manifest", folder / "list.json"});
    EXPECT_EQ(missing.code, 2);
    EXPECT_NE(missing.out.find("errors=\"1\""), std::string::npos)
        << "the XML goes to standard output";
    EXPECT_NE(missing.out.find("name=\"fine\""), std::string::npos) << "the others still ran";
    EXPECT_EQ(std::count(missing.err.begin(), missing.err.end(), '\n'), 1);
}

TEST_F(Compare, ManifestMistakesAreNamed)
{
    for (const char* text :
         {"{", "{}", "[1]", R"([{"reference": 1}])", R"([{"tset": "b.exr"}])",
          R"([{"reference": "a.exr", "test": "b.exr", "limits": {"rmse": "x"}}])",
          R"([{"reference": "a.exr", "test": "b.exr", "limits": []}])"}) {
        put_bytes(folder / "list.json", text);
        const Ran ran = run({"--manifest", folder / "list.json"});
        EXPECT_EQ(ran.code, 2) << text;
        EXPECT_NE(ran.err.find("list.json"), std::string::npos) << ran.err;
    }
}
