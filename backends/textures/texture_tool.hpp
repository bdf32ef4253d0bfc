// Runs the texture tool, a process of its own, over a user's file.
#pragma once

#include "backends/textures/texture_function.hpp"

#include <filesystem>
#include <string>

namespace diptych {

struct TextureSource {
    std::filesystem::path file;
    std::string name;   // of the file, in messages and for debuggers
    std::string entry;  // empty: the only function that no other calls
    std::string id;     // in generated code
    // "values": the C++ notes in fault_line where one first is not finite; "indexes": where one is
    // out of range
    std::string watched = {};
};

// Throws std::runtime_error with the tool's messages (file:line:column: error: reason; remedy), or
// when the tool is not there. Results are kept in the cache folder.
TextureFunction translate_texture(const TextureSource& source);

// Of the textures that ship with the program: where the one of this name lies; empty: there is
// none.
std::filesystem::path library_texture(const std::string& name);

}  // namespace diptych
