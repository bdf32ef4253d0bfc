// Fills the slots of a dispatch with paths. Slots stay full: a path that ends makes room for the
// next sample of its pixel, and where that was the last, for the first of a pixel that nobody has
// begun. So a pixel's samples follow each other in one slot, and their sum depends on nothing else.
#include "platform.h"

#include "common/stages/generate_paths.h"
#include "kernels_cl/arguments.h"
#include "kernels_cl/faults.h"

#define NOTHING_float3 make_float3(0.0f, 0.0f, 0.0f)
#define NOTHING_float 0.0f
#define NOTHING_int 0
#define CLEAR_RESULT(type, name) set_##name(paths, entry, NOTHING_##type);

// The slot's next path is the first sample of a result entry.
static PathPlace begin_entry(const Paths* paths, int entry)
{
    RESULT_BUFFERS(CLEAR_RESULT)
    set_object_id(paths, entry, -1);
    set_material_id(paths, entry, -1);
    return place_of_entry(paths, entry, 0);
}

// The stages at the end have summed the slot's path up; its next one is its pixel's next sample.
static PathPlace follow_up(const Paths* paths, int slot)
{
    const int entry = get_entry(paths, slot);
    const int first_sample = paths->items[entry >> paths->pixel_shift].first_sample;
    return place_of_entry(paths, entry, get_sample(paths, slot) - first_sample + 1);
}

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
generate_paths_entry(KERNEL_ARGUMENTS)
{
    KERNEL_VIEWS
    const int k = (int)get_global_id(0);
    if (k < count) {
        const int slot = is_compacted ? live[first + k] : first + k;
        if (next_entry == FOLLOW_UP && !has_ended(&paths, slot)) return;
        const PathPlace place = next_entry == EVERY_PATH ? place_of_path(&paths, slot)
                                : next_entry == FOLLOW_UP
                                    ? follow_up(&paths, slot)
                                    : begin_entry(&paths, next_entry + first + k);
        // Called at one place: where it is not inlined, every slot builds the views in memory.
        if (place.in_quantum < samples) generate_path(&scene, &paths, slot, place);
        const int is_outside = next_entry >= 0 && get_depth(&paths, slot) < 0;
        if (is_outside || place.in_quantum >= samples) set_sample(&paths, slot, SAMPLE_NONE);
    }
}
