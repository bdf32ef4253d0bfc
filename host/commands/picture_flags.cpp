#include "host/commands/picture_flags.hpp"

#include "host/image/view_transform.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
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

std::vector<std::string> picture_words(const std::string& view, const image::WriteOptions& write)
{
    std::vector<std::string> words = {fmt::format("--exposure={}", write.exposure),
                                      "--view=" + view};
    if (write.half) words.push_back("--half");
    if (write.sixteen_bit) words.push_back("--16bit");
    return words;
}

image::WriteOptions picture_options(const std::string& view, image::WriteOptions write,
                                    const std::vector<std::string>& files)
{
    write.view = image::view_of_name(view);
    if (!(std::abs(write.exposure) <= 100))
        throw std::runtime_error(fmt::format(
            "--exposure {}: out of range; give stops from -100 to 100", write.exposure));
    if (write.half && std::ranges::none_of(files, image::holds_layers))
        throw std::runtime_error("--half: of .exr files only; name one with -o");
    if (write.sixteen_bit && std::ranges::none_of(files, image::holds_sixteen_bits))
        throw std::runtime_error("--16bit: of .png and .tif files only; name one with -o");
    return write;
}

}  // namespace diptych
