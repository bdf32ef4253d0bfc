// The sources that the texture stage is compiled from at run time, as the build embedded them
// (backends/textures/embed_headers.cmake).
#pragma once

#include <string>

namespace diptych {

struct StageHeader {
    const char* path;  // from the root of the tree
    const char* const* lines;

    std::string text() const
    {
        std::string whole;
        for (const char* const* line = lines; *line; ++line) whole += *line;
        return whole;
    }
};

// Ends with one without a path.
extern const StageHeader stage_headers[];

}  // namespace diptych
