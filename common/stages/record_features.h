// What the camera sees first, for the layers beside the picture: colour, normal, distance, ids.
#pragma once

#include "common/stages/evaluate_surface.h"

SHARED void record_features(const Scene* scene, const Paths* paths, int i)
{
    const int kind = get_surface_kind(paths, i);
    const int is_hit = kind != SURFACE_NONE;
    const int triangle = get_hit_triangle(paths, i);
    const int material = ROW_AT(scene, triangles, triangle & -is_hit).material;
    // Meshes that appear once lie together in instance 0, which therefore keeps a number a
    // triangle. Masks, not selects: a select would make the loads conditional.
    const int instance = get_hit_instance(paths, i) & -is_hit;
    const int is_merged = -(is_hit & (instance == 0));
    const int merged = ROW_AT(scene, triangle_objects, triangle & is_merged);
    const int placed = ROW_AT(scene, instances, instance).object;
    const int object = placed ^ ((placed ^ merged) & is_merged);
    const float3 none = make_float3(0.0f, 0.0f, 0.0f);
    const float3 towards = get_position(paths, i) - get_ray_origin(paths, i);
    set_first_albedo(paths, i, select3(is_hit, get_base_color(paths, i), none));
    set_first_normal(paths, i, select3(is_hit, get_normal(paths, i), none));
    set_first_distance(paths, i, is_hit ? vec_length(towards) : 0.0f);
    set_first_object(paths, i, object | (is_hit - 1));
    set_first_material(paths, i, is_hit ? material : -1);
}
