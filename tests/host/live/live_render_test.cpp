// Edits of a scene that is being rendered: each picture has the bits of a fresh render of what the
// files then say, and no more is done for it than it takes.
#include "host/live/live_render.hpp"

#include "backends/textures/native_stage.hpp"
#include "host/commands/scene_flags.hpp"
#include "tests/debugger/textured_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <deque>
#include <fmt/format.h>

using namespace diptych;

namespace {

namespace fs = std::filesystem;

constexpr int samples = 4;

// A PNG of one texel.
constexpr const char* image_uri =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5E"
    "rkJggg==";

class LiveScenes : public testing::TestWithParam<std::string> {
protected:
    LiveScenes()
    {
        setenv("DIPTYCH_CACHE_DIR", (folder_ / "cache").c_str(), 1);
        write_painted_scene(folder_);
        try {
            make_backend(GetParam(), {});
        } catch (const std::runtime_error& error) {
            why_not_ = error.what();
        }
    }
    ~LiveScenes() override { unsetenv("DIPTYCH_CACHE_DIR"); }
    void SetUp() override
    {
        if (!why_not_.empty()) GTEST_SKIP() << why_not_;
    }

    SceneData load(const std::vector<std::string>& values,
                   const std::vector<std::string>& typed = {}) const
    {
        SceneFlags flags;
        flags.scene = folder_ / "scene.gltf";
        flags.size = "24x12";
        flags.eye = "1,0.5,2", flags.target = "1,0.5,0";
        flags.samples = samples;
        flags.load.texture_values = values;
        flags.load.typed_values = typed;
        return load_from_flags(flags);
    }

    // Pixels of a render that knows nothing of edits.
    std::vector<float> fresh(const std::vector<std::string>& values = {}) const
    {
        SceneData scene = load(values);
        const std::unique_ptr<Backend> backend = make_backend(GetParam(), {});
        backend->upload(scene);
        RenderOptions options;
        options.samples = samples;
        return image::beauty_of(render(*backend, scene, options).film.picture()).pixels;
    }

    // Each step is taken when the picture of the one before is complete, or its error told; the
    // last one's outcome ends the render.
    struct Step {
        std::vector<std::string> saved{}, typed{};
        std::function<void()> before = [] {};
    };
    void run(std::deque<Step> steps)
    {
        steps.push_front({});  // the first picture
        bool is_due = true;
        const auto due = [&] { is_due = true; };
        LiveHooks hooks;
        hooks.watch_files = [&](const auto& files, auto) { watched_ = files; };
        hooks.show = [&](const image::Picture& picture, const LiveScene&, const Backend&,
                         const RenderResult* end) {
            if (!end) return;
            pictures_.push_back(image::beauty_of(picture).pixels);
            compilations_.push_back(texture_compilations());
            due();
        };
        hooks.notices = [](const SceneData&) { return std::vector<std::string>(); };
        hooks.tell = [&](const std::string& line) { told_.push_back(line); };
        hooks.warn = [&](const std::string& line) {
            warned_.push_back(line);
            due();
        };
        hooks.requests = [&](double wait_seconds) {
            Requests requests;
            requests.since = std::chrono::steady_clock::now();
            if (wait_seconds == 0 || !is_due) return requests;
            is_due = false;
            steps.pop_front();
            if (steps.empty()) {
                requests.is_over = true;
                return requests;
            }
            steps.front().before();
            for (const std::string& name : steps.front().saved)
                requests.changed.emplace_back(folder_ / name);
            requests.values = steps.front().typed;
            return requests;
        };
        LiveScene scene(folder_ / "scene.gltf", {}, {},
                        [&](const std::vector<std::string>& typed) { return load({}, typed); });
        RenderOptions aims;
        aims.samples = samples;
        LiveRender live(
            scene, [] { return make_backend(GetParam(), {}); }, hooks, aims);
        live.run();
    }

