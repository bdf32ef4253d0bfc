// The flags that say how a render becomes a display picture: shared by the commands that write
// some.
#pragma once

#include "host/image/image.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace diptych {

// --exposure, --view, --half, --16bit.
void add_picture_flags(CLI::App& app, std::string& view, image::WriteOptions& write);

// The same flags as words, for a program that is started.
std::vector<std::string> picture_words(const std::string& view, const image::WriteOptions& write);

// `write` with the view of that name. Throws std::runtime_error for another, an exposure out of
// range, or a precision that none of these files has.
image::WriteOptions picture_options(const std::string& view, image::WriteOptions write,
                                    const std::vector<std::string>& files);

}  // namespace diptych
