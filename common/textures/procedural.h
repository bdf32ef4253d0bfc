// Procedural textures as the kernels see them: what a texture knows about the place it is asked
// for, the programs that run textures of a material in order, and the arguments they are given.
// These lie behind the materials in the same buffer, in whole pages of the size of a Material, as
// words (material_word): changing an argument is changing bytes.
//
//   program: {steps, group, first request, requests, first step ...}, each step TEXTURE_STEP_WORDS words:
//            {function, region, stack slot, outputs, first occlusion request, which layer of the
//            picture it is, which distance; the last two from 1 on, 0: none}
//   request: {word of its distance, hemisphere, whether of the same object only, word of the
//            distance to take where the first is not above zero}. A word ~d: the distance number d
//            that PROGRAM_DISTANCE gives
//   region:  four words an argument: {source, first word of the value, elements, 0}, then values.
//            source >= 0: the value is what lies in that stack slot; -1: a constant.
//   frames:  where LocalPos is asked for, OBJECT_FRAME_WORDS an object: see object_position.
#pragma once

#include "common/random.h"
#include "common/textures/texture_differentials.h"
#include "common/textures/texture_place.h"

#define TEXTURE_PROGRAM_WORDS 4
#define TEXTURE_STEP_WORDS 8
#define TEXTURE_DESCRIPTOR_WORDS 4

// What a texture may ask about the place. X(name in readAttr, bit, type, field)
#define TEXTURE_ATTRIBUTES(X)               \
    X(WorldPos, 0, float3, world_position)  \
    X(LocalPos, 1, float3, local_position)  \
    X(Normal, 2, float3, normal)            \
    X(GeomNormal, 3, float3, face_normal)   \
    X(Tangent, 4, float3, tangent)          \
    X(Bitangent, 5, float3, bitangent)      \
    X(TexCoord0, 6, float2, uv0)            \
    X(TexCoord1, 7, float2, uv1)            \
    X(VertexColor, 8, float4, vertex_color) \
    X(ViewDir, 9, float3, view_direction)   \
    X(ObjectId, 10, int, object)            \
    X(InstanceId, 11, int, instance)        \
    X(PrimitiveId, 12, int, primitive)      \
    X(Time, 13, float, time)                \
    X(TexCoord0Dx, 14, float2, uv0_dx)      \
    X(TexCoord0Dy, 15, float2, uv0_dy)

#define ATTRIBUTE_BIT(name, bit, type, field) ATTRIBUTE_##name = 1 << bit,
enum { TEXTURE_ATTRIBUTES(ATTRIBUTE_BIT) };

// Iterations of all loops of one evaluation together.
#define TEXTURE_BUDGET 1048576

// Everything in world space and of unit length where it is a direction.
#define ATTRIBUTE_FIELD(name, bit, type, field) type field;
typedef struct {
    const Scene* scene;
    const Paths* paths;
    int path;
    TEXTURE_ATTRIBUTES(ATTRIBUTE_FIELD)
    const float* stack;  // results so far: component c of slot s at [(4 s + c) stack_stride + lane]
    int stack_stride;
    int lane;
    int first_occlusion;  // of the step that runs
    int budget;           // iterations of its loops that are left
    int fault_line;       // of the user's file, where the budget ran out; 0: it did not
    int clamped;          // indexes that were out of range
} TextureContext;

// What an evaluation gives, whichever float4 a dialect has.
typedef struct {
    float r, g, b, a;
} TextureValue;

typedef struct {
    int steps;
    int group;  // programs of one group run the same functions in the same slots
    int first;  // word of the first step
} TextureProgram;

typedef struct {
    int function;
    int region;
    int slot;
    int outputs;  // mask over the results that evaluate_surface reads
    int first_occlusion;
    int aov;       // which of the picture's layers it is; -1: none
    int distance;  // which distance of requests; -1: none
} TextureStep;

