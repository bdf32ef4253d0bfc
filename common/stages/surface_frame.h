// The surface at the end of a path, read from its planes, and its local frame.
#pragma once

#include "common/materials/metallic_roughness.h"
#include "common/stages/evaluate_surface.h"

typedef struct {
    float3 tangent;
    float3 bitangent;
    float3 normal;
} Frame;

SHARED Frame frame_of(float3 normal)
{
    Frame frame;
    frame.tangent = frame_tangent(normal);
    frame.bitangent = frame_bitangent(normal);
    frame.normal = normal;
    return frame;
}

SHARED float3 to_frame(Frame f, float3 v)
{
    return make_float3(vec_dot(f.tangent, v), vec_dot(f.bitangent, v), vec_dot(f.normal, v));
}

SHARED float3 from_frame(Frame f, float3 v)
{
    return f.tangent * v.x + f.bitangent * v.y + f.normal * v.z;
}

SHARED Surface surface_of_path(const Paths* paths, int i)
{
    Surface surface;
    surface.base_color = get_base_color(paths, i);
    surface.metallic = get_metallic(paths, i);
    surface.roughness = get_roughness(paths, i);
    surface.dielectric_f0 = get_dielectric_f0(paths, i);
    surface.dielectric_f90 = get_dielectric_f90(paths, i);
    return surface;
}
