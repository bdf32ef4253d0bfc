// Geometry under a hit: corners, normals, texture coordinates, in world space.
#pragma once

#include "platform.h"

#include "common/buffers.h"
#include "common/effects.h"
#include "common/math.h"
#include "common/textures/texture.h"

typedef struct {
    float3 corner;  // world space
    float3 edge1;
    float3 edge2;
    float magnitude;  // largest coordinate that went into the corners: rounding errors are
                      // proportional to it
} WorldTriangle;

SHARED float3 point_to_world(const Scene* scene, int instance, float3 p)
{
    return make_float3(ROW_AT(scene, instances, instance).to_world_x.x * p.x +
                           ROW_AT(scene, instances, instance).to_world_x.y * p.y +
                           ROW_AT(scene, instances, instance).to_world_x.z * p.z +
                           ROW_AT(scene, instances, instance).to_world_x.w,
                       ROW_AT(scene, instances, instance).to_world_y.x * p.x +
                           ROW_AT(scene, instances, instance).to_world_y.y * p.y +
                           ROW_AT(scene, instances, instance).to_world_y.z * p.z +
                           ROW_AT(scene, instances, instance).to_world_y.w,
                       ROW_AT(scene, instances, instance).to_world_z.x * p.x +
                           ROW_AT(scene, instances, instance).to_world_z.y * p.y +
                           ROW_AT(scene, instances, instance).to_world_z.z * p.z +
                           ROW_AT(scene, instances, instance).to_world_z.w);
}

SHARED float3 vector_to_world(const Scene* scene, int instance, float3 v)
{
    return make_float3(ROW_AT(scene, instances, instance).to_world_x.x * v.x +
                           ROW_AT(scene, instances, instance).to_world_x.y * v.y +
                           ROW_AT(scene, instances, instance).to_world_x.z * v.z,
                       ROW_AT(scene, instances, instance).to_world_y.x * v.x +
                           ROW_AT(scene, instances, instance).to_world_y.y * v.y +
                           ROW_AT(scene, instances, instance).to_world_y.z * v.z,
                       ROW_AT(scene, instances, instance).to_world_z.x * v.x +
                           ROW_AT(scene, instances, instance).to_world_z.y * v.y +
                           ROW_AT(scene, instances, instance).to_world_z.z * v.z);
}

// Normals go by the transpose of the inverse; not of unit length any more.
SHARED float3 normal_to_world(const Scene* scene, int instance, float3 n)
{
    return make_float3(ROW_AT(scene, instances, instance).to_object_x.x * n.x +
                           ROW_AT(scene, instances, instance).to_object_y.x * n.y +
                           ROW_AT(scene, instances, instance).to_object_z.x * n.z,
                       ROW_AT(scene, instances, instance).to_object_x.y * n.x +
                           ROW_AT(scene, instances, instance).to_object_y.y * n.y +
                           ROW_AT(scene, instances, instance).to_object_z.y * n.z,
                       ROW_AT(scene, instances, instance).to_object_x.z * n.x +
                           ROW_AT(scene, instances, instance).to_object_y.z * n.y +
                           ROW_AT(scene, instances, instance).to_object_z.z * n.z);
}

SHARED float3 vertex_position(const Scene* scene, int vertex)
{
    return make_float3(ROW_AT(scene, positions, vertex).x, ROW_AT(scene, positions, vertex).y,
                       ROW_AT(scene, positions, vertex).z);
}

SHARED WorldTriangle world_triangle(const Scene* scene, int instance, int triangle)
{
    float3 a = vertex_position(scene, ROW_AT(scene, triangles, triangle).vertex0);
    float3 b = vertex_position(scene, ROW_AT(scene, triangles, triangle).vertex1);
    float3 c = vertex_position(scene, ROW_AT(scene, triangles, triangle).vertex2);
    float translation = 0.0f;
    if (uses(scene, EFFECT_INSTANCES)) {
        a = point_to_world(scene, instance, a);
        b = point_to_world(scene, instance, b);
        c = point_to_world(scene, instance, c);
        const float x = math_abs(ROW_AT(scene, instances, instance).to_world_x.w);
        const float y = math_abs(ROW_AT(scene, instances, instance).to_world_y.w);
        const float z = math_abs(ROW_AT(scene, instances, instance).to_world_z.w);
        translation = vec_max_component(make_float3(x, y, z));
    }
    WorldTriangle world;
    world.corner = a;
    world.edge1 = b - a;
    world.edge2 = c - a;
    const float largest =
        vec_max_component(make_float3(vec_max_component(vec_abs(a)), vec_max_component(vec_abs(b)),
                                      vec_max_component(vec_abs(c))));
    world.magnitude = translation > largest ? translation : largest;
    return world;
}

// By how far a computed point on the triangle may miss its plane; a ray that starts this far off it
// does not meet it again. Three roundings of interpolation (Pharr et al., "Physically Based
// Rendering", 4th ed., 6.8.4) and the intersector's own.
SHARED float surface_error(float magnitude) { return magnitude * (4.0f * 1.1920929e-7f); }

