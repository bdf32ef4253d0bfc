// Starts paths at the camera: which pixel, which sample, which ray.
#pragma once

#include "common/camera.h"
#include "common/filter.h"
#include "common/random.h"

// A sample of a pixel: of a work item, and of its samples the one numbered `in_quantum`.
typedef struct {
    int item;
    int in_item;  // the pixel, in Morton order
    int in_quantum;
} PathPlace;

SHARED PathPlace place_of_entry(const Paths* paths, int entry, int in_quantum)
{
    PathPlace place;
    place.item = entry >> paths->pixel_shift;
    place.in_item = entry & ((1 << paths->pixel_shift) - 1);
    place.in_quantum = in_quantum;
    return place;
}

// Of path i of a dispatch where every path has a place of its own.
SHARED PathPlace place_of_path(const Paths* paths, int i)
{
    const int sample_of_all = i >> paths->pixel_shift;
    PathPlace place;
    place.item = (int)((float)sample_of_all * (1.0f / (float)paths->samples));
    place.in_item = i & ((1 << paths->pixel_shift) - 1);
    place.in_quantum = sample_of_all & (paths->samples - 1);
    return place;
}

SHARED void generate_path(const Scene* scene, const Paths* paths, int i, PathPlace place)
{
    const int x = paths->items[place.item].x + compact_bits((uint)place.in_item);
    const int y = paths->items[place.item].y + compact_bits((uint)place.in_item >> 1);
    const int sample = paths->items[place.item].first_sample + place.in_quantum;
    const int pixel = x | y << 16;
    const int is_inside = (x < scene->settings[0].width) & (y < scene->settings[0].height);

    const SampleKey key =
        sample_key(scene->settings[0].seed, scene->settings[0].sequence_quanta, pixel, sample);
    const float2 offset =
        filter_sample(scene->settings[0].filter, sample_pair(key, PAIR_PIXEL_FILTER));
    const Ray ray = camera_ray(scene, (float)x + 0.5f + offset.x, (float)y + 0.5f + offset.y);

    set_pixel(paths, i, pixel);
    set_sample(paths, i, sample);
    set_entry(paths, i, place.item << paths->pixel_shift | place.in_item);
    set_depth(paths, i, is_inside ? 0 : -1);
    set_ray_origin(paths, i, ray.origin);
    set_ray_direction(paths, i, ray.direction);
    set_scatter_pdf(paths, i, 0.0f);
    set_throughput(paths, i, make_float3(1.0f, 1.0f, 1.0f));
    set_radiance(paths, i, make_float3(0.0f, 0.0f, 0.0f));
}

// Every path of a dispatch at once.
SHARED void generate_paths(const Scene* scene, const Paths* paths, int i)
{
    generate_path(scene, paths, i, place_of_path(paths, i));
}
