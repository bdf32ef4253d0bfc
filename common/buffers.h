// Every buffer of the renderer, one row each; views, upload and argument binding are expanded from
// the rows.
#pragma once

#include "common/layout.h"

// Read only, filled by the host once a render. X(element type, name)
#define SCENE_BUFFERS(X)          \
    X(Settings, settings)         \
    X(float4, positions)          \
    X(uint, normals)              \
    X(uint, tangents)             \
    X(float2, uvs)                \
    X(float4, colors)             \
    X(Triangle, triangles)        \
    X(int, triangle_objects)      \
    X(Instance, instances)        \
    X(Material, materials)        \
    X(TextureSlot, texture_slots) \
    X(Image, images)              \
    X(uint, texels_8)             \
    X(float4, texels_float)       \
    X(Light, lights)              \
    X(AliasEntry, light_choice)   \
    X(float, environment_cells)   \
    X(BvhNode, bvh_nodes)         \
    X(int, bvh_items)

// Those of them that may be larger than a device allocates at once: read through
// ROW_AT(scene, name, index) alone. X(element type, name, log2 of its bytes)
#define LARGE_BUFFERS(X)           \
    X(float4, positions, 4)        \
    X(uint, normals, 2)            \
    X(uint, tangents, 2)           \
    X(float2, uvs, 3)              \
    X(float4, colors, 4)           \
    X(Triangle, triangles, 4)      \
    X(int, triangle_objects, 2)    \
    X(Instance, instances, 7)      \
    X(uint, texels_8, 2)           \
    X(float4, texels_float, 4)     \
    X(Light, lights, 7)            \
    X(AliasEntry, light_choice, 4) \
    X(BvhNode, bvh_nodes, 6)       \
    X(int, bvh_items, 2)
#define LARGE_PAGES 4  // of each, at most; the dialect of OpenCL names them one by one

// State of the paths in flight, in planes: one array per component. X(type, name, life)
//   carried: lives from bounce to bounce, moves when live paths are compacted
//   bounce:  written and read within one bounce
//   sample:  written when a path first meets a surface, stays in its slot
#define PATH_BUFFERS(X)                   \
    X(int, pixel, carried)                \
    X(int, sample, carried)               \
    X(int, entry, carried)                \
    X(int, depth, carried)                \
    X(float3, ray_origin, carried)        \
    X(float3, ray_direction, carried)     \
    X(float, scatter_pdf, carried)        \
    X(float3, throughput, carried)        \
    X(float3, radiance, carried)          \
    X(int, hit_triangle, bounce)          \
    X(int, hit_instance, bounce)          \
    X(float3, position, bounce)           \
    X(float, position_error, bounce)      \
    X(float3, face_normal, bounce)        \
    X(float3, normal, bounce)             \
    X(float3, base_color, bounce)         \
    X(float3, emission, bounce)           \
    X(float, emission_pdf, bounce)        \
    X(float, metallic, bounce)            \
    X(float, roughness, bounce)           \
    X(float3, dielectric_f0, bounce)      \
    X(float, dielectric_f90, bounce)      \
    X(int, surface_kind, bounce)          \
    X(float3, shadow_origin, bounce)      \
    X(float3, shadow_direction, bounce)   \
    X(float, shadow_distance, bounce)     \
    X(float3, light_contribution, bounce) \
    X(int, is_occluded, bounce)           \
    X(float3, first_albedo, sample)       \
    X(float3, first_normal, sample)       \
    X(float, first_distance, sample)      \
    X(int, first_object, sample)          \
    X(int, first_material, sample)

// Values of surface_kind.
#define SURFACE_NONE 0
#define SURFACE_LIT 1
#define SURFACE_UNLIT 2

// What a dispatch leaves for the host: sums over the samples of a work item, one entry a pixel of
// the item.
#define RESULT_BUFFERS(X)   \
    X(float3, sum_radiance) \
    X(float, sum_alpha)     \
    X(float3, sum_albedo)   \
    X(float3, sum_normal)   \
    X(float, sum_distance)  \
    X(int, object_id)       \
    X(int, material_id)     \
    X(int, fault)

// Planes whose number the scene decides, none in most: what textures asked for and what they gave.
//   occlusion_result: of each request, the open fraction of its rays
//   texture_result:   four of each SLOT_* that some material of the scene computes
//   record_...:       a place away from the one that the path has met, where a texture is asked;
//                     triangle -1: nowhere (see LOOKUP_*)
//   request_distance: of each node that gives requests their distance
//   first_aov:        four of each node that is shown as a layer, where the path has first met a
//                     surface; stays in its slot
#define TEXTURE_BUFFERS(X)     \
    X(float, occlusion_result) \
    X(float, texture_result)   \
    X(int, record_triangle)    \
    X(int, record_instance)    \
    X(float, record_distance)  \
    X(float, request_distance) \
    X(float, first_aov)

// Textures are asked at the place that a path has met, or at its record. Whoever launches a stage
// for records hands it a view where their planes stand for hit_triangle and hit_instance, and those
// of the ray that leads there for ray_origin and ray_direction: the stage is the same.
#define LOOKUP_SURFACE 0   // at the place that the path has met
#define LOOKUP_EMISSION 1  // at the point chosen on a light
#define LOOKUP_ALPHA 2     // where the path's ray has been stopped, to learn whether it stays so
#define LOOKUP_SHADOW 3    // likewise the shadow ray
#define LOOKUP_AOV 4       // at the place that the path has met first, for layers of the picture

