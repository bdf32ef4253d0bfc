// The node hierarchy: what of the scene is where.
#include "host/scene/gltf_loader.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

constexpr size_t most_instances = size_t(1) << 28;

Transform local_transform(const tinygltf::Node& node)
{
    if (node.matrix.size() == 16) {
        Transform t;
        for (size_t row = 0; row < 3; ++row) {
            for (size_t column = 0; column < 4; ++column) {
                t.row[row][column] = node.matrix[4 * column + row];
            }
        }
        return t;
    }
    Transform t;
    if (node.translation.size() == 3) {
        t = translation(node.translation[0], node.translation[1], node.translation[2]);
    }
    if (node.rotation.size() == 4) {
        t = t * rotation(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]);
    }
    if (node.scale.size() == 3) {
        t = t * scaling(node.scale[0], node.scale[1], node.scale[2]);
    }
    return t;
}

Vec3 origin_of(const Transform& t) { return {t.row[0][3], t.row[1][3], t.row[2][3]}; }

}  // namespace

std::string GltfLoader::node_name(int node) const
{
    const std::string& name = model_.nodes[size_t(node)].name;
    return name.empty() ? fmt::format("node {}", node) : name;
}

// The roots of the scene asked for; of the default one; of the first; or all nodes without parents.
std::vector<int> GltfLoader::scene_roots()
{
    const int count = int(model_.scenes.size());
    if (options_.scene_index >= count) {
        throw SceneError(fmt::format("scenes: there is no scene {}, only {}; choose another",
                                     options_.scene_index, count));
    }
    int chosen = options_.scene_index >= 0 ? options_.scene_index : model_.defaultScene;
    if (chosen < 0 && count > 0) {
        chosen = 0;
    }
    if (count > 1) {
        scene_.notice(fmt::format(
            "scenes: {} in the file, number {} is shown; --scene chooses another", count, chosen));
    }
    std::vector<char> has_parent(model_.nodes.size(), 0);
    for (const auto& node : model_.nodes) {
        for (const int child : node.children) {
            has_parent[size_t(child)] = 1;
        }
    }
    std::vector<int> roots;
    if (chosen >= 0) {
        roots = model_.scenes[size_t(chosen)].nodes;
        // Listed although some node has it as a child, as some exporters do: there it belongs.
        std::ranges::stable_sort(roots, {}, [&](int node) { return has_parent[size_t(node)]; });
    } else {
        for (int node = 0; node < int(model_.nodes.size()); ++node) {
            if (!has_parent[size_t(node)]) {
                roots.push_back(node);
            }
        }
        if (!roots.empty()) {
            scene_.notice("scenes: none in the file, all nodes are shown");
        }
    }
    return roots;
}

// Takes away nodes that no remaining node is a parent of; what stays is in or below a cycle.
void GltfLoader::refuse_cycles() const
{
    std::vector<int> parents(model_.nodes.size(), 0);
    for (const auto& node : model_.nodes) {
        for (const int child : node.children) {
            ++parents[size_t(child)];
        }
    }
    std::vector<int> free;
    for (int node = 0; node < int(parents.size()); ++node) {
        if (parents[size_t(node)] == 0) {
            free.push_back(node);
        }
    }
    for (size_t k = 0; k < free.size(); ++k) {
        for (const int child : model_.nodes[size_t(free[k])].children) {
            if (--parents[size_t(child)] == 0) {
                free.push_back(child);
            }
        }
    }
    for (int node = 0; node < int(parents.size()); ++node) {
        if (parents[size_t(node)] > 0) {
            throw SceneError(fmt::format("nodes[{}]: is its own descendant, or below one that is; "
                                         "remove the cycle",
                                         node));
        }
    }
}

// Iterative, since files decide the depth.
void GltfLoader::visit_nodes()
{
    struct Visit {
        int node;
        Transform parent;
    };
    node_visited_.assign(model_.nodes.size(), 0);
    const std::vector<int> roots = scene_roots();
    for (const int root : roots) {
        std::vector<Visit> open{{root, {}}};
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            if (node_visited_[size_t(visit.node)]) {
                ++nodes_of_two_parents_;
                continue;
            }
            node_visited_[size_t(visit.node)] = 1;
            const tinygltf::Node& node = model_.nodes[size_t(visit.node)];
            const Transform to_world = visit.parent * local_transform(node);
            if (!to_world.is_finite()) {
                throw SceneError(fmt::format("nodes[{}]: its transform is beyond the range of "
                                             "numbers; correct it",
                                             visit.node));
            }
            visit_node(visit.node, to_world);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                open.push_back({*child, to_world});
            }
        }
    }
    if (nodes_of_two_parents_ > 0) {
        scene_.notice(
            fmt::format("nodes: {} reached a second time, shown once", nodes_of_two_parents_));
    }
}

void GltfLoader::visit_node(int index, const Transform& to_world)
{
    const tinygltf::Node& node = model_.nodes[size_t(index)];
    if (node.mesh >= 0) {
        if (node.extensions.count("EXT_mesh_gpu_instancing")) {
            add_instances(index, to_world);
        } else {
            placements_.push_back({node.mesh, to_world, node_name(index)});
        }
    }
    if (node.camera >= 0) {
        cameras_.push_back({node.camera, to_world, node.name});
    }
    if (const auto at = node.extensions.find("KHR_lights_punctual"); at != node.extensions.end()) {
        add_node_light(at->second.Get("light").GetNumberAsInt(), to_world);
    }
}

