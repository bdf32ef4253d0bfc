#include "host/commands/explain_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>

namespace diptych {
namespace {

constexpr size_t names_shown = 3;

// "gold, mirror, brass and 2 more"
std::string listed(const std::vector<std::string>& names)
{
    const size_t shown = std::min(names.size(), names_shown);
    std::string text =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + long(shown), ", "));
    if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
    return text;
}

std::string material_name(const SceneData& scene, size_t k)
{
    if (k < scene.material_names.size() && !scene.material_names[k].empty())
        return scene.material_names[k];
    return fmt::format("number {}", k);
}

// Materials that some triangle has.
std::vector<char> used_materials(const SceneData& scene)
{
    std::vector<char> is_used(scene.materials.size(), 0);
    for (const Triangle& triangle : scene.triangles)
        if (triangle.material >= 0 && size_t(triangle.material) < is_used.size())
            is_used[size_t(triangle.material)] = 1;
    return is_used;
}

std::string materials_with(const SceneData& scene, const std::function<bool(const Material&)>& has)
{
    const std::vector<char> is_used = used_materials(scene);
    std::vector<std::string> names;
    for (size_t k = 0; k < scene.materials.size(); ++k)
        if (is_used[k] && has(scene.materials[k])) names.push_back(material_name(scene, k));
    if (names.empty()) return "";
    return (names.size() == 1 ? "material " : "materials ") + listed(names);
}

std::string counted(size_t n, const std::string& thing)
{
    return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s");
}

const char* kind_name(int kind)
{
    switch (kind) {
    case LIGHT_POINT:
        return "point light";
    case LIGHT_SPOT:
        return "spot light";
    case LIGHT_DIRECTIONAL:
        return "directional light";
    case LIGHT_ENVIRONMENT:
        return "environment";
    default:
        return "emissive triangle";
    }
}

