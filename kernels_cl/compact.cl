// Lists of live paths, or of free slots, in ascending order: each work-group counts, one sums
// the counts, each writes at its place. No atomics, so that the order is the same in every run.
#include "platform.h"

#define GROUP_KERNEL __kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1)))

// Inclusive sum over the work-group; `scratch` holds twice GROUP_SIZE.
static int group_sum(int value, __local int* scratch)
{
    const int lane = (int)get_local_id(0);
    int from = 0;
    scratch[lane] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int step = 1; step < GROUP_SIZE; step *= 2) {
        const int mine = scratch[from + lane];
        const int before = lane >= step ? scratch[from + lane - step] : 0;
        from = GROUP_SIZE - from;
        scratch[from + lane] = mine + before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    const int sum = scratch[from + lane];
    barrier(CLK_LOCAL_MEM_FENCE);
    return sum;
}

static int path_at(__global const int* live, int is_compacted, int k, int count)
{
    const int last = k < count ? k : count - 1;
    return is_compacted ? live[last] : last;
}

// sums[g]: paths to be listed in work-group g. Those are listed whose depth is not negative, or, if
// not wants_live, the others.
GROUP_KERNEL void compact_count(__global const int* depth, __global const int* live,
                                int is_compacted, int count, __global int* sums, int wants_live)
{
    __local int scratch[2 * GROUP_SIZE];
    const int k = (int)get_global_id(0);
    const int is_alive = depth[path_at(live, is_compacted, k, count)] >= 0;
    const int sum = group_sum(k < count && is_alive == wants_live, scratch);
    if (get_local_id(0) == GROUP_SIZE - 1) sums[get_group_id(0)] = sum;
}

// By one work-group: sums[g] becomes the sum before g, total[0] that of all.
GROUP_KERNEL void compact_scan(__global int* sums, int groups, __global int* total)
{
    __local int scratch[2 * GROUP_SIZE];
    const int lane = (int)get_local_id(0);
    int before = 0;
    for (int start = 0; start < groups; start += GROUP_SIZE) {
        const int g = start + lane;
        const int value = g < groups ? sums[g] : 0;
        const int sum = group_sum(value, scratch);
        if (g < groups) sums[g] = before + sum - value;
        scratch[lane] = sum;
        barrier(CLK_LOCAL_MEM_FENCE);
        before += scratch[GROUP_SIZE - 1];
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (lane == 0) total[0] = before;
}

GROUP_KERNEL void compact_write(__global const int* depth, __global const int* live,
                                int is_compacted, int count, __global const int* sums,
                                int wants_live, __global int* listed)
{
    __local int scratch[2 * GROUP_SIZE];
    const int k = (int)get_global_id(0);
    const int path = path_at(live, is_compacted, k, count);
    const int is_listed = k < count && (depth[path] >= 0) == wants_live;
    const int rank = group_sum(is_listed, scratch);
    if (is_listed) listed[sums[get_group_id(0)] + rank - 1] = path;
}
