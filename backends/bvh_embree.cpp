#include "backends/bvh_embree.hpp"

#include "kernels_cpu/embree.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

namespace diptych {

void Box::add_point(const std::array<float, 3>& point)
{
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], point[axis]);
        high[axis] = std::max(high[axis], point[axis]);
    }
}

void Box::add(const Box& other)
{
    add_point(other.low);
    add_point(other.high);
}

void Box::grow(float by)
{
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::nextafter(low[axis] - by, -infinite);
        high[axis] = std::nextafter(high[axis] + by, infinite);
    }
}

void Box::pad()
{
    float extent = 0;
    for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, high[axis] - low[axis]);
    grow(extent * BVH_PADDING);
}

Box triangle_box(const SceneData& scene, int triangle)
{
    Box box;
    const Triangle& t = scene.triangles[triangle];
    for (const int vertex : {t.vertex0, t.vertex1, t.vertex2}) {
        const float4& p = scene.positions[vertex];
        box.add_point({p.x, p.y, p.z});
    }
    box.pad();
    return box;
}

struct BvhBuilder::State {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCBVH bvh = device ? rtcNewBVH(device) : nullptr;

    ~State()
    {
        if (bvh) rtcReleaseBVH(bvh);
        if (device) rtcReleaseDevice(device);
    }
};

namespace {

void check(RTCDevice device, const void* result, const char* call)
{
    if (result) return;
    throw std::runtime_error(std::string("Embree: ") + call + " failed with error " +
                             std::to_string(int(rtcGetDeviceError(device))) +
                             "; is there enough memory?");
}

// Callbacks of rtcBuildBVH. Nodes live in Embree's arena, which the next build reuses.
void* make_node(RTCThreadLocalAllocator arena, unsigned, void*)
{
    return new (rtcThreadLocalAlloc(arena, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
}

void set_children(void* node, void** children, unsigned count, void*)
{
    for (unsigned k = 0; k < count && k < 2; ++k)
        static_cast<BuildNode*>(node)->child[k] = static_cast<BuildNode*>(children[k]);
}

void set_bounds(void*, const RTCBounds**, unsigned, void*) {}  // computed anew, see finish()

void* make_leaf(RTCThreadLocalAllocator arena, const RTCBuildPrimitive* primitives, size_t count,
                void*)
{
    auto* leaf = new (rtcThreadLocalAlloc(arena, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
    leaf->count = int(count);
    for (size_t k = 0; k < count; ++k) leaf->items[k] = int(primitives[k].primID);
    std::sort(leaf->items, leaf->items + count);  // threads partition in an order of their own
    return leaf;
}

// Counts and boxes from the leaves upwards.
void finish(BuildNode* node, const std::vector<BuildItem>& items)
{
    if (!node->child[0]) {
        for (int k = 0; k < node->count; ++k) node->box.add(items[node->items[k]].box);
        return;
    }
    for (const BuildNode* child : node->child) {
        finish(const_cast<BuildNode*>(child), items);
        node->box.add(child->box);
        node->count += child->count;
    }
}

std::vector<RTCBuildPrimitive> build_primitives(const std::vector<BuildItem>& items)
{
    std::vector<RTCBuildPrimitive> primitives(items.size());
    for (size_t k = 0; k < items.size(); ++k) {
        const Box& box = items[k].box;
        primitives[k] = {box.low[0],  box.low[1],  box.low[2],  0,
                         box.high[0], box.high[1], box.high[2], unsigned(k)};
    }
    return primitives;
}

}  // namespace

BvhBuilder::BvhBuilder() : state_(std::make_unique<State>())
{
    check(nullptr, state_->device, "rtcNewDevice");
    check(state_->device, state_->bvh, "rtcNewBVH");
}

BvhBuilder::~BvhBuilder() = default;

BuildTree BvhBuilder::build(std::vector<BuildItem> items, int leaf_size)
{
    BuildTree tree;
    tree.items = std::move(items);
    tree.leaf_size = leaf_size;
    if (tree.items.empty()) return tree;
    std::vector<RTCBuildPrimitive> primitives = build_primitives(tree.items);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 512;  // the flattener bounds it
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = unsigned(leaf_size);
    arguments.traversalCost = 1.0f;
    arguments.intersectionCost = 1.0f;
    arguments.bvh = state_->bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = make_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = make_leaf;
    auto* root = static_cast<BuildNode*>(rtcBuildBVH(&arguments));
    check(state_->device, root, "rtcBuildBVH");
    finish(root, tree.items);
    tree.root = root;
    return tree;
}

}  // namespace diptych