std::string punctual_kinds(const SceneData& scene)
{
    std::map<int, size_t> counts;
    for (const Light& light : scene.lights) ++counts[light.kind];
    std::vector<std::string> parts;
    for (const int kind : {LIGHT_POINT, LIGHT_SPOT, LIGHT_DIRECTIONAL})
        if (counts[kind] > 0) parts.push_back(counted(counts[kind], kind_name(kind)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string float_images(const SceneData& scene)
{
    const auto count = std::count_if(scene.images.begin(), scene.images.end(),
                                     [](const Image& i) { return i.encoding == TEXELS_FLOAT; });
    return counted(size_t(count), "image");
}

void add_effects(std::string& text, const SceneData& scene)
{
    text += "Effects it calls for\n";
    std::vector<std::string> absent;
#define EXPLAIN_EFFECT(name, bit, words)                                                         \
    if (scene.effects & EFFECT_##name)                                                           \
        text += fmt::format("  {:<18}{}: {}\n", #name, words, reason_for(scene, EFFECT_##name)); \
    else                                                                                         \
        absent.push_back(words);
    EFFECTS_LIST(EXPLAIN_EFFECT)
#undef EXPLAIN_EFFECT
    if (scene.effects == 0) text += "  none\n";
    if (!absent.empty())
        text += fmt::format("Not called for, so neither compiled nor run\n  {}\n",
                            fmt::join(absent, "\n  "));
}

std::vector<std::string> effects_in(unsigned mask)
{
    std::vector<std::string> names;
#define ADD_EFFECT(name, bit, words) \
    if (mask & EFFECT_##name) names.push_back(#name);
    EFFECTS_LIST(ADD_EFFECT)
#undef ADD_EFFECT
    return names;
}

void add_stages(std::string& text, const SceneData& scene)
{
    text += "Stages, in order\n";
    const auto add = [&](const char* name, const char* when, unsigned needs) {
        const unsigned has = scene.effects & needs;
        if (needs == 0)
            text += fmt::format("  {:<17} {}, always\n", name, when);
        else if (has != 0)
            text +=
                fmt::format("  {:<17} {}, for {}\n", name, when, fmt::join(effects_in(has), ", "));
        else
            text += fmt::format("  {:<17} skipped: needs one of {}\n", name,
                                fmt::join(effects_in(needs), ", "));
    };
    const std::map<std::string, const char*> when_words = {{"once", "once"},
                                                           {"each_bounce", "each bounce"},
                                                           {"first_bounce", "first bounce"},
                                                           {"each_surface", "each surface"},
                                                           {"each_layer", "each layer"},
                                                           {"at_end", "at the end"}};
#define EXPLAIN_STAGE(name, body, when, needs) add(#name, when_words.at(#when), needs);
    STAGES(EXPLAIN_STAGE)
#undef EXPLAIN_STAGE
}

// Lights as a person counts them: emissive triangles by material, others one by one.
struct LightGroup {
    std::string name;
    size_t count = 0;
    double share = 0;
};

std::vector<LightGroup> light_groups(const SceneData& scene)
{
    std::map<int, LightGroup> surfaces;
    std::vector<LightGroup> groups;
    for (const Light& light : scene.lights) {
        const double share = double(light.emission.w);
        if (light.kind == LIGHT_TRIANGLE) {
            const int material = scene.triangles.at(size_t(light.triangle)).material;
            LightGroup& group = surfaces[material];
            group.name = "material " + material_name(scene, size_t(material));
            ++group.count;
            group.share += share;
            continue;
        }
        std::string name = kind_name(light.kind);
        if (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT)
            name += fmt::format(" at {:g}, {:g}, {:g}", light.position.x, light.position.y,
                                light.position.z);
        groups.push_back({name, 1, share});
    }
    for (const auto& [material, group] : surfaces)
        groups.push_back(
            {fmt::format("{}: {}", group.name, counted(group.count, "emissive triangle")),
             group.count, group.share});
    std::stable_sort(groups.begin(), groups.end(),
                     [](const LightGroup& a, const LightGroup& b) { return a.share > b.share; });
    return groups;
}

void add_lights(std::string& text, const SceneData& scene)
{
    text += "Lights, with their share of the power (a light is chosen in proportion to it)\n";
    const std::vector<LightGroup> groups = light_groups(scene);
    if (groups.empty()) text += "  none: the picture is black but for unlit surfaces\n";
    constexpr size_t shown = 12;
    double rest = 1;
    for (size_t k = 0; k < std::min(groups.size(), shown); ++k) {
        text += fmt::format("  {:5.1f} %  {}\n", groups[k].share * 100, groups[k].name);
        rest -= groups[k].share;
    }
    if (groups.size() > shown)
        text +=
            fmt::format("  {:5.1f} %  {} more\n", std::max(0.0, rest) * 100, groups.size() - shown);
}

std::string kibibytes(size_t bytes) { return fmt::format("{:>12.1f} KiB", double(bytes) / 1024); }

void add_memory(std::string& text, const SceneData& scene)
{
    text += "Memory of the scene, by buffer\n";
    size_t total = 0;
#define EXPLAIN_BUFFER(type, name)                                                   \
    if (!scene.name.empty()) {                                                       \
        const size_t bytes = scene.name.size() * sizeof(type);                       \
        total += bytes;                                                              \
        text += fmt::format("  {:<18}{}  {} of {} bytes\n", #name, kibibytes(bytes), \
                            scene.name.size(), sizeof(type));                        \
    }
    SCENE_BUFFERS(EXPLAIN_BUFFER)
#undef EXPLAIN_BUFFER
    text += fmt::format("  {:<18}{}\n", "together", kibibytes(total));
    for (const char* name : {"cpu", "twin"}) {
        const Plan plan = make_backend(name, {})->plan(scene);
        text += fmt::format("  {:<18}{}  estimated: {}\n", "tree", kibibytes(plan.structure_bytes),
                            std::string(name) == "cpu" ? "Embree's, for cpu"
                                                       : "ours, for opencl, twin and double");
    }
}

void add_omissions(std::string& text, const SceneData& scene)
{
    text += "Not simulated\n"
            "  baked ambient occlusion textures of glTF: a path tracer computes occlusion itself\n";
    if (scene.degenerate_triangles > 0)
        text += fmt::format("  {} without area: dropped\n",
                            counted(scene.degenerate_triangles, "triangle"));
    for (const std::string& line : scene.notices) text += "  " + line + "\n";
}

std::string textures_with_occlusion(const SceneData& scene)
{
    std::vector<std::string> names;
    for (const TextureFunction& function : scene.textures.functions)
        if (!function.occlusion.empty()) names.push_back(function.entry);
    return fmt::format("textures {}", fmt::join(names, ", "));
}

}  // namespace

std::string reason_for(const SceneData& scene, unsigned effect)
{
    const Settings& settings = scene.settings.at(0);
    if ((scene.effects & effect) == 0) return "";
    switch (effect) {
    case EFFECT_SPECULAR:
        return materials_with(
            scene, [](const Material& m) { return m.metallic > 0 || m.specular_color.w > 0; });
    case EFFECT_BASE_TEXTURE:
        return materials_with(scene, [](const Material& m) { return m.base_slot >= 0; });
    case EFFECT_SURFACE_TEXTURES:
        return materials_with(scene, [](const Material& m) {
            return m.metallic_roughness_slot >= 0 || m.specular_slot >= 0 ||
                   m.specular_color_slot >= 0;
        });
    case EFFECT_NORMAL_MAP:
        return materials_with(scene, [](const Material& m) { return m.normal_slot >= 0; });
    case EFFECT_EMISSION:
        return materials_with(scene, [](const Material& m) {
            return m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0;
        });
    case EFFECT_EMISSION_TEXTURE:
        return materials_with(scene, [](const Material& m) { return m.emission_slot >= 0; });
    case EFFECT_PROCEDURAL:
        return materials_with(scene, [](const Material& m) {
            return m.texture_program[PROGRAM_SURFACE] != 0 ||
                   m.texture_program[PROGRAM_ALPHA] != 0 ||
                   m.texture_program[PROGRAM_EMISSION] != 0;
        });
    case EFFECT_TEXTURE_OCCLUSION:
        return textures_with_occlusion(scene);
    case EFFECT_PROCEDURAL_EMISSION:
        return materials_with(
            scene, [](const Material& m) { return m.texture_program[PROGRAM_EMISSION] != 0; });
    case EFFECT_PROCEDURAL_ALPHA:
        return materials_with(
            scene, [](const Material& m) { return m.texture_program[PROGRAM_ALPHA] != 0; });
    case EFFECT_TEXTURE_AOV:
        return counted(scene.textures.aovs.size(), "layer") + " of the picture";
    case EFFECT_OCCLUSION_DISTANCE:
        return materials_with(
            scene, [](const Material& m) { return m.texture_program[PROGRAM_DISTANCE] != 0; });
    case EFFECT_ALPHA:
        return materials_with(scene,
                              [](const Material& m) { return m.alpha_mode != ALPHA_OPAQUE; });
    case EFFECT_UNLIT:
        return materials_with(scene,
                              [](const Material& m) { return (m.flags & MATERIAL_UNLIT) != 0; });
    case EFFECT_PUNCTUAL_LIGHTS:
        return punctual_kinds(scene);
    case EFFECT_ENVIRONMENT:
        return fmt::format("a radiance map of {} x {}", settings.environment_width,
                           settings.environment_height);
    case EFFECT_INSTANCES:
        return counted(scene.instances.size() - 1, "placement") + " of shared meshes";
    case EFFECT_SMOOTH_NORMALS:
        return counted(scene.normals.size(), "vertex normal");
    case EFFECT_VERTEX_COLOR:
        return counted(scene.colors.size(), "vertex colour");
    case EFFECT_FLOAT_TEXTURES:
        return float_images(scene);
    case EFFECT_ORTHOGRAPHIC:
        return "the camera of this view";
    }
    return "";
}

std::string explanation(const SceneData& scene, const SceneFlags& flags)
{
    std::string text =
        fmt::format("{}: {}, {}, {}, {}\n", flags.scene.empty() ? "the demo scene" : flags.scene,
                    counted(scene.triangles.size(), "triangle"),
                    counted(scene.material_names.size(), "material"),
                    counted(scene.images.size(), "image"), counted(scene.lights.size(), "light"));
    add_effects(text, scene);
    add_stages(text, scene);
    add_lights(text, scene);
    add_omissions(text, scene);
    add_memory(text, scene);
    return text;
}

CLI::App* add_explain_command(CLI::App& app, ExplainCommand& command)
{
    CLI::App* explain =
        app.add_subcommand("explain", "Tell which effects a scene calls for, and why");
    explain->footer(
        "Effects and the materials, lights or camera that call for them; the stages that they "
        "activate; lights\nwith their share of power; what the scene has and Diptych does not "
        "simulate; memory by buffer.\nExit code: 0 done, 2 error.");
    add_scene_flags(*explain, command.scene);
    return explain;
}

int run_explain_command(const ExplainCommand& command)
{
    std::cout << explanation(load_from_flags(command.scene), command.scene);
    return 0;
}

}  // namespace diptych
