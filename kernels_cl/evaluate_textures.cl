// The stage that holds user code: for each path, the steps of its material's program, on a stack of
// as many slots as values live at once. What the texture tool wrote takes the place of the pragma
// when the program is built for a scene: the functions, and TEXTURE_FUNCTIONS, TEXTURE_ASKED and
// TEXTURE_SLOTS as in kernels_cpu/texture_stage.cpp.
#include "platform.h"

#include "common/textures/procedural.h"
#include "common/user_language/as_opencl/user_language.h"
#include "kernels_cl/arguments.h"
#include "kernels_cl/faults.h"

// clang-format off
#include "common/textures/as_vectors/hooks.h"
#include "common/user_language/as_vectors/arguments.h"
// clang-format on

#pragma diptych textures

#define CALL_FUNCTION(number, id)       \
    case number:                        \
        value = id##_entry(tx, region); \
        break;

static TextureValue call(TextureContext* tx, int function, int region)
{
    float4 value = (float4)(0.0f);
    switch (function) {
        TEXTURE_FUNCTIONS(CALL_FUNCTION)
    }
    return texture_value(value);
}

static void evaluate_textures(const Scene* scene, const Paths* paths, int i)
{
    const int hit = get_hit_triangle(paths, i);
    if (hit < 0 || get_depth(paths, i) < 0) return;
    const int word = scene->materials[scene->triangles[hit].material].texture_program;
    if (word == 0) return;
    const TextureProgram program = texture_program(scene, word);
    TextureContext tx = texture_context(scene, paths, i, TEXTURE_ASKED);
    float stack[4 * TEXTURE_SLOTS];
    for (int k = 0; k < 4 * TEXTURE_SLOTS; ++k) stack[k] = 0.0f;
    tx.stack = stack;
    for (int k = 0; k < program.steps; ++k) {
        const TextureStep step = texture_step(scene, program.first, k);
        texture_begin(&tx, step);
        const TextureValue given = call(&tx, step.function, step.region);
        const int verdict = texture_verdict(&tx, given);
        if (verdict != 0) texture_count(paths, i, verdict);
        const TextureValue value = texture_finite(given);
        texture_push(stack, step.slot, value);
        texture_store(paths, i, step.outputs, value);
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
evaluate_textures_entry(KERNEL_ARGUMENTS)
{
    KERNEL_VIEWS
    const int k = (int)get_global_id(0);
    if (k < count) evaluate_textures(&scene, &paths, is_compacted ? live[first + k] : first + k);
}
