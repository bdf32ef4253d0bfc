// The kernel of one stage. The build runs the C preprocessor over this file once for each row of
// common/stages/stages.h, with STAGE and WHEN as the row says; EFFECTS, FAULT and GROUP_SIZE stay
// open until the program is compiled for a device.
#include "platform.h"

#include "kernels_cl/arguments.h"
#include "kernels_cl/faults.h"

#define TEXT(words) #words
// clang-format off
#define STAGE_HEADER(stage) TEXT(common/stages/stage.h)
// clang-format on
#include STAGE_HEADER(STAGE)

#define ENTRY_NAME_(stage) stage##_entry
#define ENTRY_NAME(stage) ENTRY_NAME_(stage)

#define RUN_once(stage, k) stage(&scene, &paths, k)
#define RUN_each_bounce(stage, k) stage(&scene, &paths, is_compacted ? live[k] : k)
#define RUN_each_layer(stage, k) RUN_each_bounce(stage, k)
#define RUN_each_surface_(stage, k)              \
    const int slot = is_compacted ? live[k] : k; \
    if (get_hit_triangle(&paths, slot) >= 0)     \
        stage(&scene, &paths, slot);             \
    else                                         \
        stage##_missed(&scene, &paths, slot)
#define RUN_each_surface(stage, k) RUN_each_surface_(stage, k)
#define RUN_first_bounce(stage, k)               \
    const int slot = is_compacted ? live[k] : k; \
    if (next_entry == EVERY_PATH || get_depth(&paths, slot) == 0) stage(&scene, &paths, slot)
#define RUN_at_end_(stage, k)                    \
    const int slot = is_compacted ? live[k] : k; \
    if (has_ended(&paths, slot))                 \
    stage##_path(&scene, &paths, slot, get_entry(&paths, slot), get_sample(&paths, slot))
#define RUN_at_end(stage, k) RUN_at_end_(stage, k)
#define RUN_(when, stage, k) RUN_##when(stage, k)
#define RUN(when, stage, k) RUN_(when, stage, k)

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
ENTRY_NAME(STAGE)(KERNEL_ARGUMENTS)
{
    KERNEL_VIEWS
    const int k = (int)get_global_id(0);
    if (k < count) {
        RUN(WHEN, STAGE, first + k);
    }
}
