// What textures may reach, and what a new one costs: claims TX-2 and TX-14 of the paper.
#include "backends/textures/native_stage.hpp"
#include "backends/textures/subprocess.hpp"
#include "backends/textures/texture_source.hpp"
#include "common/as_cpp/texture_rows.hpp"
#include "host/commands/trace_comparison.hpp"
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <unistd.h>

namespace {

using namespace diptych;
namespace fs = std::filesystem;

TextureInput numbers(std::vector<double> values) { return {.numbers = std::move(values)}; }

// A texture that gives its one argument.
TextureFunction given()
{
    return textures::handwritten("t0", {{"value", "float4"}}, "    return value;");
}

// The text of one that gives the same everywhere.
std::string level(const std::string& value)
{
    return "    return TX_NEW(float4, " + value + ", " + value + ", " + value + ", 1.0f);";
}

// A glossy corner under a lamp and a sky; what `paint` says of its material.
SceneData corner(SceneBuilder& scene, const MaterialInput& paint)
{
    const int painted = scene.add_material(paint);
    const int lamp = scene.add_material({.emission = {8, 7, 6}});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, painted)));
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -1}, {4, 0, 0}, {0, 2, 0}, painted)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 2, 0}, {1, 0, 0}, {0, 0, 1}, lamp)));
    scene.set_environment(laws::environment_of([](const Vec3& d) { return 1 + 0.5 * d[1]; }));
    scene.set_camera({.eye = {0.5, 1.2, 3}, .target = {0, 0.6, 0}});
    scene.set_picture_size(16, 16);
    return laws::finish(scene, 4);
}

// A backend whose traces pass over the stages of textures.
class WithoutTextureStages final : public Backend {
public:
    explicit WithoutTextureStages(Backend& inner) : inner_(inner) {}

    std::string description() const override { return inner_.description(); }
    Plan plan(const SceneData& scene) const override { return inner_.plan(scene); }
    void upload(SceneData& scene) override { inner_.upload(scene); }
    void update_materials(const SceneData& scene) override { inner_.update_materials(scene); }
    void update_textures(const SceneData& scene) override { inner_.update_textures(scene); }
    void render(const Dispatch& dispatch, Results& results) override
    {
        inner_.render(dispatch, results);
    }
    void trace(const Dispatch& dispatch,
               const std::function<void(const StageState&)>& after_stage) override
    {
        inner_.trace(dispatch, [&](const StageState& state) {
            if (texture_row_of(state.stage) < 0) after_stage(state);
        });
    }
    Statistics statistics() const override { return inner_.statistics(); }

private:
    Backend& inner_;
};

class TextureClaims : public laws::OnEachBackend {};

// Users say what a surface is like, and nothing else: told the same by a texture and by the
// material's own factors, every other stage (directions and densities of the BSDF, lights, rays)
// has the same bits.
TEST_P(TextureClaims, TX_2_OnlyWhatASurfaceIsLikeIsProgrammable)
{
    SceneBuilder plain_builder, textured_builder;
    SceneData plain =
        corner(plain_builder,
               {.base_color = {0.75f, 0.5f, 0.25f, 1}, .metallic = 0.5f, .roughness = 0.375f});
    const int function = textured_builder.add_texture_function(given());
    TextureUse color, gloss;
    color.node = textured_builder.add_texture_node(
        {"color", function, {{"value", numbers({0.75, 0.5, 0.25, 1})}}});
    gloss.node = textured_builder.add_texture_node(
        {"gloss", function, {{"value", numbers({0, 0.375, 0.5, 1})}}});
    SceneData textured = corner(textured_builder, {.metallic = 1,
                                                   .roughness = 1,
                                                   .base_texture = color,
                                                   .metallic_roughness_texture = gloss});
    ASSERT_EQ(textured.effects & ~plain.effects, unsigned(EFFECT_PROCEDURAL));

    const std::unique_ptr<Backend> other = make_backend(GetParam(), {});
    backend_->upload(plain);
    other->upload(textured);
    WithoutTextureStages shown(*other);
    const std::vector<WorkItem> items{{0, 0, 0, 0}};
    const Dispatch dispatch{items, 8};
    const TraceComparison result =
        compare_traces(*backend_, shown, plain.effects, dispatch, Bound{});
    EXPECT_GT(result.stages[STAGE_sample_bsdf].values, 10000);
    EXPECT_GT(result.stages[STAGE_sample_light].values, 10000);
    if (result.first)
        ADD_FAILURE() << "parted in " << stage_names[result.first->stage] << ", bounce "
                      << result.first->bounce << ", " << result.first->buffer << ": "
                      << result.first->a << " and " << result.first->b;
}

