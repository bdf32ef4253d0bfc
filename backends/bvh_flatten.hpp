// From a tree of pointers to the nodes and items of the layout.
#pragma once

#include "backends/bvh_embree.hpp"

#include <span>
#include <vector>

namespace diptych {

// Triangles a leaf of a mesh's tree, at most.
inline constexpr int BVH_MESH_LEAF = 4;

// Appends trees to `nodes` and `items`, depth first, the first child next to its parent.
class BvhFlattener {
public:
    BvhFlattener(std::vector<BvhNode>& nodes, std::vector<int>& items)
        : nodes_(nodes), items_(items)
    {
    }

    // Returns the root's index. No leaf lies below more than `depth` inner nodes: what would is
    // split anew, in halves.
    int add(const BuildTree& tree, int depth);

private:
    int add_node(const BuildNode& node, int levels);
    int add_halves(std::span<const int> items, int levels);
    int add_leaf(std::span<const int> items);
    int new_node();
    void set_child(int node, int k, int child, const Box& box);
    Box bounds(std::span<const int> items) const;

    std::vector<BvhNode>& nodes_;
    std::vector<int>& items_;
    const BuildTree* tree_ = nullptr;
};

}  // namespace diptych
