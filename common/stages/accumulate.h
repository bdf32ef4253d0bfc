// Adds samples of a pixel of a work item to the pixel's sums. One that is not finite is dropped and
// counted.
#pragma once

#include "common/buffers.h"
#include "common/math.h"

// The path that is added to a result in this turn.
SHARED int accumulated_path(const Paths* paths, int result)
{
    const int in_item = result & ((1 << paths->pixel_shift) - 1);
    const int item = result >> paths->pixel_shift;
    return ((item * paths->samples + paths->turn) << paths->pixel_shift) | in_item;
}

// Adds path i, which has ended, to a result. sample_number: among all
// of its pixel.
SHARED void accumulate_path(const Scene* scene, const Paths* paths, int i, int result,
                            int sample_number)
{
    (void)scene;
    const float3 sample = get_radiance(paths, i);
    const int is_finite = vec_is_finite(sample);
    const float3 radiance = make_float3(is_finite ? sample.x : 0.0f, is_finite ? sample.y : 0.0f,
                                        is_finite ? sample.z : 0.0f);
    const int object = get_first_object(paths, i);
    const int material = get_first_material(paths, i);

    set_sum_radiance(paths, result, get_sum_radiance(paths, result) + radiance);
    set_sum_albedo(paths, result, get_sum_albedo(paths, result) + get_first_albedo(paths, i));
    set_sum_normal(paths, result, get_sum_normal(paths, result) + get_first_normal(paths, i));
    set_sum_distance(paths, result, get_sum_distance(paths, result) + get_first_distance(paths, i));
    set_sum_alpha(paths, result, get_sum_alpha(paths, result) + (object >= 0 ? 1.0f : 0.0f));
    set_fault(paths, result, get_fault(paths, result) + (is_finite ? 0 : 1));
    const int is_first = sample_number == 0;
    const int id = get_object_id(paths, result);
    const int material_id = get_material_id(paths, result);
    set_object_id(paths, result, is_first ? object : id);
    set_material_id(paths, result, is_first ? material : material_id);
}

// The sample of a pixel whose turn it is.
SHARED void accumulate(const Scene* scene, const Paths* paths, int result)
{
    const int first_sample = paths->items[result >> paths->pixel_shift].first_sample;
    accumulate_path(scene, paths, accumulated_path(paths, result), result,
                    first_sample + paths->turn);
}
