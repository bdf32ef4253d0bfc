// What the ray met: where exactly, which way the surface faces, and its material there. Position
// and barycentrics are computed here from the triangle that intersection named, so that they are
// the same numbers whoever found it.
#pragma once

#include "common/surface.h"

// Reflectance at normal incidence of the dielectric interface (KHR_materials_specular,
// KHR_materials_ior).
SHARED float3 surface_dielectric_f0(const Scene* scene, int material, float4 specular_color)
{
    const float f0 = scene->materials[material].dielectric_f0;
    const float weight = specular_color.w;
    return make_float3(math_lesser(f0 * specular_color.x, 1.0f) * weight,
                       math_lesser(f0 * specular_color.y, 1.0f) * weight,
                       math_lesser(f0 * specular_color.z, 1.0f) * weight);
}

// What a slot of the material reads where path i met it: of an image (if `reads_images`, a
// constant), of the texture stage, or white. `which`: SLOT_*.
SHARED float4 surface_slot(const Scene* scene, const Paths* paths, int i, float2 weights, int slot,
                           int which, int reads_images)
{
    const int hit = get_hit_triangle(paths, i);
    float4 texel = make_float4(1.0f, 1.0f, 1.0f, 1.0f);
    if (reads_images) texel = surface_texture(scene, hit < 0 ? 0 : hit, weights, slot);
    if (uses(scene, EFFECT_PROCEDURAL)) {
        const int output = scene->settings[0].texture_output[which];
        const int plane = output < 0 ? 0 : 4 * output;
        const float r = get_texture_result(paths, plane, i);
        const float g = get_texture_result(paths, plane + 1, i);
        const float b = get_texture_result(paths, plane + 2, i);
        const float a = get_texture_result(paths, plane + 3, i);
        const int is_procedural = (slot == TEXTURE_PROCEDURAL) & (hit >= 0);
        texel = make_float4(is_procedural ? r : texel.x, is_procedural ? g : texel.y,
                            is_procedural ? b : texel.z, is_procedural ? a : texel.w);
    }
    return texel;
}

// Specular colour factor times texture; w: specular factor times the alpha of its texture.
SHARED float4 surface_specular(const Scene* scene, const Paths* paths, int i, int material,
                               float2 weights)
{
    const float4 factor = make_float4(
        scene->materials[material].specular_color.x, scene->materials[material].specular_color.y,
        scene->materials[material].specular_color.z, scene->materials[material].specular_color.w);
    if (!uses(scene, EFFECT_SURFACE_TEXTURES | EFFECT_PROCEDURAL)) return factor;
    const int reads = uses(scene, EFFECT_SURFACE_TEXTURES);
    const float4 strength = surface_slot(
        scene, paths, i, weights, scene->materials[material].specular_slot, SLOT_SPECULAR, reads);
    const float4 color =
        surface_slot(scene, paths, i, weights, scene->materials[material].specular_color_slot,
                     SLOT_SPECULAR_COLOR, reads);
    return make_float4(factor.x * color.x, factor.y * color.y, factor.z * color.z,
                       factor.w * strength.w);
}

// x: metallic, y: roughness.
SHARED float2 surface_metallic_roughness(const Scene* scene, const Paths* paths, int i,
                                         int material, float2 weights)
{
    const float2 factor =
        make_float2(scene->materials[material].metallic, scene->materials[material].roughness);
    if (!uses(scene, EFFECT_SURFACE_TEXTURES | EFFECT_PROCEDURAL)) return factor;
    const float4 texel =
        surface_slot(scene, paths, i, weights, scene->materials[material].metallic_roughness_slot,
                     SLOT_METALLIC_ROUGHNESS, uses(scene, EFFECT_SURFACE_TEXTURES));
    return make_float2(factor.x * texel.z, factor.y * texel.y);
}

SHARED float3 surface_emission(const Scene* scene, const Paths* paths, int i, int material,
                               float2 weights)
{
    const float3 factor =
        make_float3(scene->materials[material].emission.x, scene->materials[material].emission.y,
                    scene->materials[material].emission.z);
    if (!uses(scene, EFFECT_EMISSION_TEXTURE | EFFECT_PROCEDURAL)) return factor;
    const float4 texel =
        surface_slot(scene, paths, i, weights, scene->materials[material].emission_slot,
                     SLOT_EMISSION, uses(scene, EFFECT_EMISSION_TEXTURE));
    return factor * xyz(texel);
}