// Which of a material's programs a lookup runs: PROGRAM_*.
SHARED int texture_program_asked(int lookup)
{
    const int place = LOOKUP_PLACE(lookup);
    const int away = place == LOOKUP_EMISSION ? PROGRAM_EMISSION : PROGRAM_ALPHA;
    const int here = place == LOOKUP_AOV ? PROGRAM_AOV : PROGRAM_SURFACE;
    const int distance = place == LOOKUP_AOV ? PROGRAM_AOV_DISTANCE : PROGRAM_DISTANCE;
    const int is_here = (place == LOOKUP_SURFACE) | (place == LOOKUP_AOV);
    return lookup >= LOOKUP_DISTANCE ? distance : is_here ? here : away;
}

// The program that is run where path i asks; 0: none. Layers ask at a path's first surface alone;
// on a device whose slots are filled again, others are further by then.
SHARED int texture_program_of(const Scene* scene, const Paths* paths, int i)
{
    const int which = texture_program_asked(paths->lookup);
    const int hit = get_hit_triangle(paths, i);
    const int triangle = hit < 0 ? 0 : hit;
    const int material = ROW_AT(scene, triangles, triangle).material;
    // the word, not texture_program[which], which g++ 14 does not gather for lanes
    const int place = material * MATERIAL_WORDS + MATERIAL_PROGRAM_WORD + which;
    const int program = (int)material_word(scene, place);
    const int depth = get_depth(paths, i);
    const int is_later = (LOOKUP_PLACE(paths->lookup) == LOOKUP_AOV) & (depth > 0);
    const int is_dead = (hit < 0) | (depth < 0) | is_later;
    return is_dead ? 0 : program;
}

SHARED TextureProgram texture_program(const Scene* scene, int word)
{
    TextureProgram program;
    program.steps = (int)material_word(scene, word);
    program.group = (int)material_word(scene, word + 1);
    program.first = word + TEXTURE_PROGRAM_WORDS;
    return program;
}

SHARED TextureStep texture_step(const Scene* scene, int first, int k)
{
    const int word = first + k * TEXTURE_STEP_WORDS;
    TextureStep step;
    step.function = (int)material_word(scene, word);
    step.region = (int)material_word(scene, word + 1);
    step.slot = (int)material_word(scene, word + 2);
    step.outputs = (int)material_word(scene, word + 3);
    step.first_occlusion = (int)material_word(scene, word + 4);
    step.aov = (int)material_word(scene, word + 5) - 1;
    step.distance = (int)material_word(scene, word + 6) - 1;
    return step;
}

// The place that path i has met, as far as the attributes in `asked` (a constant) go; what the mesh
// lacks is zero, vertex colours white.
SHARED TextureContext texture_context(const Scene* scene, const Paths* paths, int i, uint asked)
{
    const TexturePlace place = texture_place(scene, paths, i);
    const float sign = place.is_front ? 1.0f : -1.0f;
    const float3 zero = make_float3(0.0f, 0.0f, 0.0f);
    const float2 none = make_float2(0.0f, 0.0f);
    TextureContext tx;
    tx.scene = scene;
    tx.paths = paths;
    tx.path = i;
    tx.world_position = place.position;
    tx.face_normal = place.face_normal * sign;
    tx.normal = place.normal * sign;
    tx.view_direction = -get_ray_direction(paths, i);
    tx.local_position = place.position;
    if ((asked & ATTRIBUTE_LocalPos) != 0u)
        tx.local_position = object_position(
            scene, texture_object(scene, place.instance, place.triangle), place.position);
    tx.tangent = zero;
    tx.bitangent = zero;
    if ((asked & (ATTRIBUTE_Tangent | ATTRIBUTE_Bitangent)) != 0u) {
        const TextureFrame frame =
            texture_frame(scene, place.instance, place.triangle, place.weights, place.normal);
        tx.tangent = frame.tangent;
        tx.bitangent = frame.bitangent;
    }
    tx.uv0 = none;
    tx.uv1 = none;
    if ((asked & ATTRIBUTE_TexCoord0) != 0u)
        tx.uv0 = surface_uv_of_set(scene, place.triangle, place.weights,
                                   scene->settings[0].texture_uv_set[0]);
    if ((asked & ATTRIBUTE_TexCoord1) != 0u)
        tx.uv1 = surface_uv_of_set(scene, place.triangle, place.weights,
                                   scene->settings[0].texture_uv_set[1]);
    tx.uv0_dx = none;
    tx.uv0_dy = none;
    if ((asked & (ATTRIBUTE_TexCoord0Dx | ATTRIBUTE_TexCoord0Dy)) != 0u) {
        const TextureDifferentials change =
            texture_differentials(scene, paths, i, place, scene->settings[0].texture_uv_set[0]);
        tx.uv0_dx = change.dx;
        tx.uv0_dy = change.dy;
    }
    tx.vertex_color = make_float4(1.0f, 1.0f, 1.0f, 1.0f);
    if (uses(scene, EFFECT_VERTEX_COLOR) && (asked & ATTRIBUTE_VertexColor) != 0u)
        tx.vertex_color = surface_vertex_color(scene, place.triangle, place.weights);
    tx.object = 0;
    if ((asked & ATTRIBUTE_ObjectId) != 0u)
        tx.object = texture_object(scene, place.instance, place.triangle);
    tx.instance = place.instance;
    tx.primitive = place.triangle;
    tx.time = (float)scene->settings[0].time;
    tx.stack = 0;
    tx.stack_stride = 1;
    tx.lane = 0;
    tx.first_occlusion = 0;
    tx.budget = TEXTURE_BUDGET;
    tx.fault_line = 0;
    tx.clamped = 0;
    return tx;
}

