// The stage that holds user code: for each path, the steps of its material's program, on a stack of
// as many slots as values live at once. What the texture tool wrote takes the place of the pragma
// when the program is built for a scene: the functions, and TEXTURE_FUNCTIONS, TEXTURE_ASKED and
// TEXTURE_SLOTS as in kernels_cpu/texture_stage.cpp.
#include "platform.h"

#include "common/stages/trace_texture_rays.h"
#include "common/textures/procedural.h"
#include "common/user_language/as_opencl/user_language.h"
#include "kernels_cl/arguments.h"
#include "kernels_cl/faults.h"

// clang-format off
#include "common/textures/as_vectors/hooks.h"
#include "common/user_language/as_vectors/arguments.h"
// clang-format on

// In place of tx_occlusion where the study has textures trace their rays themselves.
SHARED float tx_traced_occlusion(const TextureContext* tx, int request)
{
    return texture_openness_at(tx->scene, tx->paths, tx->path, tx->first_occlusion + request);
}

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

typedef int Watcher;  // nobody

static void texture_see(Watcher watcher, int number, const float* stack, TextureValue given,
                        const TextureContext* tx)
{
    const int verdict = texture_verdict(texture_faults_on_the_way(tx), given);
    if (verdict != 0) texture_count(tx->paths, tx->path, verdict);
}

// clang-format off
#include "common/textures/as_vectors/interpreter.h"
// clang-format on

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
evaluate_textures_entry(KERNEL_ARGUMENTS)
{
    KERNEL_VIEWS
    const int k = (int)get_global_id(0);
    if (k < count) run_textures(&scene, &paths, is_compacted ? live[first + k] : first + k, 0);
}
