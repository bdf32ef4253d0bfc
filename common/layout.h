// Every struct stored in device memory: int, uint, float, float2 and float4 only, in multiples of
// 16 bytes, the same bytes for every backend. Structs that kernels gather from are a power of two
// long: a vector unit scales an index by a shift, not by a 64-bit multiplication. Angles in
// radians, colours linear Rec.709, lengths in scene units (metres in glTF).
#pragma once

// X(struct, bytes): checked by every compiler that sees it.
#define STORED_STRUCTS(X) \
    X(Settings, 272)      \
    X(Triangle, 16)       \
    X(Instance, 128)      \
    X(Material, 128)      \
    X(TextureSlot, 64)    \
    X(Image, 16)          \
    X(Light, 128)         \
    X(AliasEntry, 16)     \
    X(BvhNode, 64)        \
    X(WorkItem, 16)

// One per render.
typedef struct {
    float4 camera_origin;   // world space
    float4 camera_right;    // half width of the image, in a perspective at distance 1
    float4 camera_up;       // likewise, half height
    float4 camera_forward;  // unit length; the camera looks along it
    float4 environment_x;   // rows of the rotation from world to environment space
    float4 environment_y;
    float4 environment_z;
    float4 environment_scale;  // radiance = texel * scale
    int camera_kind;           // CAMERA_*
    int width;                 // of the picture, pixels
    int height;
    int max_bounces;  // scattering events; BOUNCES_UNLIMITED for no limit
    uint seed;
    int filter;             // FILTER_*
    int uv_set_count;       // uvs of vertex v, set s: uvs[v * uv_set_count + s]
    int light_count;        // lights, the environment included
    int environment_width;  // texels of the environment's radiance map; 0 without one
    int environment_height;
    int environment_texels;  // index of the first one in texels_float
    int environment_light;   // index in lights, or -1
    int cell_columns;        // the environment's importance cells: see common/lights/environment.h
    int cell_rows;
    float environment_probability;  // of choosing the environment as the light
    float scene_radius;             // of the bounding sphere
    float4 scene_centre;
    int texture_output[6];  // of each SLOT_*: its place among the texture stage's results, or -1
    int texture_uv_set[2];  // which uv sets are TexCoord0 and TexCoord1; -1: none
    int occlusion_rays;     // of each request that a texture makes, a path
    float time;             // seconds, for textures that ask
    int samples;            // a pixel's
    int sequence_quanta;    // log2 of the quanta in a sample sequence: see common/random.h
    int object_frames;      // word of the materials' buffer: see object_position; -1: not asked for
    int aov_count;          // texture nodes that layers of the picture show
    int reserved[3];
} Settings;

#define MOST_ENVIRONMENT_CELLS 4096  // in a row or a column: twelve halvings find one

#define CAMERA_PERSPECTIVE 0
#define CAMERA_ORTHOGRAPHIC 1
#define FILTER_BOX 0
#define FILTER_BLACKMAN_HARRIS 1
#define BOUNCES_UNLIMITED 0x7fffffff

// In normals: the vertex belongs to a flat surface, use the face normal. No packed normal has these
// bits: -32768 is not an octahedral coordinate.
#define NORMAL_FLAT 0x80008000u

typedef struct {
    int vertex0;  // into positions, normals, tangents, uvs, colors
    int vertex1;
    int vertex2;
    int material;
} Triangle;

// A mesh placed in the world. Instance 0 holds all meshes that appear once, already in world space.
typedef struct {
    float4 to_world_x;  // rows of object-to-world: world.x = dot(to_world_x, (x, y, z, 1))
    float4 to_world_y;
    float4 to_world_z;
    float4 to_object_x;  // rows of its inverse
    float4 to_object_y;
    float4 to_object_z;
    int first_triangle;  // the mesh: a range of triangles
    int triangle_count;
    int root_node;    // of the mesh's tree in bvh_nodes
    int is_mirrored;  // the determinant is negative: the winding that faces front is reversed
    int object;       // the number of the placement, for the layer of object ids
    int reserved[3];
} Instance;

typedef struct {
    float4 base_color;  // factor; w = alpha
    float4 emission;  // radiance; w = probability density over area with which light sampling finds
                      // a point on it
    float4 specular_color;  // KHR_materials_specular; w = specular factor
    float metallic;
    float roughness;      // perceptual: alpha of the microfacet distribution is its square
    float dielectric_f0;  // from the index of refraction: ((n - 1) / (n + 1))^2
    float alpha_cutoff;
    float normal_scale;
    int alpha_mode;  // ALPHA_*
    int flags;       // MATERIAL_*
    int base_slot;   // texture slots: index into texture_slots, or -1
    int metallic_roughness_slot;
    int normal_slot;
    int emission_slot;
    int specular_slot;
    int specular_color_slot;
    int texture_program[6];  // of each PROGRAM_*: where in the words of the materials it lies; 0:
                             // none
    int reserved;
} Material;

// Where texture_program lies in a material, and how long a material is, in words.
#define MATERIAL_PROGRAM_WORD 25
#define MATERIAL_WORDS 32

