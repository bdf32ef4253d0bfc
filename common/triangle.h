// Where a ray meets a triangle, without gaps: along a shared edge both triangles decide by the same
// products, so a ray never slips between them (Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection", JCGT 2(1), 2013). A product pair that rounds to equal counts as inside for both,
// which is what the paper's double-precision fallback is there to refine: rounding is monotonic, so
// the sign of a difference of products is right or zero, never reversed.
#pragma once

#include "platform.h"

#include "common/math.h"

// A ray prepared for any number of triangles: the axis along which it mostly runs, and the shear
// that turns it into that axis.
typedef struct {
    float3 origin;
    float3 shear;  // x, y: of the two other axes; z: 1 / direction along the axis
    int axis;      // 0, 1, 2
} TriangleRay;

typedef struct {
    int is_hit;
    float t;  // in units of the ray's direction
    float u;  // weight of the second corner
    float v;  // weight of the third
} TriangleHit;

// The components in cyclic order such that `axis` comes last. Whole vectors are chosen: choosing
// single components, compilers for GPUs index the vector in memory.
SHARED float3 triangle_axes(float3 v, int axis)
{
    const float3 x_last = make_float3(v.y, v.z, v.x);
    const float3 y_last = make_float3(v.z, v.x, v.y);
    const float3 chosen = axis == 1 ? y_last : v;
    return axis == 0 ? x_last : chosen;
}

// The direction need not have unit length; it must not be zero.
SHARED TriangleRay triangle_ray(float3 origin, float3 direction)
{
    const float x = math_abs(direction.x);
    const float y = math_abs(direction.y);
    const float z = math_abs(direction.z);
    TriangleRay ray;
    ray.origin = origin;
    ray.axis = z >= x && z >= y ? 2 : (y >= x ? 1 : 0);
    const float3 along = triangle_axes(direction, ray.axis);
    ray.shear = make_float3(along.x / along.z, along.y / along.z, 1.0f / along.z);
    return ray;
}

// A corner in the ray's axes, seen from its origin.
SHARED float3 triangle_corner(TriangleRay ray, float3 corner)
{
    return triangle_axes(corner - ray.origin, ray.axis);
}

// x, y: where the corner lies across the ray.
SHARED float2 triangle_across(TriangleRay ray, float3 corner)
{
    return make_float2(corner.x - ray.shear.x * corner.z, corner.y - ray.shear.y * corner.z);
}

// Where the ray meets the plane through three corners, in units of its direction. The weights of
// the corners would give it too, but lose as many digits as the triangle is thin; the cross product
// of the two shortest sides loses none to needles and long strips. What rounding does at grazing
// incidence stays between the corners.
SHARED float triangle_distance(TriangleRay ray, float3 a, float3 b, float3 c)
{
    const float3 side_a = c - b;
    const float3 side_b = a - c;
    const float3 side_c = b - a;
    const float length2_a = vec_dot(side_a, side_a);
    const float length2_b = vec_dot(side_b, side_b);
    const float length2_c = vec_dot(side_c, side_c);
    const int is_longest_a = (length2_a >= length2_b) & (length2_a >= length2_c);
    const int is_longest_b = length2_b >= length2_c;
    const float3 first = select3(is_longest_a, side_b, select3(is_longest_b, side_c, side_a));
    const float3 second = select3(is_longest_a, side_c, select3(is_longest_b, side_a, side_b));
    const float3 between = select3(is_longest_a, a, select3(is_longest_b, b, c));
    const float3 normal = vec_cross(first, second);

    const float along = normal.x * ray.shear.x + normal.y * ray.shear.y + normal.z;
    const float z = vec_dot(normal, between) / along;
    const float nearest = math_lesser(a.z, math_lesser(b.z, c.z));
    const float farthest = math_greater(a.z, math_greater(b.z, c.z));
    return ray.shear.z * math_clamp(z, nearest, farthest);
}

// Meets both sides of the triangle, its edges included, for 0 < t <= t_max.
SHARED TriangleHit triangle_intersect(TriangleRay ray, float3 p0, float3 p1, float3 p2, float t_max)
{
    const float3 corner0 = triangle_corner(ray, p0);
    const float3 corner1 = triangle_corner(ray, p1);
    const float3 corner2 = triangle_corner(ray, p2);
    const float2 a = triangle_across(ray, corner0);
    const float2 b = triangle_across(ray, corner1);
    const float2 c = triangle_across(ray, corner2);
    const float weight0 = c.x * b.y - c.y * b.x;
    const float weight1 = a.x * c.y - a.y * c.x;
    const float weight2 = b.x * a.y - b.y * a.x;
    const float sum = weight0 + weight1 + weight2;
    const int is_front = (weight0 >= 0.0f) & (weight1 >= 0.0f) & (weight2 >= 0.0f);
    const int is_back = (weight0 <= 0.0f) & (weight1 <= 0.0f) & (weight2 <= 0.0f);

    TriangleHit hit = {0, 0.0f, 0.0f, 0.0f};
    if ((is_front | is_back) & (sum != 0.0f)) {
        const float inverse = 1.0f / sum;
        hit.t = triangle_distance(ray, corner0, corner1, corner2);
        hit.u = weight1 * inverse;
        hit.v = weight2 * inverse;
        hit.is_hit = (hit.t > 0.0f) & (hit.t <= t_max);
    }
    return hit;
}
