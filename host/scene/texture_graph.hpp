// The graph of procedural textures, put in an order that a small stack machine can run.
#pragma once

#include "host/scene/scene_builder.hpp"

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

// The number of the node of that name. Throws SceneError that says which there are, for `flag`.
int texture_node_named(const std::string& name, const std::vector<TextureNode>& nodes,
                       const char* flag);

// Throws SceneError naming the nodes of a cycle, or a reference to a node that is not there.
void check_texture_graph(const std::vector<TextureNode>& nodes);

// Depth first from each root in turn. The graph was checked.
GraphProgram texture_order(const std::vector<TextureNode>& nodes, const std::vector<int>& roots);

}  // namespace diptych
