#include "host/render/checkpoint.hpp"

#include "backends/sha256.hpp"

#include <fmt/format.h>

#include <cstring>

namespace diptych {
namespace {

bool reads_sample_count(const SceneData& scene)
{
    for (const TextureFunction& function : scene.textures.functions)
        if (function.opencl.find("setting_Samples") != std::string::npos) return true;
    return false;
}

// What backends write into a scene is left out: the trees and where they begin.
std::string hash_of(const SceneData& scene)
{
    Sha256 hash;
    const auto add = [&](const char* name, const void* data, size_t bytes) {
        hash.add(fmt::format("{} {} ", name, bytes));
        hash.add(data, bytes);
    };
    std::vector<Instance> instances = scene.instances;
    for (Instance& instance : instances) instance.root_node = 0;
    add("placed", instances.data(), instances.size() * sizeof(Instance));
#define ADD_BUFFER(type, name)                                                               \
    if (const std::string_view row = #name;                                                  \
        row != "settings" && row != "instances" && row != "bvh_nodes" && row != "bvh_items") \
        add(#name, scene.name.data(), scene.name.size() * sizeof(type));
    SCENE_BUFFERS(ADD_BUFFER)
#undef ADD_BUFFER
    for (const TextureFunction& function : scene.textures.functions)
        add("texture", function.opencl.data(), function.opencl.size());
    add("effects", &scene.effects, sizeof scene.effects);
    return hash.finish();
}

template<class... Fields>
bool equal_bytes(const Settings& a, const Settings& b, Fields... fields)
{
    return (... && (std::memcmp(&(a.*fields), &(b.*fields), sizeof(a.*fields)) == 0));
}

bool has_same_camera(const Settings& a, const Settings& b)
{
    return equal_bytes(a, b, &Settings::camera_kind, &Settings::camera_origin,
                       &Settings::camera_right, &Settings::camera_up, &Settings::camera_forward);
}

bool has_same_environment(const Settings& a, const Settings& b)
{
    return equal_bytes(a, b, &Settings::environment_x, &Settings::environment_y,
                       &Settings::environment_z, &Settings::environment_scale);
}

const char* filter_name(int filter) { return filter == FILTER_BOX ? "box" : "blackman-harris"; }

std::string aovs_text(const std::vector<TextureAov>& aovs)
{
    std::string text;
    for (const TextureAov& aov : aovs) text += (text.empty() ? "" : " ") + aov.node;
    return text.empty() ? "none" : text;
}

std::string bounces_text(int bounces)
{
    return bounces == BOUNCES_UNLIMITED ? "none" : fmt::format("{}", bounces);
}

}  // namespace

CheckpointSubject checkpoint_subject(const SceneData& scene, const std::string& program)
{
    CheckpointSubject subject{program, hash_of(scene), scene.settings.at(0), scene.textures.aovs};
    if (!reads_sample_count(scene)) subject.settings.samples = 0;
    return subject;
}

std::string difference_between(const CheckpointSubject& a, const CheckpointSubject& b)
{
    std::vector<std::string> found;
    const auto compare = [&](const char* what, const std::string& one, const std::string& other) {
        if (one != other) found.push_back(fmt::format("{} ({} and {})", what, one, other));
    };
    const Settings &p = a.settings, &q = b.settings;
    compare("program", a.program, b.program);
    compare("size", fmt::format("{}x{}", p.width, p.height),
            fmt::format("{}x{}", q.width, q.height));
    compare("seed", fmt::format("{}", p.seed), fmt::format("{}", q.seed));
    compare("bounces", bounces_text(p.max_bounces), bounces_text(q.max_bounces));
    compare("filter", filter_name(p.filter), filter_name(q.filter));
    compare("samples, which a texture reads", fmt::format("{}", p.samples),
            fmt::format("{}", q.samples));
    compare("samples in a sequence", fmt::format("{}", QUANTUM << p.sequence_quanta),
            fmt::format("{}", QUANTUM << q.sequence_quanta));
    compare("layers of texture nodes", aovs_text(a.aovs), aovs_text(b.aovs));
    if (p.width == q.width && p.height == q.height && !has_same_camera(p, q))
        found.push_back("camera");
    if (!has_same_environment(p, q)) found.push_back("environment's rotation or scale");
    const bool is_same_scene = a.scene == b.scene;
    if (!is_same_scene)
        found.push_back(
            fmt::format("scene ({} and {})", a.scene.substr(0, 8), b.scene.substr(0, 8)));
    if (found.empty() && std::memcmp(&p, &q, sizeof p) != 0) found.push_back("settings");
    return fmt::format("{}", fmt::join(found, ", "));
}

}  // namespace diptych
