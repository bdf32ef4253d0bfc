// The place that a path has met, as textures see it: before any normal map, in object space where
// they ask for it.
#pragma once

#include "common/surface.h"

// Texture coordinates of a stored set; (0, 0) where the scene has none.
SHARED float2 surface_uv_of_set(const Scene* scene, int triangle, float2 weights, int set)
{
    const int sets = scene->settings[0].uv_set_count;
    const int s = set < 0 ? 0 : set;
    const float known = set < 0 ? 0.0f : 1.0f;
    const int a = ROW_AT(scene, triangles, triangle).vertex0 * sets + s;
    const int b = ROW_AT(scene, triangles, triangle).vertex1 * sets + s;
    const int c = ROW_AT(scene, triangles, triangle).vertex2 * sets + s;
    return make_float2(interpolate(ROW_AT(scene, uvs, a).x, ROW_AT(scene, uvs, b).x,
                                   ROW_AT(scene, uvs, c).x, weights) *
                           known,
                       interpolate(ROW_AT(scene, uvs, a).y, ROW_AT(scene, uvs, b).y,
                                   ROW_AT(scene, uvs, c).y, weights) *
                           known);
}

// Where a path's ray has met the surface.
typedef struct {
    int triangle;
    int instance;
    float2 weights;
    float3 position;
    float3 face_normal;  // outside of the surface
    float3 normal;       // interpolated, likewise
    float error;         // of the position
    int is_front;
} TexturePlace;

// The same numbers as evaluate_surface computes, before normal maps.
SHARED TexturePlace texture_place(const Scene* scene, const Paths* paths, int i)
{
    const float3 origin = get_ray_origin(paths, i);
    const float3 direction = get_ray_direction(paths, i);
    const int hit = get_hit_triangle(paths, i);
    TexturePlace place;
    place.triangle = hit < 0 ? 0 : hit;
    place.instance = hit < 0 ? 0 : get_hit_instance(paths, i);
    const WorldTriangle world = world_triangle(scene, place.instance, place.triangle);
    place.weights = triangle_barycentrics(world, origin, direction);
    place.position = world.corner + world.edge1 * place.weights.x + world.edge2 * place.weights.y;
    place.error = surface_error(world.magnitude);
    const float3 cross = vec_cross(world.edge1, world.edge2);
    const float cross2 = vec_dot(cross, cross);
    float3 outside = cross * (cross2 > 0.0f ? 1.0f / math_sqrt(cross2) : 0.0f);
    if (uses(scene, EFFECT_INSTANCES)) {
        const float sign = ROW_AT(scene, instances, place.instance).is_mirrored ? -1.0f : 1.0f;
        outside = outside * sign;
    }
    place.face_normal = outside;
    place.normal = outside;
    if (uses(scene, EFFECT_SMOOTH_NORMALS))
        place.normal =
            surface_smooth_normal(scene, place.instance, place.triangle, place.weights, outside);
    place.is_front = vec_dot(outside, direction) <= 0.0f;
    return place;
}

// Tangent of a surface with normal n, and its bitangent: along u and v of the texture coordinates
// where the mesh has tangents, else any frame about the normal.
typedef struct {
    float3 tangent;
    float3 bitangent;
} TextureFrame;

SHARED TextureFrame texture_frame(const Scene* scene, int instance, int triangle, float2 weights,
                                  float3 n)
{
    const float3 raw = surface_tangent(scene, instance, triangle, weights);
    const float3 along = raw - n * vec_dot(n, raw);
    const float length2 = vec_dot(along, along);
    const int is_known = length2 > 0.0f;
    const float inverse = is_known ? 1.0f / math_sqrt(length2) : 0.0f;
    const uint packed = ROW_AT(scene, tangents, ROW_AT(scene, triangles, triangle).vertex0);
    float handedness = (packed & 1u) != 0u ? -1.0f : 1.0f;
    if (uses(scene, EFFECT_INSTANCES))
        handedness = ROW_AT(scene, instances, instance).is_mirrored ? -handedness : handedness;
    const float3 any = frame_tangent(n);
    TextureFrame frame;
    frame.tangent =
        make_float3(is_known ? along.x * inverse : any.x, is_known ? along.y * inverse : any.y,
                    is_known ? along.z * inverse : any.z);
    frame.bitangent = vec_cross(n, frame.tangent) * (is_known ? handedness : 1.0f);
    return frame;
}

// Meshes that appear once lie together in instance 0 and keep their number a triangle.
SHARED int texture_object(const Scene* scene, int instance, int triangle)
{
    const int is_merged = -(instance == 0);
    const int merged = ROW_AT(scene, triangle_objects, triangle & is_merged);
    const int placed = ROW_AT(scene, instances, instance).object;
    return placed ^ ((placed ^ merged) & is_merged);
}

#define OBJECT_FRAME_WORDS 12

// A point of the world in the object's own space. Meshes that appear once lie in world space, so
// that the frames of all objects are kept with the textures that ask for them: three rows each of
// world-to-object.
SHARED float3 object_position(const Scene* scene, int object, float3 p)
{
    const int word = scene->settings[0].object_frames + OBJECT_FRAME_WORDS * object;
    float3 at;
    at.x = as_float(material_word(scene, word)) * p.x +
           as_float(material_word(scene, word + 1)) * p.y +
           as_float(material_word(scene, word + 2)) * p.z +
           as_float(material_word(scene, word + 3));
    at.y = as_float(material_word(scene, word + 4)) * p.x +
           as_float(material_word(scene, word + 5)) * p.y +
           as_float(material_word(scene, word + 6)) * p.z +
           as_float(material_word(scene, word + 7));
    at.z = as_float(material_word(scene, word + 8)) * p.x +
           as_float(material_word(scene, word + 9)) * p.y +
           as_float(material_word(scene, word + 10)) * p.z +
           as_float(material_word(scene, word + 11));
    return at;
}
