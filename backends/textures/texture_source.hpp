// The generated part of the texture stage: what kernels_cpu/texture_stage.cpp and
// kernels_cl/evaluate_textures.cl leave open.
#pragma once

#include "backends/scene_data.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace diptych {

// Where people find the generated code, and change it. Empty: nowhere.
struct GeneratedFolders {
    std::string write{};  // functions.hpp (C++) and functions.cl (OpenCL) are written there too
    std::string use{};    // and taken from here, instead of what was generated
    bool has_own_lines = false;  // C++: the lines are named of that file, not of users' files
};

struct CppTextures {
    std::string all;          // the functions' texts, one after the other, and the macros
    std::string definitions;  // the macros alone
    std::vector<std::string> functions;  // by function: text and macros that it alone needs
};

// In C++. Throws std::runtime_error when a folder cannot be written, or lacks the file, or holds
// that of other textures.
CppTextures cpp_textures(const SceneData& scene, const GeneratedFolders& folders = {});

// The text with the lines that are no user's named as those of this file, which is to hold it.
std::string with_generated_lines_of(const std::string& text, const std::filesystem::path& file);

// About the code in the folder that this backend (its name) runs: a line for each user's file that
// was edited since the code was made of it.
std::vector<std::string> notices_of_generated(const SceneData& scene, const std::string& folder,
                                              const std::string& backend);

// The OpenCL program of the stage. `stage`: its flattened source, with the pragma in it. Throws
// likewise.
std::string opencl_texture_program(const SceneData& scene, const std::string& stage,
                                   const GeneratedFolders& folders = {});

}  // namespace diptych
