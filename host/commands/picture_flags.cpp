#include "host/commands/picture_flags.hpp"

#include "host/image/view_transform.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace diptych {
void add_picture_flags(CLI::App& app, std::string& view, image::WriteOptions& write)
{
    app.add_option("--exposure", write.exposure, "Stops, for display pictures")
        ->capture_default_str();
    app.add_option("--view", view,
                   "How radiance becomes display colours: standard, neutral or filmic")
        ->capture_default_str();
    app.add_flag("--half", write.half, "EXR: colours and normals in half precision");
    app.add_flag("--16bit", write.sixteen_bit, "PNG and TIFF: 16 bits a channel");
}

image::WriteOptions picture_options(const std::string& view, image::WriteOptions write)
{
    write.view = image::view_of_name(view);
    if (!(std::abs(write.exposure) <= 100))
        throw std::runtime_error(fmt::format(
            "--exposure {}: out of range; give stops from -100 to 100", write.exposure));
    return write;
}

}  // namespace diptych
