// Loops in vector lanes for the occlusion that textures ask for, on the `cpu` backend: first over
// the paths that ask, then over the rays of each of them.
#pragma once

#include "kernels_cpu/kernels.hpp"

namespace diptych {

// Paths whose textures ask for occlusion, in planes, and of one of their requests the rays.
struct AskingPaths {
    static constexpr int capacity = 32;
    int count = 0;
    int path[capacity];
    int program[capacity];
    int triangle[capacity];
    int instance[capacity];
    int is_front[capacity];
    float error[capacity];
    float position[3][capacity];
    float face_normal[3][capacity];
    float normal[3][capacity];

    int rays = 0;     // a request
    int bundles = 0;  // paths that have this request: their rays follow each other
    int path_of_bundle[capacity];
    int is_same_object[capacity];
};

struct TextureRayLoops {
    // Where the program of what each path has hit lies; 0: none.
    void (*programs)(const SceneView&, const PathView&, int first, int count, int* programs);
    // Fills in the places of asking.path[0 .. asking.count - 1].
    void (*places)(const SceneView&, const PathView&, AskingPaths& asking);
    // The rays of request number `request`, as shadow rays of the paths of `rays`.
    void (*rays)(const SceneView&, const PathView&, AskingPaths& asking, int request,
                 const PathView& rays);
};

// For the vectors of vector_kernels().
TextureRayLoops vector_texture_ray_loops(unsigned effects);

}  // namespace diptych
