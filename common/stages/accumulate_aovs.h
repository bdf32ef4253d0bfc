// Adds one sample of each pixel of a work item to the sums of the layers that show texture nodes:
// what they gave where the sample's path first met a surface, 0 where it met none.
#pragma once

#include "common/stages/accumulate.h"

// Of path i, which has ended. sample_number: as in accumulate_path().
SHARED void accumulate_aovs_path(const Scene* scene, const Paths* paths, int i, int result,
                                 int sample_number)
{
    (void)sample_number;
    const int is_hit = get_first_object(paths, i) >= 0;
    const int planes = 4 * scene->settings[0].aov_count;
    for (int plane = 0; plane < planes; ++plane) {
        const float value = get_first_aov(paths, plane, i);
        const float sum = get_sum_aov(paths, plane, result);
        set_sum_aov(paths, plane, result, sum + (is_hit ? value : 0.0f));
    }
}

SHARED void accumulate_aovs(const Scene* scene, const Paths* paths, int result)
{
    accumulate_aovs_path(scene, paths, accumulated_path(paths, result), result, paths->turn);
}
