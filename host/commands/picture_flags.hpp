// The flags that say how a render becomes a display picture: shared by the commands that write
// some.
#pragma once

#include "host/image/image.hpp"

#include <string>

namespace CLI {
class App;
}

namespace diptych {

// --exposure, --view, --half, --16bit.
void add_picture_flags(CLI::App& app, std::string& view, image::WriteOptions& write);

// `write` with the view of that name. Throws std::runtime_error for another, or an exposure out of
// range.
image::WriteOptions picture_options(const std::string& view, image::WriteOptions write);

}  // namespace diptych
