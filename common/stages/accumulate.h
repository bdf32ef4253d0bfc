// Adds one sample of each pixel of a work item to the pixel's sums. A sample that is not finite is
// dropped and counted.
#pragma once

#include "common/buffers.h"
#include "common/math.h"

SHARED void accumulate(const Scene* scene, const Paths* paths, int result)
{
    (void)scene;
    const int in_item = result & ((1 << paths->pixel_shift) - 1);
    const int item = result >> paths->pixel_shift;
    const int i = ((item * paths->samples + paths->turn) << paths->pixel_shift) | in_item;

    const float3 sample = get_radiance(paths, i);
    const int is_finite = vec_is_finite(sample);
    const float3 radiance = make_float3(is_finite ? sample.x : 0.0f, is_finite ? sample.y : 0.0f,
                                        is_finite ? sample.z : 0.0f);
    const int object = get_first_object(paths, i);
    const int material = get_first_material(paths, i);
    const int is_first = paths->items[item].first_sample + paths->turn == 0;

    set_sum_radiance(paths, result, get_sum_radiance(paths, result) + radiance);
    set_sum_albedo(paths, result, get_sum_albedo(paths, result) + get_first_albedo(paths, i));
    set_sum_normal(paths, result, get_sum_normal(paths, result) + get_first_normal(paths, i));
    set_sum_distance(paths, result, get_sum_distance(paths, result) + get_first_distance(paths, i));
    set_sum_alpha(paths, result, get_sum_alpha(paths, result) + (object >= 0 ? 1.0f : 0.0f));
    set_fault(paths, result, get_fault(paths, result) + (is_finite ? 0 : 1));
    const int id = get_object_id(paths, result);
    const int material_id = get_material_id(paths, result);
    set_object_id(paths, result, is_first ? object : id);
    set_material_id(paths, result, is_first ? material : material_id);
}
