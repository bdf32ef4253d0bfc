// What every stage's kernel is given, expanded from the rows: all buffers in their order, then the
// work items, the list of live paths, and what differs from launch to launch. backends/
// opencl_backend.cpp binds in the same order.
#pragma once

#include "common/buffers.h"

#define SCENE_ARGUMENT(type, name) GLOBAL const STORED(type) * name,
#define PATH_ARGUMENT(type, name, life) GLOBAL PLANE(type) * name,
#define RESULT_ARGUMENT(type, name) GLOBAL PLANE(type) * name,
#define TEXTURE_ARGUMENT(type, name) GLOBAL PLANE(type) * name,
#define TEXTURE_RESULT_ARGUMENT(type, name) GLOBAL PLANE(type) * name,

// is_compacted: the paths are live[first] to live[first + count - 1], else first to
// first + count - 1.
#define KERNEL_ARGUMENTS                                                                          \
    SCENE_BUFFERS(SCENE_ARGUMENT)                                                                 \
    PATH_BUFFERS(PATH_ARGUMENT)                                                                   \
    RESULT_BUFFERS(RESULT_ARGUMENT)                                                               \
    TEXTURE_BUFFERS(TEXTURE_ARGUMENT)                                                             \
    TEXTURE_RESULT_BUFFERS(TEXTURE_RESULT_ARGUMENT)                                               \
    GLOBAL const WorkItem *items, GLOBAL const int *live, int capacity, int results, int samples, \
        int pixel_shift, int first, int count, int is_compacted, int lookup

#define BIND_SCENE(type, name) scene.name = name;
#define BIND_PATH(type, name, life) paths.name = name;
#define BIND_RESULT(type, name) paths.name = name;
#define BIND_TEXTURE(type, name) paths.name = name;
#define BIND_TEXTURE_RESULT(type, name) paths.name = name;

// Declares the views `scene` and `paths` over the arguments.
#define KERNEL_VIEWS                 \
    Scene scene;                     \
    scene.effects = EFFECTS;         \
    SCENE_BUFFERS(BIND_SCENE)        \
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