// Added to one of these: what is asked is how far occlusion is to reach there, before its rays are
// traced.
#define LOOKUP_DISTANCE 8
#define LOOKUP_PLACE(lookup) ((lookup)&7)

// What may be wrong with an evaluation of a texture; each is counted for its path's pixel.
#define TEXTURE_FAULT_NOT_FINITE 0  // evaluations whose result was replaced
#define TEXTURE_FAULT_BUDGET 1      // evaluations whose loops were cut short
#define TEXTURE_FAULT_INDEX 2       // indexes that were clamped
#define TEXTURE_FAULT_COUNT 3

// Planes of result entries whose number the scene decides, none in most.
//   texture_faults: of each TEXTURE_FAULT_*, how often it occurred
//   sum_aov:        as first_aov, summed
#define TEXTURE_RESULT_BUFFERS(X) \
    X(int, texture_faults)        \
    X(float, sum_aov)

#define SCENE_FIELD(type, name) GLOBAL const STORED(type) * name;
#define PATH_FIELD(type, name, life) GLOBAL PLANE(type) * name;
#define RESULT_FIELD(type, name) GLOBAL PLANE(type) * name;
#define TEXTURE_FIELD(type, name) GLOBAL PLANE(type) * name;
#define TEXTURE_RESULT_FIELD(type, name) GLOBAL PLANE(type) * name;

// The scene as a kernel sees it.
typedef struct {
    uint effects;  // mask of EFFECT_*; read it through uses()
    SCENE_BUFFERS(SCENE_FIELD)
    LARGE_BUFFERS(LARGE_FIELD)
} Scene;
LARGE_BUFFERS(LARGE_ACCESS)

// The paths of a dispatch, or of a chunk of one, as a kernel sees them. `entry` says where the
// result of path i is summed, and with it the path's work item, entry >> pixel_shift, and its pixel
// there, the rest. Where each path has a place of its own, path i belongs to work item
// i / (samples << pixel_shift), sample (i >> pixel_shift) % samples of it, and pixel
// i % (1 << pixel_shift). A path is alive while its depth, the number of its scattering events, is
// not negative.
typedef struct {
    int capacity;     // paths; the distance between the planes of a float3
    int results;      // result entries; likewise
    int samples;      // samples a pixel in each work item, a power of two
    int pixel_shift;  // log2 of the pixels in a work item: 2 * BLOCK_SHIFT, or 0 when it is one
                      // pixel
    int turn;    // at_end stages run once for each sample of a pixel, in ascending order: which one
    int lookup;  // LOOKUP_*: what textures are asked for, and where
    GLOBAL const STORED(WorkItem) * items;
    PATH_BUFFERS(PATH_FIELD)
    RESULT_BUFFERS(RESULT_FIELD)
    TEXTURE_BUFFERS(TEXTURE_FIELD)
    TEXTURE_RESULT_BUFFERS(TEXTURE_RESULT_FIELD)
} Paths;

// get_NAME(paths, i) and set_NAME(paths, i, value) for every row.
#define ACCESS_float(name, stride)                                                \
    SHARED float get_##name(const Paths* paths, int i) { return paths->name[i]; } \
    SHARED void set_##name(const Paths* paths, int i, float value) { paths->name[i] = value; }
#define ACCESS_int(name, stride)                                                \
    SHARED int get_##name(const Paths* paths, int i) { return paths->name[i]; } \
    SHARED void set_##name(const Paths* paths, int i, int value) { paths->name[i] = value; }
#define ACCESS_float3(name, stride)                                        \
    SHARED float3 get_##name(const Paths* paths, int i)                    \
    {                                                                      \
        return make_float3(paths->name[i], paths->name[paths->stride + i], \
                           paths->name[2 * paths->stride + i]);            \
    }                                                                      \
    SHARED void set_##name(const Paths* paths, int i, float3 value)        \
    {                                                                      \
        paths->name[i] = value.x;                                          \
        paths->name[paths->stride + i] = value.y;                          \
        paths->name[2 * paths->stride + i] = value.z;                      \
    }
#define PATH_ACCESS(type, name, life) ACCESS_##type(name, capacity)
#define RESULT_ACCESS(type, name) ACCESS_##type(name, results)
PATH_BUFFERS(PATH_ACCESS)
RESULT_BUFFERS(RESULT_ACCESS)

// Planes of TEXTURE_BUFFERS and TEXTURE_RESULT_BUFFERS are numbered.
#define NUMBERED_ACCESS(type, name, stride)                              \
    SHARED type get_##name(const Paths* paths, int plane, int i)         \
    {                                                                    \
        return paths->name[plane * paths->stride + i];                   \
    }                                                                    \
    SHARED void set_##name(const Paths* paths, int plane, int i, type x) \
    {                                                                    \
        paths->name[plane * paths->stride + i] = x;                      \
    }
#define TEXTURE_ACCESS(type, name) NUMBERED_ACCESS(type, name, capacity)
#define TEXTURE_RESULT_ACCESS(type, name) NUMBERED_ACCESS(type, name, results)
TEXTURE_BUFFERS(TEXTURE_ACCESS)
TEXTURE_RESULT_BUFFERS(TEXTURE_RESULT_ACCESS)

// Behind the materials, in the same buffer, lie the programs and arguments of their textures
// (common/textures/procedural.h): word `word` of it.
SHARED uint material_word(const Scene* scene, int word)
{
    return ((GLOBAL const uint*)scene->materials)[word];
}
