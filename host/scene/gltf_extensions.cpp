#include "host/scene/gltf_extensions.hpp"

#include "host/scene/scene_error.hpp"
#include "host/scene/uri.hpp"

#include <algorithm>
#include <set>

namespace diptych {
namespace {

struct Extension {
    const char* name;
    ExtensionSupport support;
};

constexpr Extension extensions[] = {
    {"KHR_texture_transform", ExtensionSupport::simulated},
    {"KHR_mesh_quantization", ExtensionSupport::simulated},
    {"KHR_materials_unlit", ExtensionSupport::simulated},
    {"KHR_materials_emissive_strength", ExtensionSupport::simulated},
    {"KHR_materials_specular", ExtensionSupport::simulated},
    {"KHR_materials_ior", ExtensionSupport::simulated},
    {"KHR_lights_punctual", ExtensionSupport::simulated},
    {"EXT_mesh_gpu_instancing", ExtensionSupport::simulated},
    {"EXT_texture_webp", ExtensionSupport::simulated},
    {"DIPTYCH_procedural_texture", ExtensionSupport::simulated},
    {"KHR_materials_variants", ExtensionSupport::ignored},
    {"KHR_xmp", ExtensionSupport::ignored},
    {"KHR_xmp_json_ld", ExtensionSupport::ignored},
    {"KHR_animation_pointer", ExtensionSupport::ignored},
    {"KHR_materials_transmission", ExtensionSupport::not_simulated},
    {"KHR_materials_diffuse_transmission", ExtensionSupport::not_simulated},
    {"KHR_materials_volume", ExtensionSupport::not_simulated},
    {"KHR_materials_clearcoat", ExtensionSupport::not_simulated},
    {"KHR_materials_sheen", ExtensionSupport::not_simulated},
    {"KHR_materials_iridescence", ExtensionSupport::not_simulated},
    {"KHR_materials_anisotropy", ExtensionSupport::not_simulated},
    {"KHR_materials_dispersion", ExtensionSupport::not_simulated},
};

}  // namespace

ExtensionSupport extension_support(const std::string& name)
{
    const auto at =
        std::ranges::find_if(extensions, [&](const Extension& e) { return name == e.name; });
    return at == std::end(extensions) ? ExtensionSupport::unknown : at->support;
}

std::vector<std::string> check_extensions(const std::vector<std::string>& used,
                                          const std::vector<std::string>& required)
{
    for (const std::string& name : required) {
        if (extension_support(name) == ExtensionSupport::unknown) {
            throw SceneError("extensionsRequired: " + printable(name) +
                             " is not supported; export the scene without it");
        }
    }
    std::vector<std::string> notices;
    for (const std::string& name : std::set<std::string>(used.begin(), used.end())) {
        switch (extension_support(name)) {
        case ExtensionSupport::simulated:
            break;
        case ExtensionSupport::ignored:
            notices.push_back("extension " + name + ": has no effect here");
            break;
        case ExtensionSupport::not_simulated:
            notices.push_back("extension " + name +
                              ": not simulated yet; materials are rendered without it");
            break;
        case ExtensionSupport::unknown:
            notices.push_back("extension " + printable(name) + ": unknown, ignored");
            break;
        }
    }
    return notices;
}

}  // namespace diptych
