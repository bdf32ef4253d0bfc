#include "backends/bvh_flatten.hpp"

#include <bit>
#include <cmath>

namespace diptych {
namespace {

// Levels of inner nodes that halving needs down to leaves of `leaf_size`.
int halving_levels(int count, int leaf_size)
{
    const unsigned leaves = unsigned((count + leaf_size - 1) / leaf_size);
    return std::bit_width(leaves - 1);
}

void collect(const BuildNode& node, std::vector<int>& items)
{
    if (!node.child[0]) items.insert(items.end(), node.items, node.items + node.count);
    for (const BuildNode* child : node.child)
        if (child) collect(*child, items);
}

}  // namespace

int BvhFlattener::add(const BuildTree& tree, int depth)
{
    tree_ = &tree;
    const int root = new_node();
    if (!tree.root) return root;
    if (tree.root->child[0]) {
        nodes_.pop_back();
        return add_node(*tree.root, depth);
    }
    const int leaf = add_node(*tree.root, depth);
    set_child(root, 0, leaf, tree.root->box);
    return root;
}

// `levels`: inner nodes that may still follow each other. Halving always fits: it needs no more
// levels for a child than for its parent, and switches in while there are just enough.
int BvhFlattener::add_node(const BuildNode& node, int levels)
{
    if (!node.child[0]) return add_leaf({node.items, size_t(node.count)});
    if (levels <= halving_levels(node.count, tree_->leaf_size)) {
        std::vector<int> items;
        collect(node, items);
        return add_halves(items, levels);
    }
    const int index = new_node();
    for (int k = 0; k < 2; ++k)
        set_child(index, k, add_node(*node.child[k], levels - 1), node.child[k]->box);
    return index;
}

int BvhFlattener::add_halves(std::span<const int> items, int levels)
{
    const size_t leaf_size = size_t(tree_->leaf_size);
    if (items.size() <= leaf_size) return add_leaf(items);
    const size_t leaves = (items.size() + leaf_size - 1) / leaf_size;
    const size_t left = (leaves + 1) / 2 * leaf_size;
    const int index = new_node();
    const std::span<const int> halves[2] = {items.first(left), items.subspan(left)};
    for (int k = 0; k < 2; ++k)
        set_child(index, k, add_halves(halves[k], levels - 1), bounds(halves[k]));
    return index;
}

int BvhFlattener::add_leaf(std::span<const int> items)
{
    const int first = int(items_.size());
    for (const int item : items) items_.push_back(tree_->items[item].id);
    return BVH_LEAF(first, int(items.size()));
}

int BvhFlattener::new_node()
{
    nodes_.push_back({});
    const int index = int(nodes_.size()) - 1;
    for (int k = 0; k < 2; ++k) set_child(index, k, BVH_NONE, Box());
    return index;
}

void BvhFlattener::set_child(int node, int k, int child, const Box& box)
{
    BvhNode& target = nodes_[node];
    target.child[k] = child;
    float4* rows[3] = {&target.x, &target.y, &target.z};
    for (int axis = 0; axis < 3; ++axis) {
        (k ? rows[axis]->z : rows[axis]->x) = box.low[axis];
        (k ? rows[axis]->w : rows[axis]->y) = box.high[axis];
    }
}

Box BvhFlattener::bounds(std::span<const int> items) const
{
    Box box;
    for (const int item : items) box.add(tree_->items[item].box);
    return box;
}

}  // namespace diptych
