// The generated part of the texture stage: what kernels_cpu/texture_stage.cpp and
// kernels_cl/evaluate_textures.cl leave open.
#pragma once

#include "backends/scene_data.hpp"

#include <string>

namespace diptych {

// In C++: the functions' texts, one after the other, and the macros.
std::string cpp_texture_functions(const SceneData& scene);

// The OpenCL program of the stage. `stage`: its flattened source, with the pragma in it.
std::string opencl_texture_program(const SceneData& scene, const std::string& stage);

}  // namespace diptych
