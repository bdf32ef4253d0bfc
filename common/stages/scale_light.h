// Light from an emitter that a texture paints: sample_light has it shine as if the texture gave 1,
// and leaves a record of the point; when the textures have run for it, this multiplies.
#pragma once

#include "common/stages/evaluate_surface.h"

// Where the texture of the chosen light is to be asked; nowhere if it has none or brings nothing.
SHARED void record_light(const Scene* scene, const Paths* paths, int i, int light,
                         float3 contribution)
{
    const int is_triangle = ROW_AT(scene, lights, light).kind == LIGHT_TRIANGLE;
    const int triangle = ROW_AT(scene, lights, light).triangle;
    const int instance = ROW_AT(scene, lights, light).instance;
    const int program = scene->materials[ROW_AT(scene, triangles, triangle).material]
                            .texture_program[PROGRAM_EMISSION];
    const int is_asked = is_triangle & (program != 0) & (vec_max_component(contribution) > 0.0f);
    // the triangle, or -1: bits, not a select, for which g++ 14 branches and leaves lanes
    set_record_triangle(paths, 0, i, triangle | (is_asked - 1));
    set_record_instance(paths, 0, i, instance);
}

SHARED void scale_light(const Scene* scene, const Paths* paths, int i)
{
    const int is_asked = get_record_triangle(paths, 0, i) >= 0;
    const int output = scene->settings[0].texture_output[SLOT_EMISSION];
    const int plane = output < 0 ? 0 : 4 * output;
    const float3 texel =
        make_float3(get_texture_result(paths, plane, i), get_texture_result(paths, plane + 1, i),
                    get_texture_result(paths, plane + 2, i));
    const float3 contribution = get_light_contribution(paths, i);
    set_light_contribution(paths, i, select3(is_asked, contribution * texel, contribution));
}