// A new ray's origin: off the surface, to the side of `direction`.
SHARED float3 offset_origin(float3 position, float3 face_normal, float error, float3 direction)
{
    const float distance = vec_dot(face_normal, direction) < 0.0f ? -error : error;
    return position + face_normal * distance;
}

// Barycentric weights of the second and third corner where a ray meets the triangle's plane,
// brought inside the triangle. Moeller and Trumbore 1997.
SHARED float2 triangle_barycentrics(WorldTriangle t, float3 origin, float3 direction)
{
    const float3 p = vec_cross(direction, t.edge2);
    const float determinant = vec_dot(t.edge1, p);
    const float inverse = determinant == 0.0f ? 0.0f : 1.0f / determinant;
    const float3 s = origin - t.corner;
    const float u = math_greater(0.0f, vec_dot(s, p) * inverse);
    const float v = math_greater(0.0f, vec_dot(direction, vec_cross(s, t.edge1)) * inverse);
    const float sum = u + v;
    const float scale = sum > 1.0f ? 1.0f / sum : 1.0f;
    return make_float2(math_lesser(u * scale, 1.0f), math_lesser(v * scale, 1.0f));
}

// Interpolates between three corners' values with the weights of the second and third; where all
// three are the same, gives exactly that.
SHARED float interpolate(float a, float b, float c, float2 weights)
{
    return a + (b - a) * weights.x + (c - a) * weights.y;
}

SHARED float2 surface_uv(const Scene* scene, int triangle, float2 weights, int slot)
{
    const int set = scene->texture_slots[slot < 0 ? 0 : slot].uv_set;
    const int sets = scene->settings[0].uv_set_count;
    const int a = ROW_AT(scene, triangles, triangle).vertex0 * sets + set;
    const int b = ROW_AT(scene, triangles, triangle).vertex1 * sets + set;
    const int c = ROW_AT(scene, triangles, triangle).vertex2 * sets + set;
    return make_float2(interpolate(ROW_AT(scene, uvs, a).x, ROW_AT(scene, uvs, b).x,
                                   ROW_AT(scene, uvs, c).x, weights),
                       interpolate(ROW_AT(scene, uvs, a).y, ROW_AT(scene, uvs, b).y,
                                   ROW_AT(scene, uvs, c).y, weights));
}

SHARED float4 surface_texture(const Scene* scene, int triangle, float2 weights, int slot)
{
    return texture_read(scene, slot, surface_uv(scene, triangle, weights, slot));
}

SHARED float4 surface_vertex_color(const Scene* scene, int triangle, float2 weights)
{
    const int a = ROW_AT(scene, triangles, triangle).vertex0;
    const int b = ROW_AT(scene, triangles, triangle).vertex1;
    const int c = ROW_AT(scene, triangles, triangle).vertex2;
    return make_float4(interpolate(ROW_AT(scene, colors, a).x, ROW_AT(scene, colors, b).x,
                                   ROW_AT(scene, colors, c).x, weights),
                       interpolate(ROW_AT(scene, colors, a).y, ROW_AT(scene, colors, b).y,
                                   ROW_AT(scene, colors, c).y, weights),
                       interpolate(ROW_AT(scene, colors, a).z, ROW_AT(scene, colors, b).z,
                                   ROW_AT(scene, colors, c).z, weights),
                       interpolate(ROW_AT(scene, colors, a).w, ROW_AT(scene, colors, b).w,
                                   ROW_AT(scene, colors, c).w, weights));
}

// Base colour and alpha: factor, texture and vertex colour multiplied (glTF 2.0, 3.9.2); `texel` is
// what the texture gives.
SHARED float4 surface_colored(const Scene* scene, int triangle, float2 weights, float4 texel)
{
    const int material = ROW_AT(scene, triangles, triangle).material;
    const float4 factor = make_float4(
        scene->materials[material].base_color.x, scene->materials[material].base_color.y,
        scene->materials[material].base_color.z, scene->materials[material].base_color.w);
    float4 color = factor * texel;
    if (uses(scene, EFFECT_VERTEX_COLOR))
        color = color * surface_vertex_color(scene, triangle, weights);
    return color;
}

SHARED float4 surface_base_color(const Scene* scene, int triangle, float2 weights)
{
    float4 texel = make_float4(1.0f, 1.0f, 1.0f, 1.0f);
    if (uses(scene, EFFECT_BASE_TEXTURE)) {
        const int material = ROW_AT(scene, triangles, triangle).material;
        const int slot = scene->materials[material].base_slot;
        texel = surface_texture(scene, triangle, weights, slot);
    }
    return surface_colored(scene, triangle, weights, texel);
}

SHARED float3 vertex_normal(const Scene* scene, int vertex, float3 otherwise)
{
    const uint packed = ROW_AT(scene, normals, vertex);
    const float3 normal = normal_unpack(packed);
    const int is_flat = packed == NORMAL_FLAT;
    return make_float3(is_flat ? otherwise.x : normal.x, is_flat ? otherwise.y : normal.y,
                       is_flat ? otherwise.z : normal.z);
}

