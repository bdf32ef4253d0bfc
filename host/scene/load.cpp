#include "host/scene/load.hpp"

#include "host/scene/environment.hpp"
#include "host/scene/gltf_loader.hpp"
#include "host/scene/model.hpp"
#include "host/scene/uri.hpp"

#include <fmt/format.h>
#include <new>

namespace diptych {
namespace {

Vec3 to_vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace

void apply_options(SceneBuilder& scene, const LoadOptions& options)
{
    scene.set_picture_size(options.width, options.height);
    scene.disable_effects(options.disabled_effects);
    if (options.has_view) {
        scene.set_camera({.eye = to_vec(options.eye),
                          .target = to_vec(options.target),
                          .up = to_vec(options.up),
                          .fov = options.fov});
    }
    if (options.environment == "none") {
        return;
    }
    if (!options.environment.empty()) {
        const std::filesystem::path file = options.environment;
        if (!std::filesystem::is_regular_file(file)) {
            throw SceneError(
                printable(options.environment) +
                (std::filesystem::exists(file) ? ": is not a file" : ": no such file") +
                "; name a latitude-longitude image for the environment");
        }
        scene.set_environment(
            read_picture(file, printable(options.environment), options.max_image_pixels),
            options.environment_rotation, options.environment_scale);
    } else if (!scene.has_lights()) {
        scene.set_environment(neutral_sky(), options.environment_rotation,
                              options.environment_scale);
        scene.notice("lights: none in the scene; a neutral sky lights it");
    }
}

namespace {

// Runs `read` on the document, and gives errors the name of its file.
template<typename Read>
void read_document(const std::filesystem::path& file, bool allow_outside, const Read& read)
{
    const auto fail = [&](const std::string& what) {
        throw SceneError(printable(file.string()) + ": " + what);
    };
    try {
        GltfDocument document(file, allow_outside);
        read(document);
    } catch (const SceneError& error) {
        fail(error.what());
    } catch (const std::bad_alloc&) {
        fail("memory: not enough for this scene; use a smaller one");
    } catch (const std::length_error&) {
        fail("memory: not enough for this scene; use a smaller one");
    } catch (const std::exception& error) {
        fail("document: " + printable(error.what()) + "; repair the file");
    }
}

}  // namespace

void load_into(SceneBuilder& scene, const std::filesystem::path& file, const LoadOptions& options)
{
    read_document(file, options.allow_outside, [&](GltfDocument& document) {
        for (const std::string& line : document.notices()) {
            scene.notice(line);
        }
        GltfLoader(document, options, scene).run();
    });
    apply_options(scene, options);
    scene.copy_small_meshes(options.copied_triangles);
}

std::vector<ModelPlacement> read_model(const std::filesystem::path& file)
{
    std::vector<ModelPlacement> model;
    read_document(file, false, [&](GltfDocument& document) {
        SceneBuilder unused;
        model = GltfLoader(document, {}, unused).run_for_model();
    });
    return model;
}

SceneData load_scene(const std::filesystem::path& file, const LoadOptions& options)
{
    SceneBuilder scene;
    load_into(scene, file, options);
    try {
        SceneData data = scene.finish();
        if (data.triangles.empty()) {
            data.notices.push_back("scene: it has no triangles; only its background is visible");
        }
        return data;
    } catch (const SceneError& error) {
        throw SceneError(printable(file.string()) + ": " + error.what());
    }
}

}  // namespace diptych
