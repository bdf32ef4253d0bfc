// What the textures on emitters give at chosen places, asked on the host before any device is at
// work: how bright a light is decides how often it is chosen.
#pragma once

#include "backends/scene_data.hpp"

#include <vector>

namespace diptych {

// A ray that meets a triangle; world space, unit length.
struct EmissionQuery {
    int triangle = 0;
    int instance = 0;
    float3 origin;
    float3 direction;
};

// Linear radiance, before the material's factor. Occlusion that the textures ask for is taken as
// open. Throws std::runtime_error where the stage cannot be compiled.
std::vector<float4> look_up_emission(const SceneData& scene,
                                     const std::vector<EmissionQuery>& queries);

}  // namespace diptych
