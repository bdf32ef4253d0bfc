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

// The slot's next path is the first sample of a result entry. Outside the picture the slot stays
// free.
static void begin_entry(const Scene* scene, const Paths* paths, int slot, int entry)
{
    const int item = entry >> paths->pixel_shift;
    RESULT_BUFFERS(CLEAR_RESULT)
    set_object_id(paths, entry, -1);
    set_material_id(paths, entry, -1);
    generate_path(scene, paths, slot, item, entry & ((1 << paths->pixel_shift) - 1), 0);
    if (get_depth(paths, slot) < 0) set_sample(paths, slot, SAMPLE_NONE);
}

// The stages at the end have summed the slot's path up, if it has ended.
static void follow_up(const Scene* scene, const Paths* paths, int slot)
{
    const int entry = get_entry(paths, slot);
    const int item = entry >> paths->pixel_shift;
    const int next = get_sample(paths, slot) - paths->items[item].first_sample + 1;
    if (!has_ended(paths, slot)) return;
    if (next < paths->samples)
        generate_path(scene, paths, slot, item, entry & ((1 << paths->pixel_shift) - 1), next);
    else
        set_sample(paths, slot, SAMPLE_NONE);
}

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
generate_paths_entry(KERNEL_ARGUMENTS)
{
    KERNEL_VIEWS
    const int k = (int)get_global_id(0);
    if (k < count) {
        const int slot = is_compacted ? live[first + k] : first + k;
        if (next_entry == EVERY_PATH)
            generate_paths(&scene, &paths, slot);
        else if (next_entry == FOLLOW_UP)
            follow_up(&scene, &paths, slot);
        else
            begin_entry(&scene, &paths, slot, next_entry + first + k);
    }
}
