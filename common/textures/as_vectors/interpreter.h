// Runs the program of what a path asks, one path at a time: included where TEXTURE_ASKED and
// TEXTURE_SLOTS of a scene are known, and the dialect's
//
//     TextureValue call(TextureContext* tx, int function, int region)
//     Watcher, a type, and
//     void texture_see(Watcher, int number, const float* stack, TextureValue given,
//                      const TextureContext* tx)
//
// The latter is shown each step with the stack before it and the value as the function gave it.
#pragma once

SHARED void texture_push(float* stack, int slot, TextureValue value)
{
    if (slot >= 0) {
        stack[4 * slot] = value.r;
        stack[4 * slot + 1] = value.g;
        stack[4 * slot + 2] = value.b;
        stack[4 * slot + 3] = value.a;
    }
}

// Hands what a step gave to the stages behind, for each of the results that it is.
SHARED void texture_store(const Scene* scene, const Paths* paths, int i, TextureStep step,
                          TextureValue value)
{
    if (uses(scene, EFFECT_TEXTURE_AOV) && step.aov >= 0) {
        set_first_aov(paths, 4 * step.aov, i, value.r);
        set_first_aov(paths, 4 * step.aov + 1, i, value.g);
        set_first_aov(paths, 4 * step.aov + 2, i, value.b);
        set_first_aov(paths, 4 * step.aov + 3, i, value.a);
    }
    if (uses(scene, EFFECT_OCCLUSION_DISTANCE) && step.distance >= 0)
        set_request_distance(paths, step.distance, i, value.r);
    for (int output = 0; output < SLOT_COUNT; ++output) {
        if ((step.outputs >> output & 1) != 0) {
            set_texture_result(paths, 4 * output, i, value.r);
            set_texture_result(paths, 4 * output + 1, i, value.g);
            set_texture_result(paths, 4 * output + 2, i, value.b);
            set_texture_result(paths, 4 * output + 3, i, value.a);
        }
    }
}

static void run_textures(const Scene* scene, const Paths* paths, int i, Watcher watcher)
{
    const int word = texture_program_of(scene, paths, i);
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
        texture_see(watcher, k, stack, given, &tx);
        const TextureValue value = texture_finite(given);
        texture_push(stack, step.slot, value);
        texture_store(scene, paths, i, step, value);
    }
}
