#include "host/scene/texture_solo.hpp"

#include "host/scene/texture_graph.hpp"
#include "host/scene/uri.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace diptych {
namespace {

// Whether node `wanted` is among those that `node` reads, itself included.
bool reads(const std::vector<TextureNode>& nodes, int node, int wanted, std::vector<char>& visited)
{
    if (node == wanted) return true;
    if (node < 0 || node >= int(nodes.size()) || visited[size_t(node)]) return false;
    visited[size_t(node)] = 1;
    return std::ranges::any_of(texture_inputs(nodes[size_t(node)]),
                               [&](int input) { return reads(nodes, input, wanted, visited); });
}

bool reads(const std::vector<TextureNode>& nodes, const MaterialInput& material, int wanted)
{
    std::vector<char> visited(nodes.size(), 0);
    return std::ranges::any_of(
        std::vector<const TextureUse*>{&material.base_texture, &material.metallic_roughness_texture,
                                       &material.normal_texture, &material.emission_texture,
                                       &material.specular_texture,
                                       &material.specular_color_texture},
        [&](const TextureUse* use) { return reads(nodes, use->node, wanted, visited); });
}

}  // namespace

void show_only(const std::string& node, const std::vector<TextureNode>& nodes,
               std::vector<MaterialInput>& materials)
{
    const int wanted = texture_node_named(node, nodes, "--solo");
    bool is_read = false;
    for (MaterialInput& material : materials) {
        MaterialInput shown;
        shown.name = material.name;
        shown.is_unlit = true;
        shown.is_double_sided = material.is_double_sided;
        shown.base_color = {0, 0, 0, 1};
        if (reads(nodes, material, wanted)) {
            is_read = true;
            shown.base_color = {1, 1, 1, 1};
            shown.base_texture.node = wanted;
        }
        material = shown;
    }
    if (!is_read)
        throw SceneError("--solo " + printable(node) +
                         ": no material reads this texture node; give it to one");
}

}  // namespace diptych
