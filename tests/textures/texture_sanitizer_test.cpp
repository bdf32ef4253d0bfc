// Where the host runs under the address and undefined-behaviour sanitizers, so does what it
// compiles at run time: what the texture tool lets through is trusted nowhere.
#include "backends/textures/texture_tool.hpp"
#include "host/render/render.hpp"
#include "tests/laws/measure.hpp"
#include "tests/textures/handwritten.hpp"

namespace {

using namespace diptych;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool is_watched = true;
#else
constexpr bool is_watched = false;
#endif

void render_on(const std::string& backend_name, SceneData& data)
{
    const std::unique_ptr<Backend> backend = make_backend(backend_name, {});
    backend->upload(data);
    RenderOptions options;
    options.samples = 1;
    render(*backend, data, options);
}

// A square in white light for each function, whose arguments are `number` and images.
SceneData squares(const std::vector<TextureFunction>& functions, double number)
{
    SceneBuilder scene;
    TextureUse image;
    image.image = scene.add_image(laws::environment_of([](const Vec3&) { return 0.5; }));
    for (size_t k = 0; k < functions.size(); ++k) {
        TextureNode node{"node" + std::to_string(k), scene.add_texture_function(functions[k])};
        for (const TextureArgument& argument : functions[k].arguments) {
            const size_t elements = argument.is_array ? 4 : 1;
            TextureInput& input = node.arguments[argument.name];
            if (argument.type == "sam2D")
                input.images.assign(elements, image);
            else
                input.numbers.assign(elements * size_t(width_of(argument)), number);
        }
        TextureUse use;
        use.node = scene.add_texture_node(node);
        const int m = scene.add_material({.specular = 0, .base_texture = use});
        scene.place(scene.add_mesh(quad_mesh({-1, -1, -0.1 * double(k)}, {2, 0, 0}, {0, 2, 0}, m)),
                    translation(0.5 * double(k), 0, 0));
    }
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0.75, 0, 3}, {0.75, 0, 0}, 1.75);
    return laws::finish(scene, 1);
}

// A texture of this body, which finds its argument in value.x.
void evaluate(const std::string& backend, const std::string& body, double number)
{
    const std::string result = "    return TX_NEW(float4, read, read, read, 1.0f);";
    SceneData data =
        squares({textures::handwritten("t0", {{"value", "float4"}}, body + result)}, number);
    render_on(backend, data);
}

class TextureSanitizer : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override
    {
        if (!is_watched) GTEST_SKIP() << "not a build with the address sanitizer";
        GTEST_FLAG_SET(death_test_style, "threadsafe");
    }
};

TEST_P(TextureSanitizer, SeesReadsBeyondTheScenesMemory)
{
    const std::string body = "    const float read = (float)(tx_word(tx, (int)value.x) & 1u);\n";
    const SceneData data = squares({textures::handwritten("t0", {{"value", "float4"}}, body)}, 0);
    const size_t words = data.materials.size() * sizeof(Material) / sizeof(uint);
    evaluate(GetParam(), body, double(words - 1));
    EXPECT_DEATH(evaluate(GetParam(), body, double(words)), "heap-buffer-overflow");
}

TEST_P(TextureSanitizer, SeesWhatTheLanguageLeavesOpen)
{
    const std::string body = "    const float own[4] = {value.x, value.y, value.z, value.w};\n"
                             "    const float read = own[(int)value.x];\n";
    evaluate(GetParam(), body, 3);
    EXPECT_DEATH(evaluate(GetParam(), body, 4), "index 4 out of bounds");
}

// Every form of the language, every defined result, and what a stranger may try.
TEST_P(TextureSanitizer, FindsNothingInWhatTheToolLetsThrough)
{
    std::vector<TextureFunction> functions;
    for (const std::string name : {"misbehaving", "forms", "defined_results", "everything"}) {
        const std::string file = DIPTYCH_SOURCE "/tests/texture_tool/textures/" + name + ".c";
        functions.push_back(translate_texture({file, file, "", "t_" + name}));
    }
    for (const double number : {3.0, 2e9}) {
        SceneData data = squares(functions, number);
        render_on(GetParam(), data);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, TextureSanitizer, testing::Values("cpu", "twin", "double"),
                         [](const auto& info) { return info.param; });

}  // namespace