// Interpolated vertex normal in world space, outside of the surface; the face's where the mesh has
// none.
SHARED float3 surface_smooth_normal(const Scene* scene, int instance, int triangle, float2 weights,
                                    float3 face_normal)
{
    const float3 zero = make_float3(0.0f, 0.0f, 0.0f);
    const float3 a = vertex_normal(scene, ROW_AT(scene, triangles, triangle).vertex0, zero);
    const float3 b = vertex_normal(scene, ROW_AT(scene, triangles, triangle).vertex1, zero);
    const float3 c = vertex_normal(scene, ROW_AT(scene, triangles, triangle).vertex2, zero);
    float3 n = make_float3(interpolate(a.x, b.x, c.x, weights), interpolate(a.y, b.y, c.y, weights),
                           interpolate(a.z, b.z, c.z, weights));
    if (uses(scene, EFFECT_INSTANCES)) n = normal_to_world(scene, instance, n);
    const float length2 = vec_dot(n, n);
    const float scale = length2 > 0.0f ? 1.0f / math_sqrt(length2) : 0.0f;
    const int is_usable = length2 > 0.0f;
    return make_float3(is_usable ? n.x * scale : face_normal.x,
                       is_usable ? n.y * scale : face_normal.y,
                       is_usable ? n.z * scale : face_normal.z);
}

// The low bit of a packed tangent is its handedness in its mesh's own space: 1 for -1.
SHARED float3 surface_tangent(const Scene* scene, int instance, int triangle, float2 weights)
{
    const float3 a =
        normal_unpack(ROW_AT(scene, tangents, ROW_AT(scene, triangles, triangle).vertex0));
    const float3 b =
        normal_unpack(ROW_AT(scene, tangents, ROW_AT(scene, triangles, triangle).vertex1));
    const float3 c =
        normal_unpack(ROW_AT(scene, tangents, ROW_AT(scene, triangles, triangle).vertex2));
    const float3 t =
        make_float3(interpolate(a.x, b.x, c.x, weights), interpolate(a.y, b.y, c.y, weights),
                    interpolate(a.z, b.z, c.z, weights));
    return uses(scene, EFFECT_INSTANCES) ? vector_to_world(scene, instance, t) : t;
}

// The normal with a normal map's texel applied; n of unit length, outside.
SHARED float3 surface_mapped_normal(const Scene* scene, int instance, int triangle, float2 weights,
                                    float3 n, float4 texel)
{
    const int material = ROW_AT(scene, triangles, triangle).material;
    const int slot = scene->materials[material].normal_slot;
    const float scale = scene->materials[material].normal_scale;
    const float x = (2.0f * texel.x - 1.0f) * scale;
    const float y = (2.0f * texel.y - 1.0f) * scale;
    const float z = 2.0f * texel.z - 1.0f;

    const float3 raw = surface_tangent(scene, instance, triangle, weights);
    const float3 t = raw - n * vec_dot(n, raw);
    const float t_length2 = vec_dot(t, t);
    const uint packed = ROW_AT(scene, tangents, ROW_AT(scene, triangles, triangle).vertex0);
    float handedness = (packed & 1u) != 0u ? -1.0f : 1.0f;
    if (uses(scene, EFFECT_INSTANCES))  // a mirror image of a right-handed frame is left-handed
        handedness = ROW_AT(scene, instances, instance).is_mirrored ? -handedness : handedness;
    const float3 tangent = t * (t_length2 > 0.0f ? 1.0f / math_sqrt(t_length2) : 0.0f);
    const float3 bitangent = vec_cross(n, tangent) * handedness;

    const float3 mapped = tangent * x + bitangent * y + n * z;
    const float length2 = vec_dot(mapped, mapped);
    const int is_usable = (slot != -1) & (length2 > 1e-12f) & (t_length2 > 0.0f);
    const float inverse = is_usable ? 1.0f / math_sqrt(length2) : 0.0f;
    return make_float3(is_usable ? mapped.x * inverse : n.x, is_usable ? mapped.y * inverse : n.y,
                       is_usable ? mapped.z * inverse : n.z);
}

// A shading normal that looks away from the viewer, as interpolation and normal maps make them at
// silhouettes, is bent back until it does not; `view` points to the viewer.
SHARED float3 normal_facing(float3 n, float3 view)
{
    const float least = 1e-3f;
    const float cosine = vec_dot(n, view);
    const float bend = cosine < least ? least - cosine : 0.0f;
    return vec_normalize(n + view * bend);
}

// A shading normal that sends the mirror direction below the face is bent until that direction lies
// just above, so that a mirror loses no light (Keller et al., "The Iray Light Transport Simulation
// and Rendering System", 2017, appendix A.3, local shading normal adaption). Unit vectors; `face`
// and `view` are on one side.
SHARED float3 normal_mirroring(float3 n, float3 face, float3 view)
{
    const float least = math_lesser(0.9f * vec_dot(face, view), 0.01f);
    const float3 mirrored = vec_reflect(view, n);
    const float height = vec_dot(face, mirrored);
    const float lift = height < least ? least - height : 0.0f;
    const float3 halfway = vec_normalize(view + vec_normalize(mirrored + face * lift));
    return select3(lift > 0.0f, halfway, n);
}
