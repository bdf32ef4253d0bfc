// The walk of the bounding volume hierarchy: what a ray meets first, or whether it meets anything.
// Two levels where the scene calls for instances: the tree at node 0 holds instances, and each of
// them names the tree of its mesh. The answer does not depend on the order of the walk: equal
// distances are decided by the smaller instance, then the smaller triangle.
#pragma once

#include "common/alpha.h"
#include "common/triangle.h"

// What a ray meets first; triangle = -1: nothing.
typedef struct {
    float t;  // along the ray in world space
    int triangle;
    int instance;
} Hit;

// What tells which surfaces stop a ray: its number for the decisions of common/alpha.h, and the
// last surface behind which it goes on; that one's triangle -1: none yet.
typedef struct {
    uint seed;
    Hit passed;
} BvhAlpha;

SHARED BvhAlpha bvh_alpha(uint seed)
{
    const Hit none = {0.0f, -1, -1};
    BvhAlpha alpha;
    alpha.seed = seed;
    alpha.passed = none;
    return alpha;
}

// Hits have an order along the ray, that of equal distances included.
SHARED int bvh_is_behind(Hit hit, Hit passed)
{
    const int is_later = (hit.instance > passed.instance) |
                         ((hit.instance == passed.instance) & (hit.triangle > passed.triangle));
    return (hit.t > passed.t) | ((hit.t == passed.t) & is_later);
}

// A ray in the space of the tree that is being walked.
typedef struct {
    TriangleRay triangle;
    float3 inverse;  // 1 / direction
} BvhRay;

// Boxes and triangles round differently: the walk enters boxes that begin this much farther than
// the nearest hit or than their own end. With what the builder adds to every box (BVH_PADDING) it
// covers both errors, so that no hit is lost.
#define BVH_SLACK 0.999998f

// Stands for 1 / 0, and leaves room to multiply.
#define BVH_LARGE 1e25f

SHARED float bvh_inverse(float x)
{
    const float large = x < 0.0f ? -BVH_LARGE : BVH_LARGE;
    return math_abs(x) * BVH_LARGE > 1.0f ? 1.0f / x : large;
}

SHARED BvhRay bvh_ray(float3 origin, float3 direction)
{
    BvhRay ray;
    ray.triangle = triangle_ray(origin, direction);
    ray.inverse =
        make_float3(bvh_inverse(direction.x), bvh_inverse(direction.y), bvh_inverse(direction.z));
    return ray;
}

// The direction keeps the length that the transformation gives it, and t its meaning.
SHARED BvhRay bvh_object_ray(const Scene* scene, int instance, float3 o, float3 d)
{
    const STORED(Instance) m = ROW_AT(scene, instances, instance);
    const float3 origin = make_float3(
        m.to_object_x.x * o.x + m.to_object_x.y * o.y + m.to_object_x.z * o.z + m.to_object_x.w,
        m.to_object_y.x * o.x + m.to_object_y.y * o.y + m.to_object_y.z * o.z + m.to_object_y.w,
        m.to_object_z.x * o.x + m.to_object_z.y * o.y + m.to_object_z.z * o.z + m.to_object_z.w);
    const float3 direction =
        make_float3(m.to_object_x.x * d.x + m.to_object_x.y * d.y + m.to_object_x.z * d.z,
                    m.to_object_y.x * d.x + m.to_object_y.y * d.y + m.to_object_y.z * d.z,
                    m.to_object_z.x * d.x + m.to_object_z.y * d.y + m.to_object_z.z * d.z);
    return bvh_ray(origin, direction);
}

// Where the ray enters the box, or BVH_MISS. An empty box has low > high.
#define BVH_MISS (-1.0f)
SHARED float bvh_box_entry(const BvhRay* ray, float3 low, float3 high, float t_max)
{
    const float3 o = ray->triangle.origin;
    const float3 inverse = ray->inverse;
    const float x0 = ((inverse.x < 0.0f ? high.x : low.x) - o.x) * inverse.x;
    const float y0 = ((inverse.y < 0.0f ? high.y : low.y) - o.y) * inverse.y;
    const float z0 = ((inverse.z < 0.0f ? high.z : low.z) - o.z) * inverse.z;
    const float x1 = ((inverse.x < 0.0f ? low.x : high.x) - o.x) * inverse.x;
    const float y1 = ((inverse.y < 0.0f ? low.y : high.y) - o.y) * inverse.y;
    const float z1 = ((inverse.z < 0.0f ? low.z : high.z) - o.z) * inverse.z;
    const float entry_xy = x0 > y0 ? x0 : y0;
    const float entry_z = z0 > 0.0f ? z0 : 0.0f;
    const float entry = (entry_xy > entry_z ? entry_xy : entry_z) * BVH_SLACK;
    const float exit_xy = x1 < y1 ? x1 : y1;
    const float exit_z = z1 < t_max ? z1 : t_max;
    return entry <= (exit_xy < exit_z ? exit_xy : exit_z) ? entry : BVH_MISS;
}