    void edit_texture(const std::string& from, const std::string& to) const
    {
        std::string text = painted_source;
        const size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        folder_.write("paint.c", text.replace(at, from.size(), to));
    }
    void edit_scene(const std::function<void(nlohmann::json&)>& change) const
    {
        std::ifstream in(folder_ / "scene.gltf");
        nlohmann::json document = nlohmann::json::parse(in);
        change(document);
        folder_.write("scene.gltf", document.dump(1));
    }
    static nlohmann::json& node(nlohmann::json& document, size_t k)
    {
        return document["extensions"]["DIPTYCH_procedural_texture"]["nodes"][k];
    }

    TestFolder folder_;
    std::string why_not_;
    std::vector<fs::path> watched_;
    std::vector<std::vector<float>> pictures_;  // complete ones
    std::vector<unsigned long> compilations_;   // when each was complete
    std::vector<std::string> told_, warned_;
};

TEST_P(LiveScenes, TX_3_AnArgumentIsBytesAlone)
{
    const auto save = [&] {
        edit_scene([](auto& document) { node(document, 1)["arguments"]["tint"] = {1, 0.1, 0.2}; });
    };
    run({{.typed = {"paint.scale=3.5"}}, {.saved = {"scene.gltf"}, .before = save}});
    ASSERT_EQ(pictures_.size(), 3u) << testing::PrintToString(warned_);
    EXPECT_EQ(compilations_[1], compilations_[0]);
    EXPECT_EQ(compilations_[2], compilations_[0]);
    EXPECT_NE(pictures_[1], pictures_[0]);
    EXPECT_NE(pictures_[2], pictures_[1]);
    EXPECT_EQ(pictures_[2], fresh({"paint.scale=3.5"}));  // with the tint that the file has now
    EXPECT_EQ(told_[0].find("paint.scale=3.5: nothing to compile; first new sample after"), 0u)
        << told_[0];
    EXPECT_EQ(told_[1].find("paint.tint=[1,0.1,0.2]: nothing to compile"), 0u) << told_[1];
}

TEST_P(LiveScenes, AnotherTextIsOneCompilation)
{
    run({{.saved = {"paint.c"}, .before = [&] { edit_texture("wave * wave, p.y", "wave, p.x"); }},
         {.saved = {"paint.c"}, .before = [&] { folder_.write("paint.c", painted_source); }}});
    ASSERT_EQ(pictures_.size(), 3u) << testing::PrintToString(warned_);
    EXPECT_EQ(compilations_[1], compilations_[0] + 1);
    EXPECT_EQ(compilations_[2], compilations_[1]) << "the first text was compiled before";
    EXPECT_NE(pictures_[1], pictures_[0]);
    EXPECT_EQ(pictures_[2], pictures_[0]);
    EXPECT_EQ(told_[0].find("paint.c: texture stage made anew"), 0u) << told_[0];
}

TEST_P(LiveScenes, AFailedEditKeepsThePictureUntilAGoodOne)
{
    const auto break_scene = [&] {
        folder_.write("scene.gltf", "{\"asset\": {\n \"version\" \"\"}");
    };
    std::string scene_text;
    const auto mend_scene = [&] { folder_.write("scene.gltf", scene_text); };
    {
        std::ifstream in(folder_ / "scene.gltf", std::ios::binary);
        scene_text = {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    const std::string wrong = std::to_string(line_of(painted_source, "stripes(place"));
    run({{.saved = {"paint.c"}, .before = [&] { edit_texture("stripes(place", "stripe(place"); }},
         {.typed = {"paint.scale=5"}},
         {.saved = {"paint.c"}, .before = [&] { edit_texture("wave * wave, p.y", "wave, p.x"); }},
         {.saved = {"scene.gltf"}, .before = break_scene},
         {.typed = {"paint.scale=[1, 2]"}},
         {.typed = {"nothing.scale=1"}},
         {.typed = {"paint.scale="}},
         {.saved = {"scene.gltf"}, .before = [&] {
              mend_scene();
              edit_scene([](auto& d) { node(d, 1)["arguments"]["tint"] = {1, 0.5, 0.25}; });
          }}});
    ASSERT_EQ(warned_.size(), 5u) << testing::PrintToString(warned_);
    EXPECT_NE(warned_[0].find("paint.c:" + wrong + ":"), std::string::npos) << warned_[0];
    EXPECT_NE(warned_[0].find(": error: "), std::string::npos) << warned_[0];
    EXPECT_NE(warned_[1].find("scene.gltf:2:"), std::string::npos) << warned_[1];
    EXPECT_NE(warned_[2].find("argument scale is of type float, but has 2"), std::string::npos);
    EXPECT_EQ(warned_[3], "nothing.scale=1: \"nothing\" names no texture node; there are 2: left, "
                          "paint; name one of these");
    EXPECT_NE(warned_[4].find("not JSON"), std::string::npos) << warned_[4];
    ASSERT_EQ(pictures_.size(), 4u);
    EXPECT_NE(pictures_[1], pictures_[0]);  // the value was taken beside the broken text
    EXPECT_NE(pictures_[2], pictures_[1]);
    EXPECT_EQ(pictures_[3], fresh({"paint.scale=5"}));
}

TEST_P(LiveScenes, MoreThanArgumentsLoadsTheSceneAgain)
{
    const auto move = [&] { edit_scene([](auto& d) { d["nodes"][1]["scale"] = {0.5, 0.5, 1}; }); };
    const auto widen = [&] {
        edit_texture("float4 userProc(float scale, float3 tint)",
                     "// dim (float; default 0.5): of all\n"
                     "float4 userProc(float scale, float3 tint, float dim)");
    };
    run({{.saved = {"scene.gltf"}, .before = move},
         {.saved = {"paint.c"}, .before = widen},
         {.typed = {"paint.scale={\"node\": \"left\"}"}}});
    ASSERT_EQ(pictures_.size(), 4u) << testing::PrintToString(warned_);
    EXPECT_NE(pictures_[1], pictures_[0]);
    EXPECT_EQ(pictures_[3], fresh({"paint.scale={\"node\": \"left\"}"}));
    EXPECT_NE(told_[0].find("scene.gltf: more than arguments changed"), std::string::npos);
    bool is_told = false;
    for (const std::string& line : told_)
        is_told |= line.find("takes or asks for other things") != std::string::npos;
    EXPECT_TRUE(is_told) << testing::PrintToString(told_);
    const std::vector<fs::path> files = {folder_ / "paint.c", folder_ / "scene.gltf"};
    EXPECT_EQ(watched_, files);
}

// An edit is refused for want of a value; what is typed counts for the file as it is saved.
TEST_P(LiveScenes, ArgumentsThatAnEditDeclaresCanBeTyped)
{
    const auto widen = [&] {
        edit_texture("float3 tint)\n{\n    float3 place",
                     "float3 tint, float dim)\n{\n    tint = dim * tint;\n    float3 place");
    };
    const std::string refused = folder_ / "scene.gltf" +
                                ": texture node {}: its argument float dim is missing; give it a "
                                "value: --set {}.dim=JSON, in the scene, or as a default in the "
                                "file's comment";
    run({{.saved = {"paint.c"}, .before = widen},
         {.typed = {"paint.din=2"}},
         {.typed = {"left.dim=2"}},
         {.typed = {"paint.scale=5"}},
         {.typed = {"paint.dim=[3, 4]"}},
         {.typed = {"paint.dim=0.25"}},
         {.typed = {"paint.dim=0.75"}}});
    ASSERT_EQ(warned_.size(), 4u) << testing::PrintToString(warned_);
    EXPECT_EQ(warned_[0], fmt::format(fmt::runtime(refused), "left", "left"));
    EXPECT_EQ(warned_[1], "texture node paint: userProc has no argument din; it takes: float "
                          "scale, float3 tint, float dim");
    EXPECT_EQ(warned_[2], fmt::format(fmt::runtime(refused), "paint", "paint"));
    EXPECT_EQ(warned_[3], "texture node paint: its argument dim is of type float, but has 2 "
                          "numbers; give it 1");
    ASSERT_EQ(pictures_.size(), 4u) << testing::PrintToString(told_);
    EXPECT_NE(pictures_[1], pictures_[0]);  // another scale, in the text of before
    const std::string waits = "left.dim=2 waits for a save that is taken";
    EXPECT_EQ(told_[0], waits);
    EXPECT_EQ(told_[2], waits);
    EXPECT_EQ(
        told_[3].find(
            "paint.c: userProc takes or asks for other things than before: the whole scene is "
            "loaded again; first new sample after"),
        0u)
        << told_[3];
    EXPECT_EQ(pictures_[2], fresh({"left.dim=2", "paint.scale=5", "paint.dim=0.25"}));
    EXPECT_EQ(told_[4].find("paint.dim=0.75: nothing to compile"), 0u) << told_[4];
    EXPECT_EQ(pictures_[3], fresh({"left.dim=2", "paint.scale=5", "paint.dim=0.75"}));
}

TEST_P(LiveScenes, AValueWaitsOnlyForAnEditThatDeclaresIt)
{
    const std::string link = "paint.scale={\"node\": \"left\"}";
    const auto widen = [&] { edit_texture("float3 tint)", "float3 tint, float dim)"); };
    run({{.saved = {"paint.c"}, .before = widen},
         {.typed = {"left.dim=2"}},
         {.saved = {"paint.c"}, .before = [&] { edit_texture("wave * wave, p.y", "wave, p.x"); }},
         {.typed = {link}}});
    EXPECT_EQ(warned_.size(), 2u) << testing::PrintToString(warned_);
    ASSERT_EQ(pictures_.size(), 3u) << testing::PrintToString(warned_);
    EXPECT_EQ(pictures_[2], fresh({link}));
    EXPECT_EQ(std::ranges::count(told_, "notice: left.dim=2: no texture takes it now; dropped"), 1);
}

// Saves that are refused leave what waits, be it for other values or for a text that compiles.
TEST_P(LiveScenes, AWaitingValueOutlivesRefusedSaves)
{
    std::string wide = painted_source;
    wide.replace(wide.find("tint)"), 5, "tint, float dim)");
    wide.replace(wide.find("stripe * tint"), 13, "stripe * tint * dim");
    std::string broken = wide;
    broken.replace(broken.find("sin("), 4, "sine(");
    const auto save = [&](const std::string& text) {
        return Step{.saved = {"paint.c"},
                    .before = [this, text] { folder_.write("paint.c", text); }};
    };
    run({save(wide),
         {.typed = {"left.dim=2"}},
         save(broken),
         {.typed = {"paint.dim=0.25"}},
         {.typed = {"paint.din=3"}},
         save(broken + "\n"),
         save(wide),
         save(painted_source),
         save(wide)});
    const auto count = [&](const std::string& line) { return std::ranges::count(told_, line); };
    ASSERT_EQ(warned_.size(), 7u) << testing::PrintToString(warned_);
    EXPECT_NE(warned_[1].find("paint: its argument float dim is missing"), std::string::npos);
    for (const size_t k : {2, 3, 4, 5})
        EXPECT_NE(warned_[k].find("sine"), std::string::npos) << warned_[k];
    EXPECT_EQ(count("left.dim=2 waits for a save that is taken"), 5);
    EXPECT_EQ(count("paint.dim=0.25 waits for a save that is taken"), 3);
    EXPECT_EQ(count("paint.din=3 waits for a save that is taken"), 2);
    ASSERT_EQ(pictures_.size(), 3u) << testing::PrintToString(told_);
    EXPECT_EQ(count("notice: paint.din=3: no texture takes it now; dropped"), 1);
    folder_.write("paint.c", wide);
    EXPECT_EQ(pictures_[1], fresh({"left.dim=2", "paint.dim=0.25"}));
    EXPECT_NE(pictures_[1], pictures_[0]);
    // gone with the text that took them
    EXPECT_EQ(pictures_[2], pictures_[0]);
    for (const char* value : {"left.dim=2", "paint.dim=0.25"})
        EXPECT_EQ(count(std::string("notice: ") + value + ": no texture takes it now; dropped"), 1);
    EXPECT_NE(warned_[6].find("left: its argument float dim is missing"), std::string::npos);
}

// A default that is no JSON, images in place of it, and back.
TEST_P(LiveScenes, AnImageIsTypedAsItIsSet)
{
    std::string text = painted_source;
    const auto put = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    put("float4 userProc(", "// image (sam2D; default white): over all\n"
                            "float4 userProc(sam2D image, ");
    put("return to_float4(stripe", "stripe *= tex2D(image, make_float2(0.5f, 0.5f)).xyz;\n"
                                   "return to_float4(stripe");
    folder_.write("paint.c", text);
    edit_scene([](auto& d) {
        d["images"] = {{{"uri", image_uri}}};
        d["textures"] = {{{"source", 0}}};
    });
    run({{.typed = {"paint.scale=3"}},
         {.typed = {"paint.image={\"texture\": 0}"}},
         {.typed = {"paint.image=\"black\""}},
         {.typed = {"paint.image=\"white\""}}});
    EXPECT_EQ(warned_, std::vector<std::string>{
                           folder_ / "scene.gltf" +
                           ": texture node paint: argument image: must be numbers, an image as "
                           "{\"texture\": N} or \"white\", or a node"});
    ASSERT_EQ(pictures_.size(), 4u) << testing::PrintToString(told_);
    EXPECT_EQ(told_[0].find("paint.scale=3: nothing to compile"), 0u) << told_[0];
    EXPECT_EQ(pictures_[1], fresh({"paint.scale=3"}));
    EXPECT_NE(pictures_[2], pictures_[1]);
    EXPECT_EQ(pictures_[2], fresh({"paint.scale=3", "paint.image={\"texture\": 0}"}));
    EXPECT_EQ(pictures_[3], pictures_[1]);
}

// Two squares in a corner shine on each other: how light sampling divides itself between them
// follows what the texture gives.
TEST_P(LiveScenes, APaintedLightKeepsItsShareUpToDate)
{
    edit_scene([](auto& d) {
        d["materials"][0]["emissiveFactor"] = d["materials"][1]["emissiveFactor"] = {1, 1, 1};
        d["materials"][0]["extensions"]["DIPTYCH_procedural_texture"]["emissiveTexture"] = {
            {"node", "paint"}};
        d["nodes"][1]["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
        d["nodes"][1]["translation"] = {0, 0, 2};
    });
    run({{.typed = {"paint.tint=[9, 8, 7]"}},
         {.typed = {"left.scale=3"}},
         {.saved = {"paint.c"}, .before = [&] { edit_texture("wave * wave, p.y", "6.0f, p.x"); }}});
    ASSERT_EQ(pictures_.size(), 4u) << testing::PrintToString(warned_);
    EXPECT_NE(told_[0].find("paint.tint paints light"), std::string::npos) << told_[0];
    EXPECT_NE(told_[1].find("left.scale=3: nothing to compile"), std::string::npos) << told_[1];
    EXPECT_NE(told_[2].find("paint.c paints light"), std::string::npos) << told_[2];
    EXPECT_NE(pictures_[1], pictures_[0]);
    EXPECT_NE(pictures_[3], pictures_[2]);
    EXPECT_EQ(pictures_[3], fresh({"paint.tint=[9, 8, 7]", "left.scale=3"}));
}

INSTANTIATE_TEST_SUITE_P(Backends, LiveScenes, testing::Values("cpu", "twin", "double", "opencl"),
                         [](const auto& info) { return info.param; });

}  // namespace