// In place of a texture slot: the texture stage has computed what the material reads there.
#define TEXTURE_PROCEDURAL (-2)

// The programs of a material's textures: all that it reads where a path has met it; alpha alone;
// emission alone; what layers of the picture show. The last two give the distances of occlusion
// that nodes of the former ask for, those of the layers apart.
#define PROGRAM_SURFACE 0
#define PROGRAM_ALPHA 1
#define PROGRAM_EMISSION 2
#define PROGRAM_AOV 3
#define PROGRAM_DISTANCE 4
#define PROGRAM_AOV_DISTANCE 5

// The places of a material where a texture may stand.
#define SLOT_BASE 0
#define SLOT_METALLIC_ROUGHNESS 1
#define SLOT_NORMAL 2
#define SLOT_EMISSION 3
#define SLOT_SPECULAR 4
#define SLOT_SPECULAR_COLOR 5
#define SLOT_COUNT 6

#define ALPHA_OPAQUE 0
#define ALPHA_MASK 1
#define ALPHA_BLEND 2
#define MATERIAL_UNLIT 1
#define MATERIAL_DOUBLE_SIDED 2

// How a material reads an image: KHR_texture_transform and the sampler folded in.
typedef struct {
    int image;    // into images
    int uv_set;   // 0 .. uv_set_count - 1
    int wrap;     // WRAP_* of s, plus 4 * WRAP_* of t
    int filter;   // TEXTURE_NEAREST or TEXTURE_LINEAR
    float4 to_u;  // image u = to_u.x * u + to_u.y * v + to_u.z
    float4 to_v;
    float4 reserved;
} TextureSlot;

#define WRAP_REPEAT 0
#define WRAP_MIRROR 1
#define WRAP_CLAMP 2
#define TEXTURE_NEAREST 0
#define TEXTURE_LINEAR 1

typedef struct {
    int width;
    int height;
    int first_texel;  // in texels_8 (a uint each: R low byte, alpha high) or texels_float
    int encoding;     // TEXELS_*
} Image;

#define TEXELS_8_LINEAR 0
#define TEXELS_8_SRGB 1
#define TEXELS_FLOAT 2

// Something that light sampling can choose.
typedef struct {
    float4 position;  // triangle: first corner; point and spot: position; directional: unused
                      // (world space)
    float4 edge1;  // triangle: second corner - first. spot and directional: unit direction in which
                   // light travels
    float4 edge2;  // triangle: third corner - first. spot: x = cos(outer), y = 1 / (cos(inner) -
                   // cos(outer))
    float4 emission;  // triangle: radiance; point and spot: W/sr; directional: W/m^2. w =
                      // probability of being chosen
    int kind;         // LIGHT_*
    int triangle;     // for textured emission: into triangles
    int instance;
    float normal_sign;  // triangle: +1, or -1 when the front is the side that cross(edge1, edge2)
                        // points away from
    float range;        // point and spot: no light beyond it; 0 for no limit
    float reserved[3];
    float4 reserved_shapes[2];
} Light;

#define LIGHT_TRIANGLE 0
#define LIGHT_POINT 1
#define LIGHT_SPOT 2
#define LIGHT_DIRECTIONAL 3
#define LIGHT_ENVIRONMENT 4

// Vose's alias method: column k of n keeps k with probability `threshold`, else gives `alias`.
typedef struct {
    float threshold;
    int alias;
    float probability;  // of the outcome k in all
    int reserved;
} AliasEntry;

// Two children and their boxes: 64 bytes, one cache line.
typedef struct {
    float4 x;  // child 0 low, child 0 high, child 1 low, child 1 high
    float4 y;
    float4 z;
    int child[2];  // >= 0: a node; < 0: a leaf, see below; BVH_NONE with an empty box: nothing
    int reserved[2];
} BvhNode;

// A leaf is a range of bvh_items: triangles in the tree of a mesh, one instance in the top level.
#define BVH_LEAF(first, count) (~((first) << 3 | ((count)-1)))
#define BVH_LEAF_FIRST(leaf) (~(leaf) >> 3)
#define BVH_LEAF_COUNT(leaf) ((~(leaf)&7) + 1)
#define BVH_LEAF_MAX 8
#define BVH_NONE (-0x7fffffff - 1)

// Inner nodes on the way to any leaf, at most: the builder keeps to it, the walk's stack relies on
// it.
#define BVH_TOP_DEPTH 24
#define BVH_MESH_DEPTH 40
#define BVH_STACK 64  // the sum

// By how much a box exceeds what is in it, of the extent of the latter.
#define BVH_PADDING 1e-6f

// A quantum of work: up to QUANTUM samples of each pixel of a film block, or of one pixel.
typedef struct {
    int x;  // lowest pixel of the block
    int y;
    int first_sample;
    int reserved;
} WorkItem;

#define BLOCK_SHIFT 4  // film blocks of 16 x 16 pixels, Morton-ordered inside
#define QUANTUM 16     // samples a pixel in one work item
