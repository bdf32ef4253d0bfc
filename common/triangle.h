// Where a ray meets a triangle, without gaps: along a shared edge both triangles decide by the same
// products, so a ray never slips between them (Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection", JCGT 2(1), 2013). A product pair that rounds to equal counts as inside for both,
// which is what the paper's double-precision fallback is there to refine: rounding is monotonic, so
// the sign of a difference of products is right or zero, never reversed.
#pragma once

#include "platform.h"

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

// A corner as the ray sees it: x, y across it, z in units of t along it.
SHARED float3 triangle_corner(TriangleRay ray, float3 corner)
{
    const float3 v = triangle_axes(corner - ray.origin, ray.axis);
    return make_float3(v.x - ray.shear.x * v.z, v.y - ray.shear.y * v.z, ray.shear.z * v.z);
}

// Meets both sides of the triangle, its edges included, for 0 < t <= t_max.
SHARED TriangleHit triangle_intersect(TriangleRay ray, float3 p0, float3 p1, float3 p2, float t_max)
{
    const float3 a = triangle_corner(ray, p0);
    const float3 b = triangle_corner(ray, p1);
    const float3 c = triangle_corner(ray, p2);
    const float weight0 = c.x * b.y - c.y * b.x;
    const float weight1 = a.x * c.y - a.y * c.x;
    const float weight2 = b.x * a.y - b.y * a.x;
    const float sum = weight0 + weight1 + weight2;
    const int is_front = (weight0 >= 0.0f) & (weight1 >= 0.0f) & (weight2 >= 0.0f);
    const int is_back = (weight0 <= 0.0f) & (weight1 <= 0.0f) & (weight2 <= 0.0f);
    const int is_inside = (is_front | is_back) & (sum != 0.0f);

    const float inverse = 1.0f / (is_inside ? sum : 1.0f);
    TriangleHit hit;
    hit.t = (weight0 * a.z + weight1 * b.z + weight2 * c.z) * inverse;
    hit.u = weight1 * inverse;
    hit.v = weight2 * inverse;
    hit.is_hit = is_inside & (hit.t > 0.0f) & (hit.t <= t_max);
    return hit;
}