SHARED float bvh_child_entry(const Scene* scene, const BvhRay* ray, int node, int k, float t_max)
{
    const STORED(float4) x = ROW_AT(scene, bvh_nodes, node).x;
    const STORED(float4) y = ROW_AT(scene, bvh_nodes, node).y;
    const STORED(float4) z = ROW_AT(scene, bvh_nodes, node).z;
    const float3 low = make_float3(k ? x.z : x.x, k ? y.z : y.x, k ? z.z : z.x);
    const float3 high = make_float3(k ? x.w : x.y, k ? y.w : y.y, k ? z.w : z.y);
    return bvh_box_entry(ray, low, high, t_max);
}

SHARED int bvh_is_transparent(const Scene* scene, Hit hit, TriangleHit at, BvhAlpha alpha)
{
    if (!uses(scene, EFFECT_ALPHA)) return 0;
    if (uses(scene, EFFECT_PROCEDURAL_ALPHA) && !bvh_is_behind(hit, alpha.passed)) return 1;
    const int material = ROW_AT(scene, triangles, hit.triangle).material;
    if (scene->materials[material].alpha_mode == ALPHA_OPAQUE) return 0;
    return !alpha_accepts(scene, hit.instance, hit.triangle, at.u, at.v, alpha.seed);
}

// Whether a hit is the end of the search for any.
SHARED int bvh_is_decided(const Scene* scene, Hit hit)
{
    if (hit.triangle < 0) return 0;
    return !uses(scene, EFFECT_PROCEDURAL_ALPHA) || !alpha_is_asked(scene, hit.triangle);
}

// The nearest of `best` and the triangles of a leaf.
SHARED Hit bvh_leaf(const Scene* scene, const BvhRay* ray, int leaf, Hit best, int instance,
                    BvhAlpha alpha)
{
    const int first = BVH_LEAF_FIRST(leaf);
    const int count = BVH_LEAF_COUNT(leaf);
    for (int k = 0; k < count; ++k) {
        const int id = ROW_AT(scene, bvh_items, first + k);
        const STORED(Triangle) triangle = ROW_AT(scene, triangles, id);
        const TriangleHit at =
            triangle_intersect(ray->triangle, vertex_position(scene, triangle.vertex0),
                               vertex_position(scene, triangle.vertex1),
                               vertex_position(scene, triangle.vertex2), best.t);
        const int is_first =
            (instance < best.instance) | ((instance == best.instance) & (id < best.triangle));
        const int is_nearer = (at.t < best.t) | (best.triangle < 0) | is_first;
        const Hit hit = {at.t, id, instance};
        if (at.is_hit & is_nearer && !bvh_is_transparent(scene, hit, at, alpha)) best = hit;
    }
    return best;
}

// How the walk goes on where both, one or none of a node's children are hit.
typedef struct {
    int next;   // a node, a leaf, or BVH_NONE
    int later;  // likewise
    float later_entry;
} BvhStep;

SHARED BvhStep bvh_visit(const Scene* scene, const BvhRay* ray, int node, float t_max)
{
    const float entry0 = bvh_child_entry(scene, ray, node, 0, t_max);
    const float entry1 = bvh_child_entry(scene, ray, node, 1, t_max);
    const int child0 = entry0 >= 0.0f ? ROW_AT(scene, bvh_nodes, node).child[0] : BVH_NONE;
    const int child1 = entry1 >= 0.0f ? ROW_AT(scene, bvh_nodes, node).child[1] : BVH_NONE;
    const int is_swapped = child0 == BVH_NONE || (child1 != BVH_NONE && entry1 < entry0);
    BvhStep step;
    step.next = is_swapped ? child1 : child0;
    step.later = is_swapped ? child0 : child1;
    step.later_entry = is_swapped ? entry0 : entry1;
    return step;
}

