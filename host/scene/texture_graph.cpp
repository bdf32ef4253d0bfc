#include "host/scene/texture_graph.hpp"

#include "host/scene/texture_arguments.hpp"
#include "host/scene/uri.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace diptych {
namespace {

enum class Visit : char { unseen, open, done };

// Depth first without recursion: graphs come from strangers. Calls on_done(node) when all inputs of
// a node are done, on_cycle(path) with the nodes from the one met again onwards.
template<typename Done, typename Cycle>
void walk(const std::vector<TextureNode>& nodes, int root, std::vector<Visit>& visits,
          const Done& on_done, const Cycle& on_cycle)
{
    struct Frame {
        int node;
        std::vector<int> inputs;
        size_t next = 0;
    };
    std::vector<Frame> frames;
    const auto enter = [&](int node) {
        visits[size_t(node)] = Visit::open;
        frames.push_back({node, texture_inputs(nodes[size_t(node)])});
    };
    if (visits[size_t(root)] == Visit::unseen) enter(root);
    while (!frames.empty()) {
        Frame& frame = frames.back();
        if (frame.next == frame.inputs.size()) {
            visits[size_t(frame.node)] = Visit::done;
            on_done(frame.node);
            frames.pop_back();
            continue;
        }
        const int input = frame.inputs[frame.next++];
        if (visits[size_t(input)] == Visit::open) {
            std::vector<int> path;
            for (const Frame& f : frames) path.push_back(f.node);
            path.erase(path.begin(), std::ranges::find(path, input));
            on_cycle(path);
        } else if (visits[size_t(input)] == Visit::unseen) {
            enter(input);
        }
    }
}

}  // namespace

std::vector<int> texture_inputs(const TextureNode& node)
{
    std::vector<int> inputs;
    for (const auto& [name, value] : node.arguments) {
        if (value.node >= 0 && std::ranges::find(inputs, value.node) == inputs.end()) {
            inputs.push_back(value.node);
        }
    }
    return inputs;
}

void refuse_texture_node(const nlohmann::json& name, const std::vector<std::string>& nodes,
                         const std::string& where)
{
    const std::string what =
        fmt::format("{}: {} names no texture node; ", where, printable(dumped(name)));
    if (nodes.empty()) throw SceneError(what + "the scene has none; add one with --texture");
    std::vector<std::string> names;
    for (size_t k = 0; k < std::min<size_t>(nodes.size(), 8); ++k)
        names.push_back(printable(nodes[k]));
    throw SceneError(what + fmt::format("there are {}: {}; name one of these", nodes.size(),
                                        fmt::join(names, ", ")));
}

void check_texture_graph(const std::vector<TextureNode>& nodes)
{
    for (const TextureNode& node : nodes) {
        for (const auto& [name, value] : node.arguments) {
            if (value.node >= int(nodes.size())) {
                throw SceneError(fmt::format("texture node {}: its argument {} names node {} of "
                                             "{}; name one that is there",
                                             node.name, name, value.node, nodes.size()));
            }
        }
    }
    const auto fail = [&](const std::vector<int>& path) {
        std::string names;
        for (const int node : path) names += nodes[size_t(node)].name + " > ";
        throw SceneError(fmt::format("texture nodes: {}{} is a cycle; let one of them read "
                                     "something else",
                                     names, nodes[size_t(path.front())].name));
    };
    std::vector<Visit> visits(nodes.size(), Visit::unseen);
    for (size_t k = 0; k < nodes.size(); ++k) {
        walk(
            nodes, int(k), visits, [](int) {}, fail);
    }
}

GraphProgram texture_order(const std::vector<TextureNode>& nodes, const std::vector<int>& roots)
{
    GraphProgram program;
    std::vector<Visit> visits(nodes.size(), Visit::unseen);
    for (const int root : roots) {
        walk(
            nodes, root, visits,
            [&](int node) {
                program.steps.push_back({node, -1});
            },
            [](const std::vector<int>&) {});
    }
    std::map<int, size_t> last_use;  // of a node's result: the last step that reads it
    for (size_t k = 0; k < program.steps.size(); ++k) {
        for (const int input : texture_inputs(nodes[size_t(program.steps[k].node)])) {
            last_use[input] = k;
        }
    }
    std::vector<int> free_slots;  // descending
    std::map<int, int> slot_of;
    for (size_t k = 0; k < program.steps.size(); ++k) {
        GraphStep& step = program.steps[k];
        for (const int input : texture_inputs(nodes[size_t(step.node)])) {
            if (last_use[input] == k) free_slots.push_back(slot_of[input]);
        }
        if (!last_use.count(step.node)) continue;
        std::ranges::sort(free_slots, std::greater<>());
        if (free_slots.empty()) free_slots.push_back(program.slots++);
        step.slot = slot_of[step.node] = free_slots.back();
        free_slots.pop_back();
    }
    return program;
}

}  // namespace diptych
