// The graph of procedural textures, put in an order that a small stack machine can run.
#pragma once

#include "host/scene/scene_builder.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace diptych {

// A node in the program of a material.
struct GraphStep {
    int node;
    int slot;  // of the stack, for nodes behind it; -1: nobody reads it there
};

struct GraphProgram {
    std::vector<GraphStep> steps;  // arguments before those who read them, each node once
    int slots = 0;                 // values that live at once
};

// The nodes whose results node `k` reads, in the order of its arguments' names, each once.
std::vector<int> texture_inputs(const TextureNode& node);

// Throws SceneError that begins with `where` and says which nodes there are.
[[noreturn]] void refuse_texture_node(const nlohmann::json& name,
                                      const std::vector<std::string>& nodes,
                                      const std::string& where);

// The number of the node that is meant by its name or its number. Refuses any other.
template<class Node>
int texture_node_named(const nlohmann::json& name, const std::vector<Node>& nodes,
                       const std::string& where)
{
    if (name.is_number_unsigned() && name.get<std::uint64_t>() < nodes.size())
        return name.get<int>();
    if (name.is_string()) {
        const auto at = std::ranges::find(nodes, name.get_ref<const std::string&>(), &Node::name);
        if (at != nodes.end()) return int(at - nodes.begin());
    }
    std::vector<std::string> names;
    for (const Node& node : nodes) names.push_back(node.name);
    refuse_texture_node(name, names, where);
}

// Throws SceneError naming the nodes of a cycle, or a reference to a node that is not there.
void check_texture_graph(const std::vector<TextureNode>& nodes);

// Depth first from each root in turn. The graph was checked.
GraphProgram texture_order(const std::vector<TextureNode>& nodes, const std::vector<int>& roots);

}  // namespace diptych