// Instead of a base: the walk is in the top level.
#define BVH_TOP_LEVEL (-1)

// The builder bounds the depth of the trees, and with it the stack: a level leaves at most one
// entry. `is_any`: the first hit found will do, unless a texture has to be asked about it: then the
// nearest such, which may hide others that need no asking. Since hardly anything then shortens the
// ray, the stack holds no distances: on a GPU it takes half the memory.
SHARED Hit bvh_walk(const Scene* scene, float3 origin, float3 direction, float t_max,
                    BvhAlpha alpha, int is_any)
{
    int stack[BVH_STACK];
    float stack_entry[BVH_STACK];
    int size = 0;
    int base =
        uses(scene, EFFECT_INSTANCES) ? BVH_TOP_LEVEL : 0;  // of the mesh's part of the stack
    int instance = 0;
    BvhRay ray = bvh_ray(origin, direction);
    Hit best = {t_max, -1, -1};
    int next = uses(scene, EFFECT_INSTANCES) ? 0 : ROW_AT(scene, instances, 0).root_node;

    while (next != BVH_NONE) {
        if (next >= 0) {
            const BvhStep step = bvh_visit(scene, &ray, next, best.t);
            next = step.next;
            if (step.later != BVH_NONE) {
                stack[size] = step.later;
                if (!is_any) stack_entry[size] = step.later_entry;
                ++size;
            }
        } else if (base == BVH_TOP_LEVEL) {
            instance = ROW_AT(scene, bvh_items, BVH_LEAF_FIRST(next));
            ray = bvh_object_ray(scene, instance, origin, direction);
            base = size;
            next = ROW_AT(scene, instances, instance).root_node;
        } else {
            best = bvh_leaf(scene, &ray, next, best, instance, alpha);
            next = BVH_NONE;
            if (is_any && bvh_is_decided(scene, best)) size = 0;
        }
        while (next == BVH_NONE && size > 0) {
            if (uses(scene, EFFECT_INSTANCES) && size == base) {
                base = BVH_TOP_LEVEL;
                ray = bvh_ray(origin, direction);
            }
            --size;
            next = is_any || stack_entry[size] <= best.t ? stack[size] : BVH_NONE;
        }
    }
    return best;
}

// The first hit at 0 < t <= t_max. The direction has unit length; the seed decides about surfaces
// with holes (common/alpha.h); those that a texture makes stop it.
SHARED Hit bvh_closest(const Scene* scene, float3 origin, float3 direction, float t_max, uint seed)
{
    return bvh_walk(scene, origin, direction, t_max, bvh_alpha(seed), 0);
}

// Whether anything lies between the origin and t_max.
SHARED int bvh_occluded(const Scene* scene, float3 origin, float3 direction, float t_max, uint seed)
{
    return bvh_walk(scene, origin, direction, t_max, bvh_alpha(seed), 1).triangle >= 0;
}

// Of a ray that goes on behind its record; from the start in the first round.
SHARED BvhAlpha bvh_alpha_of(const Paths* paths, int i, uint seed)
{
    BvhAlpha alpha = bvh_alpha(seed);
    if (paths->lookup != LOOKUP_SURFACE) {
        alpha.passed.t = get_record_distance(paths, 0, i);
        alpha.passed.instance = get_record_instance(paths, 0, i);
        alpha.passed.triangle = get_record_triangle(paths, 0, i);
    }
    return alpha;
}

// Leaves a record of a hit about which a texture has to be asked.
SHARED void bvh_record(const Scene* scene, const Paths* paths, int i, Hit hit)
{
    const int is_hit = hit.triangle >= 0;
    const int is_asked = is_hit & alpha_is_asked(scene, is_hit ? hit.triangle : 0);
    set_record_triangle(paths, 0, i, is_asked ? hit.triangle : -1);
    set_record_instance(paths, 0, i, hit.instance);
    set_record_distance(paths, 0, i, hit.t);
}

// Whether the ray is to be followed in this round.
SHARED int bvh_is_waiting(const Paths* paths, int i)
{
    return paths->lookup == LOOKUP_SURFACE || get_record_triangle(paths, 0, i) >= 0;
}
