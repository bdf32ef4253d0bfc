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
        texture_store(paths, i, step.outputs, value);
    }
}