// A variable of the environment, as long as this lives.
class OwnVariable {
public:
    OwnVariable(const char* name, const std::string& value) : name_(name)
    {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    ~OwnVariable() { before_.empty() ? unsetenv(name_) : setenv(name_, before_.c_str(), 1); }
    OwnVariable(const OwnVariable&) = delete;
    OwnVariable& operator=(const OwnVariable&) = delete;

private:
    const char* name_;
    std::string before_;
};

// A cache folder of the test's own: what is compiled leaves a file or a folder there.
class OwnCache {
public:
    OwnCache() { fs::remove_all(folder_); }
    ~OwnCache()
    {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    OwnCache(const OwnCache&) = delete;
    OwnCache& operator=(const OwnCache&) = delete;

    const fs::path& folder() const { return folder_; }
    // Programs of OpenCL and texture stages of the host, by name.
    std::set<std::string> compiled() const
    {
        std::set<std::string> names;
        for (const char* folder : {"", "textures"}) names.merge(entries(folder));
        names.erase("textures");
        return names;
    }
    std::set<std::string> entries(const fs::path& folder) const
    {
        std::set<std::string> names;
        if (fs::is_directory(folder_ / folder))
            for (const auto& entry : fs::directory_iterator(folder_ / folder))
                names.insert(entry.path().filename());
        return names;
    }

private:
    const fs::path folder_ =
        fs::temp_directory_path() / ("texture-claims-" + std::to_string(getpid()));
    const OwnVariable chosen_{"DIPTYCH_CACHE_DIR", folder_};
};

// The program that runs here was built before any of these texts: each new one is compiled when it
// is met, and once; and all else that a device runs stays as it was compiled for the first.
TEST_P(TextureClaims, TX_14_ANewTextCompilesTheTextureStageAlone)
{
    const OwnCache cache;
    backend_ = make_backend(GetParam(), {});
    const auto grey = [](const std::string& text) {
        SceneBuilder scene;
        TextureUse use;
        use.node = scene.add_texture_node(
            {"grey", scene.add_texture_function(textures::handwritten("t0", {}, text)), {}});
        const int m = scene.add_material({.specular = 0, .base_texture = use});
        scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, m)));
        scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
        laws::look(scene, {0, 0, 3}, {0, 0, 0}, 0.5);
        return laws::finish(scene);
    };
    SceneData scene = grey(level("0.25f"));
    EXPECT_TRUE(laws::obeys(laws::measure(*backend_, scene), 0.25));
    const size_t first = cache.compiled().size();
    EXPECT_GE(first, 1u);

    scene = grey(level("0.75f"));  // added: the scene is loaded anew
    unsigned long before = texture_compilations();
    EXPECT_TRUE(laws::obeys(laws::measure(*backend_, scene), 0.75));
    EXPECT_EQ(texture_compilations(), before + 1);
    EXPECT_EQ(cache.compiled().size(), first + 1);

    SceneData edited = grey(level("0.125f"));  // edited: the scene stays where it is
    before = texture_compilations();
    backend_->update_textures(edited);
    EXPECT_EQ(texture_compilations(), before + 1);
    EXPECT_EQ(cache.compiled().size(), first + 2);
    RenderOptions options;
    options.samples = 64;
    const std::array<float, 3> seen = render(*backend_, edited, options).film.radiance(8, 8);
    EXPECT_NEAR(seen[1], 0.125f, 0.005f);  // a pixel of 64 samples: four standard errors
}

