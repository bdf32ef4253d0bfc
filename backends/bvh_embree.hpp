// Embree's builder (surface area heuristic, binned, two children a node) behind plain values.
#pragma once

#include "backends/scene_data.hpp"

#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace diptych {

struct Box {
    std::array<float, 3> low = {infinite, infinite, infinite};
    std::array<float, 3> high = {-infinite, -infinite, -infinite};

    static constexpr float infinite = std::numeric_limits<float>::max();

    void add_point(const std::array<float, 3>& point);
    void add(const Box& other);
    void grow(float by);  // outwards on every side
    void pad();           // by BVH_PADDING of the largest extent
    bool is_empty() const { return low[0] > high[0]; }
};

// Padded: see BVH_SLACK in common/bvh.h.
Box triangle_box(const SceneData& scene, int triangle);

struct BuildItem {
    Box box;
    int id;
};

// A node as built: two children, or up to the leaf size of items.
struct BuildNode {
    Box box;
    const BuildNode* child[2] = {nullptr, nullptr};  // none: a leaf
    int count = 0;                                   // of items in and under the node
    int items[8] = {};                               // leaf: positions in the list of items
};

// A tree over `items`; root = nullptr where there are none. Valid until the builder's next build.
struct BuildTree {
    const BuildNode* root = nullptr;
    std::vector<BuildItem> items;
    int leaf_size = 1;
};

class BvhBuilder {
public:
    BvhBuilder();
    ~BvhBuilder();

    // At most `leaf_size` (1 to BVH_LEAF_MAX) items a leaf. Throws std::runtime_error.
    BuildTree build(std::vector<BuildItem> items, int leaf_size);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace diptych