// EXT_mesh_gpu_instancing: the node's mesh once for each element of its attributes.
void GltfLoader::add_instances(int index, const Transform& to_world)
{
    const tinygltf::Node& node = model_.nodes[size_t(index)];
    const auto& attributes = node.extensions.at("EXT_mesh_gpu_instancing").Get("attributes");
    const std::string where = fmt::format("nodes[{}], instancing", index);
    size_t count = 0;
    const auto read = [&](const char* key, int components) -> std::vector<float> {
        if (!attributes.Has(key)) {
            return {};
        }
        auto values = accessor_floats(document_, attributes.Get(key).GetNumberAsInt(), components,
                                      0, where + ", " + key);
        const size_t elements = values.size() / size_t(components);
        if (count != 0 && elements != count) {
            throw SceneError(where + ": attributes of different counts; repair the file");
        }
        count = elements;
        return values;
    };
    const auto t = read("TRANSLATION", 3), r = read("ROTATION", 4), s = read("SCALE", 3);
    if (placements_.size() + count > most_instances) {
        throw SceneError(
            fmt::format("{}: more than {} instances; thin them out", where, most_instances));
    }
    for (size_t k = 0; k < count; ++k) {
        Transform local;
        if (!t.empty()) {
            local = translation(t[3 * k], t[3 * k + 1], t[3 * k + 2]);
        }
        if (!r.empty()) {
            local = local * rotation(r[4 * k], r[4 * k + 1], r[4 * k + 2], r[4 * k + 3]);
        }
        if (!s.empty()) {
            local = local * scaling(s[3 * k], s[3 * k + 1], s[3 * k + 2]);
        }
        placements_.push_back(
            {node.mesh, to_world * local, fmt::format("{} #{}", node_name(index), k)});
    }
}

// Shines along the node's -Z. Candela and lux count as W/sr and W/m^2.
void GltfLoader::add_node_light(int index, const Transform& to_world)
{
    const tinygltf::Light& source = model_.lights[size_t(index)];
    PunctualLight light;
    if (source.type == "directional") {
        light.kind = LIGHT_DIRECTIONAL;
    } else if (source.type == "spot") {
        light.kind = LIGHT_SPOT;
        constexpr double most = 1.5707963267948966;
        light.outer_angle = std::clamp(source.spot.outerConeAngle, 0.0, most);
        light.inner_angle = std::clamp(source.spot.innerConeAngle, 0.0, light.outer_angle);
    } else if (source.type != "point") {
        scene_.notice(fmt::format("lights[{}]: of an unknown type, left out", index));
        return;
    }
    for (size_t c = 0; c < 3; ++c) {
        const double color = source.color.size() == 3 ? source.color[c] : 1;
        const double value = color * source.intensity;
        light.intensity[c] =
            float(std::clamp(value, 0.0, double(std::numeric_limits<float>::max())));
    }
    light.position = origin_of(to_world);
    light.direction = unit(to_world.vector({0, 0, -1}));
    light.range = std::max(0.0, source.range);
    scene_.add_light(light);
}

void GltfLoader::choose_camera()
{
    if (options_.has_view || (cameras_.empty() && options_.camera.empty())) {
        return;
    }
    size_t chosen = options_.camera.empty() ? 0 : cameras_.size();
    for (size_t k = cameras_.size(); k-- > 0 && !options_.camera.empty();) {
        const std::string& own = model_.cameras[size_t(cameras_[k].camera)].name;
        if (options_.camera == cameras_[k].name || options_.camera == own) {
            chosen = k;
        }
    }
    if (chosen == cameras_.size()) {
        const char* end = options_.camera.data() + options_.camera.size();
        const auto [stop, error] = std::from_chars(options_.camera.data(), end, chosen);
        if (error != std::errc() || stop != end || chosen >= cameras_.size()) {
            std::string names;
            for (size_t k = 0; k < cameras_.size(); ++k) {
                names += fmt::format("{}{} ({})", k == 0 ? "" : ", ", k, cameras_[k].name);
            }
            throw SceneError(fmt::format("camera {}: the scene has no such camera; it has {}",
                                         options_.camera, names.empty() ? "none" : names));
        }
    }
    const NodeCamera& at = cameras_[chosen];
    const tinygltf::Camera& source = model_.cameras[size_t(at.camera)];
    CameraInput camera;
    camera.eye = origin_of(at.to_world);
    camera.target = camera.eye + unit(at.to_world.vector({0, 0, -1}));
    camera.up = unit(at.to_world.vector({0, 1, 0}));
    if (source.type == "orthographic") {
        camera.half_height = std::abs(source.orthographic.ymag);
        if (!(camera.half_height > 0)) {
            throw SceneError(
                fmt::format("cameras[{}]: ymag is 0; give the view a height", at.camera));
        }
    } else {
        camera.fov = source.perspective.yfov;
    }
    scene_.set_camera(camera);
}

void GltfLoader::run()
{
    refuse_cycles();
    visit_nodes();
    choose_camera();
    add_materials();
    add_textures();
    add_meshes();
    read_images();
    document_.release_buffers();
    for (const MaterialInput& material : materials_) {
        scene_.add_material(material);
    }
    for (TextureNode& node : texture_nodes_) {
        scene_.add_texture_node(std::move(node));
    }
    for (const NodePlacement& placement : placements_) {
        scene_.place(mesh_numbers_[size_t(placement.mesh)], placement.to_world, placement.name);
    }
    tell_what_was_skipped();
}

}  // namespace diptych
