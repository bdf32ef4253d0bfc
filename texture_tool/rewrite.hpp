// The user's text in the two dialects that Diptych compiles: line for line the original, with names
// that clash with nothing and with one defined result for everything C leaves open.
#pragma once

#include <string>

#include "texture_tool/description.hpp"

namespace texture_tool {

// The watched ones: C++ that also notes in fault_line where a value first was not finite, or an
// index out of range.
enum class Variant { OpenCl, Cpp, WatchedValues, WatchedIndexes };

struct Rewritten {
    std::string text;
    int changed_lines = 0;
    int total_lines = 0;
};

// `id` is the texture's prefix (OpenCL) or namespace (C++), a C identifier. The description must be
// checked and free of errors.
Rewritten rewrite(const Description& description, Variant variant, const std::string& id);

}  // namespace texture_tool