// Compilers of what strangers wrote.
TEST(TextureCompilers, EndWhenTheyTakeTooLongOrTooMuch)
{
    const Finished endless = run_program_within(1, 1, {"sh", "-c", "while :; do :; done"});
    EXPECT_NE(endless.exit_code, 0);
    EXPECT_GT(endless.seconds, 0.9);
    EXPECT_LT(endless.seconds, 5);
    const Finished large =
        run_program_within(20, 1, {"sh", "-c", "head -c 3000000000 /dev/zero | tail -n 1"});
    EXPECT_NE(large.output, "") << "no word of memory that ran out";
    const Finished words = run_program_within(1, 1, {"echo", "$(id) '\"\\", "a;b"});
    EXPECT_EQ(words.output, "$(id) '\"\\ a;b\n");
    EXPECT_EQ(words.exit_code, 0);
}

// Once more with other names of lines is for compilers that named some.
TEST(TextureCompilers, RunOnceMoreOverAnEditedCopyForAMessageAlone)
{
    SceneBuilder scene;
    TextureUse use;
    use.node = scene.add_texture_node(
        {"grey", scene.add_texture_function(textures::handwritten("t0", {}, level("0.5f"))), {}});
    const SceneData data = corner(scene, {.base_texture = use});
    const auto said_and_runs = [&](const std::string& script) {
        const OwnCache cache;
        const fs::path runs = cache.folder() / "runs";
        const fs::path compiler = cache.folder() / "compiler";
        fs::create_directories(cache.folder());
        std::ofstream(compiler) << "#!/bin/sh\necho >> " << runs.string() << "\n" << script << "\n";
        fs::permissions(compiler, fs::perms::owner_all);
        const std::string code = cache.folder() / "code";
        cpp_textures(data, {.write = code});
        const OwnVariable chosen("DIPTYCH_CXX", compiler.string());
        std::string said;
        try {
            NativeStage(data, {.use_generated = code, .most_seconds = 1});
        } catch (const std::runtime_error& error) {
            said = error.what();
        }
        return std::pair(said, fs::exists(runs) ? fs::file_size(runs) : 0);
    };
    const auto [stopped, runs_until_stopped] = said_and_runs("while :; do :; done");
    EXPECT_NE(stopped.find("was stopped after 1 s over"), std::string::npos) << stopped;
    EXPECT_EQ(runs_until_stopped, 1u);
    const auto [silent, runs_of_silent] = said_and_runs("exit 1");
    EXPECT_NE(silent.find("without a message"), std::string::npos) << silent;
    EXPECT_EQ(runs_of_silent, 1u);
    const auto [refused, runs_until_refused] = said_and_runs("echo here: error; exit 1");
    EXPECT_NE(refused.find("here: error"), std::string::npos) << refused;
    EXPECT_EQ(runs_until_refused, 2u);
}

// In lanes each function is a loop of its own, in two forms: an edit leaves those of others alone.
TEST(TextureObjects, AnEditCompilesTheLoopsOfItsFunctionAlone)
{
    const OwnCache cache;
    const auto two = [](const std::string& second) {
        SceneBuilder scene;
        TextureUse color, gloss;
        color.node = scene.add_texture_node(
            {"color",
             scene.add_texture_function(textures::handwritten("t0", {}, level("0.5f"))),
             {}});
        gloss.node = scene.add_texture_node(
            {"gloss",
             scene.add_texture_function(textures::handwritten("t1", {}, level(second))),
             {}});
        return corner(scene, {.base_texture = color, .metallic_roughness_texture = gloss});
    };
    const auto objects = [&] { return cache.entries(fs::path("textures") / "objects").size(); };
    const std::unique_ptr<Backend> backend = make_backend("cpu", {});
    SceneData scene = two("0.75f");
    backend->upload(scene);
    EXPECT_EQ(objects(), 5u);
    SceneData edited = two("0.25f");
    backend->update_textures(edited);
    EXPECT_EQ(objects(), 7u);

    const std::unique_ptr<Backend> scalar = make_backend("twin", {});
    scalar->upload(edited);
    RenderOptions options;
    options.samples = 4;
    EXPECT_EQ(image::beauty_of(render(*backend, edited, options).film.picture()).pixels,
              image::beauty_of(render(*scalar, edited, options).film.picture()).pixels);
}

ON_EACH_BACKEND(TextureClaims);

}  // namespace
