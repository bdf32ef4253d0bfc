// Texture functions as the texture tool would write them, small enough to be written by hand: the
// stage is tested without the tool.
#pragma once

#include "backends/textures/texture_function.hpp"

#include <string>

namespace textures {

// `body` is the same in both dialects: statements that use the arguments and return a float4 made
// with TX_NEW(float4, ...). Types of arguments: float, float2, float3, float4, sam2D.
diptych::TextureFunction handwritten(const std::string& id,
                                     std::vector<diptych::TextureArgument> arguments,
                                     const std::string& body, unsigned attributes = 0);

}  // namespace textures
