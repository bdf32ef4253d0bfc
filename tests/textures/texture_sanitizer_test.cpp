// Where the host runs under the address sanitizer, so does what it compiles at run time: what the
// texture tool lets through is trusted nowhere.
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

// Renders a square whose texture reads an element of an array of four with no bounds checked.
void read_element(const std::string& backend_name, int index)
{
    SceneBuilder scene;
    TextureUse use;
    const std::string body = "    const float own[4] = {value.x, value.y, value.z, value.w};\n"
                             "    const float read = own[(int)value.x];\n"
                             "    return TX_NEW(float4, read, read, read, 1.0f);";
    use.node = scene.add_texture_node(
        {"reads",
         scene.add_texture_function(textures::handwritten("t0", {{"value", "float4"}}, body)),
         {{"value", {.numbers = {double(index), 0, 0, 0}}}}});
    const int m = scene.add_material({.specular = 0, .base_texture = use});
    scene.place(scene.add_mesh(quad_mesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, m)));
    scene.set_environment(laws::environment_of([](const Vec3&) { return 1.0; }));
    laws::look(scene, {0, 0, 3}, {0, 0, 0}, 0.5);
    SceneData data = laws::finish(scene);
    const std::unique_ptr<Backend> backend = make_backend(backend_name, {});
    backend->upload(data);
    RenderOptions options;
    options.samples = 1;
    render(*backend, data, options);
}

class TextureSanitizer : public testing::TestWithParam<std::string> {};

TEST_P(TextureSanitizer, WatchesCodeThatIsCompiledAtRunTime)
{
    if (!is_watched) GTEST_SKIP() << "not a build with the address sanitizer";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    read_element(GetParam(), 3);
    EXPECT_DEATH(read_element(GetParam(), 4), "stack-buffer-overflow");
}

INSTANTIATE_TEST_SUITE_P(Backends, TextureSanitizer, testing::Values("cpu", "twin", "double"),
                         [](const auto& info) { return info.param; });

}  // namespace
