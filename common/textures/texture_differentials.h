// How texture coordinates change from a pixel to its neighbours, at what the camera sees first: the
// neighbour's ray, with the same offset inside its pixel, meets the plane of the triangle (Igehy,
// "Tracing Ray Differentials", 1999, without the linearisation). After a scattering nothing is
// known, and the change is zero.
#pragma once

#include "common/effects.h"
#include "common/textures/texture_place.h"

typedef struct {
    float2 dx;  // to the pixel on the right
    float2 dy;  // to the pixel below
} TextureDifferentials;

// How the place moves in its plane with normal n when its ray does: `step` is added to the origin
// where rays are parallel, else to the direction at unit depth. Zero where the moved ray misses.
SHARED float3 shift_on_plane(float3 origin, float3 along, float3 step, int is_parallel,
                             float3 place, float3 n)
{
    const float parallel = is_parallel ? 1.0f : 0.0f;
    const float3 from = origin + step * parallel;
    const float3 towards = along + step * (1.0f - parallel);
    const float cosine = vec_dot(n, towards);
    const float distance = vec_dot(n, place - from);
    const float t = distance / (cosine != 0.0f ? cosine : 1.0f);
    const int is_met = (cosine != 0.0f) & (t > 0.0f);
    const float3 moved = from + towards * t - place;
    return make_float3(is_met ? moved.x : 0.0f, is_met ? moved.y : 0.0f, is_met ? moved.z : 0.0f);
}

// The texture coordinates' change over `shift` in the triangle's plane.
SHARED float2 uv_change(WorldTriangle world, float2 along1, float2 along2, float3 shift)
{
    const float g11 = vec_dot(world.edge1, world.edge1);
    const float g12 = vec_dot(world.edge1, world.edge2);
    const float g22 = vec_dot(world.edge2, world.edge2);
    const float r1 = vec_dot(world.edge1, shift);
    const float r2 = vec_dot(world.edge2, shift);
    const float determinant = g11 * g22 - g12 * g12;
    const float inverse = determinant > 0.0f ? 1.0f / determinant : 0.0f;
    const float a = (r1 * g22 - r2 * g12) * inverse;
    const float b = (r2 * g11 - r1 * g12) * inverse;
    return make_float2(a * along1.x + b * along2.x, a * along1.y + b * along2.y);
}

SHARED TextureDifferentials texture_differentials(const Scene* scene, const Paths* paths, int i,
                                                  TexturePlace place, int set)
{
    const WorldTriangle world = world_triangle(scene, place.instance, place.triangle);
    const float2 corner = surface_uv_of_set(scene, place.triangle, make_float2(0.0f, 0.0f), set);
    const float2 second = surface_uv_of_set(scene, place.triangle, make_float2(1.0f, 0.0f), set);
    const float2 third = surface_uv_of_set(scene, place.triangle, make_float2(0.0f, 1.0f), set);
    const float2 along1 = make_float2(second.x - corner.x, second.y - corner.y);
    const float2 along2 = make_float2(third.x - corner.x, third.y - corner.y);

    int is_parallel = 0;
    if (uses(scene, EFFECT_ORTHOGRAPHIC))
        is_parallel = scene->settings[0].camera_kind == CAMERA_ORTHOGRAPHIC;
    const float3 direction = get_ray_direction(paths, i);
    const float depth = vec_dot(direction, xyz(scene->settings[0].camera_forward));
    const float3 along = direction * (1.0f / (depth > 0.0f ? depth : 1.0f));
    const float3 right =
        xyz(scene->settings[0].camera_right) * (2.0f / (float)scene->settings[0].width);
    const float3 down =
        xyz(scene->settings[0].camera_up) * (-2.0f / (float)scene->settings[0].height);
    const float3 origin = get_ray_origin(paths, i);
    const float3 dx =
        shift_on_plane(origin, along, right, is_parallel, place.position, place.face_normal);
    const float3 dy =
        shift_on_plane(origin, along, down, is_parallel, place.position, place.face_normal);
    const int lookup = LOOKUP_PLACE(paths->lookup);
    const int is_of_camera =
        (get_depth(paths, i) == 0) &
        ((lookup == LOOKUP_SURFACE) | (lookup == LOOKUP_ALPHA) | (lookup == LOOKUP_AOV));
    const int is_known = is_of_camera & (depth > 0.0f);
    const float known = is_known ? 1.0f : 0.0f;
    TextureDifferentials change;
    change.dx = uv_change(world, along1, along2, dx * known);
    change.dy = uv_change(world, along1, along2, dy * known);
    return change;
}
