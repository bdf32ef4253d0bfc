// Occlusion that textures ask for, through Embree: the native stage trace_texture_rays of the `cpu`
// backend.
#pragma once

#include "kernels_cpu/embree_scene.hpp"
#include "kernels_cpu/kernels.hpp"

namespace diptych {

// Fills the occlusion results of paths 0 .. count - 1. Returns the number of rays.
int trace_texture_rays(const EmbreeScene&, const SceneView&, const PathView&, int count);

// TracingTextureKernels::openness by an EmbreeScene: rays one by one.
float trace_texture_ray_by_ray(const void* embree_scene, const SceneView&, const PathView&,
                               int path, int request);

}  // namespace diptych
