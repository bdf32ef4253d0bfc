// What every stage's kernel is given, expanded from the rows: all buffers in their order, then the
// work items, the list of live paths, what differs from launch to launch, and the further pages of
// large buffers. backends/
// opencl_backend.cpp binds in the same order.
#pragma once

#include "common/buffers.h"

// What next_entry says where it is not the result entry that the first path of a launch begins.
#define EVERY_PATH (-1)  // paths have their places once and for all: one slot a sample
#define FOLLOW_UP (-2)   // slots whose path has ended go on with their pixel's next sample

// The sample in a slot without a path.
#define SAMPLE_NONE (-1)

#define SCENE_ARGUMENT(type, name) GLOBAL const STORED(type) * name,
#define PATH_ARGUMENT(type, name, life) GLOBAL PLANE(type) * name,
#define RESULT_ARGUMENT(type, name) GLOBAL PLANE(type) * name,
#define TEXTURE_ARGUMENT(type, name) GLOBAL PLANE(type) * name,
#define TEXTURE_RESULT_ARGUMENT(type, name) GLOBAL PLANE(type) * name,

#define LARGE_ARGUMENTS(type, name, log_bytes)                                    \
    , GLOBAL const STORED(type) * name##_1, GLOBAL const STORED(type) * name##_2, \
        GLOBAL const STORED(type) * name##_3

// is_compacted: the paths are live[first] to live[first + count - 1], else first to
// first + count - 1.
#define KERNEL_ARGUMENTS                                                                          \
    SCENE_BUFFERS(SCENE_ARGUMENT)                                                                 \
    PATH_BUFFERS(PATH_ARGUMENT)                                                                   \
    RESULT_BUFFERS(RESULT_ARGUMENT)                                                               \
    TEXTURE_BUFFERS(TEXTURE_ARGUMENT)                                                             \
    TEXTURE_RESULT_BUFFERS(TEXTURE_RESULT_ARGUMENT)                                               \
    GLOBAL const WorkItem *items, GLOBAL const int *live, int capacity, int results, int samples, \
        int pixel_shift, int first, int count, int is_compacted, int lookup,                      \
        int next_entry LARGE_BUFFERS(LARGE_ARGUMENTS)

#define BIND_SCENE(type, name) scene.name = name;
#define BIND_LARGE(type, name, log_bytes) \
    scene.name##_1 = name##_1;            \
    scene.name##_2 = name##_2;            \
    scene.name##_3 = name##_3;
#define BIND_PATH(type, name, life) paths.name = name;
#define BIND_RESULT(type, name) paths.name = name;
#define BIND_TEXTURE(type, name) paths.name = name;
#define BIND_TEXTURE_RESULT(type, name) paths.name = name;

// Whether a slot's path has ended and is not summed up yet.
SHARED int has_ended(const Paths* paths, int slot)
{
    return get_depth(paths, slot) < 0 && get_sample(paths, slot) != SAMPLE_NONE;
}

// Declares the views `scene` and `paths` over the arguments.
#define KERNEL_VIEWS                 \
    Scene scene;                     \
    scene.effects = EFFECTS;         \
    SCENE_BUFFERS(BIND_SCENE)        \
    LARGE_BUFFERS(BIND_LARGE)        \
    Paths paths;                     \
    paths.capacity = capacity;       \
    paths.results = results;         \
    paths.samples = samples;         \
    paths.pixel_shift = pixel_shift; \
    paths.turn = 0;                  \
    paths.lookup = lookup;           \
    paths.items = items;             \
    PATH_BUFFERS(BIND_PATH)          \
    RESULT_BUFFERS(BIND_RESULT)      \
    TEXTURE_BUFFERS(BIND_TEXTURE)    \
    TEXTURE_RESULT_BUFFERS(BIND_TEXTURE_RESULT)
