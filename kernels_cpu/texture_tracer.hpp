// What a texture stage needs whose textures trace their occlusion rays themselves
// (TextureArm::traces_inside), for `diptych study textures` alone.
#pragma once

#include "kernels_cpu/kernels.hpp"

namespace diptych {

struct TracingTextureKernels : TextureKernels {
    // The open fraction of request `request` of a path's program, whose rays `tracer` traces one
    // by one.
    float (*openness)(const void* tracer, const SceneView&, const PathView&, int path,
                      int request) = nullptr;
    const void* tracer = nullptr;
};

}  // namespace diptych