SHARED TextureValue texture_value(float4 from)
{
    TextureValue value;
    value.r = from.x;
    value.g = from.y;
    value.b = from.z;
    value.a = from.w;
    return value;
}

SHARED TextureValue texture_texel(const Scene* scene, int slot, float u, float v)
{
    return texture_value(texture_read(scene, slot, make_float2(u, v)));
}

// The same with another wrap and filter than the slot's (see TextureSlot).
SHARED TextureValue texture_fetch(const Scene* scene, int slot, float u, float v, int wrap,
                                  int filter)
{
    return texture_value(texture_read_with(scene, slot, make_float2(u, v), wrap, filter));
}

// Before a step is run: its own occlusion results, a budget of its own.
SHARED void texture_begin(TextureContext* tx, TextureStep step)
{
    tx->first_occlusion = step.first_occlusion;
    tx->budget = TEXTURE_BUDGET;
    tx->fault_line = 0;
    tx->clamped = 0;
}

#define TEXTURE_MOST_CLAMPED 65535  // of those of one evaluation, counted

SHARED int texture_is_finite(TextureValue v)
{
    return vec_is_finite(make_float3(v.r, v.g, v.b)) & (math_abs(v.a) <= FLOAT_MAX);
}

// The value that others are given: 0 in place of what is not finite.
SHARED TextureValue texture_finite(TextureValue v)
{
    v.r = math_abs(v.r) <= FLOAT_MAX ? v.r : 0.0f;
    v.g = math_abs(v.g) <= FLOAT_MAX ? v.g : 0.0f;
    v.b = math_abs(v.b) <= FLOAT_MAX ? v.b : 0.0f;
    v.a = math_abs(v.a) <= FLOAT_MAX ? v.a : 0.0f;
    return v;
}

// What was wrong with an evaluation, its value apart, in one word; 0: nothing.
SHARED int texture_faults_on_the_way(const TextureContext* tx)
{
    const int clamped = tx->clamped < TEXTURE_MOST_CLAMPED ? tx->clamped : TEXTURE_MOST_CLAMPED;
    return (tx->fault_line != 0 ? 2 : 0) | clamped << 2;
}

// The same with the value v that it gave.
SHARED int texture_verdict(int on_the_way, TextureValue v)
{
    return (texture_is_finite(v) ? 0 : 1) | on_the_way;
}

// Counts what was wrong for the pixel of path i. Sums of integers are the same in any order. What
// gives a distance is evaluated again for the texture that asks for it, and counted then.
SHARED void texture_count(const Paths* paths, int i, int verdict)
{
    if (paths->lookup >= LOOKUP_DISTANCE) return;
    const int entry = get_entry(paths, i);
    const int counts[TEXTURE_FAULT_COUNT] = {verdict & 1, verdict >> 1 & 1, verdict >> 2};
    for (int fault = 0; fault < TEXTURE_FAULT_COUNT; ++fault) {
        if (counts[fault] != 0)
            atomic_add_int(paths->texture_faults + (fault * paths->results + entry), counts[fault]);
    }
}