SHARED void evaluate_surface_missed(const Scene* scene, const Paths* paths, int i)
{
    (void)scene;
    set_surface_kind(paths, i, SURFACE_NONE);
}

SHARED void evaluate_surface(const Scene* scene, const Paths* paths, int i)
{
    const float3 origin = get_ray_origin(paths, i);
    const float3 direction = get_ray_direction(paths, i);
    const int hit = get_hit_triangle(paths, i);
    const int is_hit = hit >= 0;
    const int triangle = is_hit ? hit : 0;
    const int instance = is_hit ? get_hit_instance(paths, i) : 0;
    const int material = ROW_AT(scene, triangles, triangle).material;

    const WorldTriangle world = world_triangle(scene, instance, triangle);
    const float2 weights = triangle_barycentrics(world, origin, direction);
    const float3 position = world.corner + world.edge1 * weights.x + world.edge2 * weights.y;
    const float3 towards = position - origin;
    const float distance2 = vec_dot(towards, towards);

    const float3 cross = vec_cross(world.edge1, world.edge2);
    const float cross2 = vec_dot(cross, cross);
    float3 outside = cross * (cross2 > 0.0f ? 1.0f / math_sqrt(cross2) : 0.0f);
    if (uses(scene, EFFECT_INSTANCES)) {
        const int is_mirrored = ROW_AT(scene, instances, instance).is_mirrored;
        outside = select3(is_mirrored, -outside, outside);
    }
    const float3 view = -direction;
    const float cosine = vec_dot(outside, view);
    const int is_front = cosine >= 0.0f;

    float3 normal = outside;
    if (uses(scene, EFFECT_SMOOTH_NORMALS))
        normal = surface_smooth_normal(scene, instance, triangle, weights, outside);
    if (uses(scene, EFFECT_NORMAL_MAP)) {
        const float4 texel = surface_slot(scene, paths, i, weights,
                                          scene->materials[material].normal_slot, SLOT_NORMAL, 1);
        normal = surface_mapped_normal(scene, instance, triangle, weights, normal, texel);
    }
    normal = select3(is_front, normal, -normal);
    const float3 face_normal = select3(is_front, outside, -outside);
    if (uses(scene, EFFECT_SMOOTH_NORMALS | EFFECT_NORMAL_MAP)) {
        // what is flat stays so to the bit, as in scenes that have no other normals
        const int is_flat =
            (normal.x == face_normal.x) & (normal.y == face_normal.y) & (normal.z == face_normal.z);
        const float3 bent = normal_mirroring(normal_facing(normal, view), face_normal, view);
        normal = select3(is_flat, face_normal, bent);
    }

    const float4 base_texel =
        surface_slot(scene, paths, i, weights, scene->materials[material].base_slot, SLOT_BASE,
                     uses(scene, EFFECT_BASE_TEXTURE));
    const float3 base_color = xyz(surface_colored(scene, triangle, weights, base_texel));
    set_position(paths, i, position);
    set_position_error(paths, i, surface_error(world.magnitude));
    set_face_normal(paths, i, face_normal);
    set_normal(paths, i, normal);
    set_base_color(paths, i, base_color);
    int kind = SURFACE_LIT;
    if (uses(scene, EFFECT_UNLIT)) {
        const int is_unlit = (scene->materials[material].flags & MATERIAL_UNLIT) != 0;
        kind = is_unlit ? SURFACE_UNLIT : SURFACE_LIT;
    }
    set_surface_kind(paths, i, is_hit ? kind : SURFACE_NONE);

    if (uses(scene, EFFECT_SPECULAR)) {
        const float2 factors = surface_metallic_roughness(scene, paths, i, material, weights);
        const float4 specular = surface_specular(scene, paths, i, material, weights);
        set_metallic(paths, i, factors.x);
        set_roughness(paths, i, factors.y);
        set_dielectric_f0(paths, i, surface_dielectric_f0(scene, material, specular));
        set_dielectric_f90(paths, i, specular.w);
    }
    if (uses(scene, EFFECT_EMISSION)) {
        const float3 emission = surface_emission(scene, paths, i, material, weights);
        const float area_pdf = scene->materials[material].emission.w;
        const float3 none = make_float3(0.0f, 0.0f, 0.0f);
        set_emission(paths, i, select3(is_front & is_hit, emission, none));
        set_emission_pdf(paths, i, cosine > 0.0f ? area_pdf * distance2 / cosine : 0.0f);
    }
}
