#include "host/image/image.hpp"

#include <stdexcept>
#include <utility>

namespace diptych::image {

Layer beauty_layer(std::vector<float> rgba)
{
    return {"", {"R", "G", "B", "A"}, std::move(rgba), {}};
}

Layer albedo_layer(std::vector<float> rgb)
{
    return {"albedo", {"R", "G", "B"}, std::move(rgb), {}};
}

Layer normal_layer(std::vector<float> xyz)
{
    return {"normal", {"X", "Y", "Z"}, std::move(xyz), {}};
}

Layer depth_layer(std::vector<float> distances)
{
    return {"depth", {"Z"}, std::move(distances), {}};
}

Layer standard_error_layer(std::vector<float> rgb)
{
    return {"standard_error", {"R", "G", "B"}, std::move(rgb), {}};
}

Layer predicted_error_layer(std::vector<float> jnd)
{
    return {"predicted_error", {""}, std::move(jnd), {}};
}

Layer id_layer(std::string name, std::vector<uint32_t> ids)
{
    return {std::move(name), {""}, {}, std::move(ids)};
}

Layer node_layer(const std::string& node, int channels, std::vector<float> values)
{
    std::vector<std::string> names = {"R", "G", "B", "A"};
    names.resize(size_t(channels));
    return {"aov." + node, std::move(names), std::move(values), {}};
}

bool is_node_layer(const Layer& layer) { return layer.name.starts_with("aov."); }

const Layer* find_layer(const Picture& picture, const std::string& name)
{
    for (const Layer& layer : picture.layers)
        if (layer.name == name) return &layer;
    return nullptr;
}

const Layer& beauty_of(const Picture& picture)
{
    const Layer* layer = find_layer(picture, "");
    if (!layer)
        throw std::runtime_error("picture: no colour channels R, G, B; name one of its layers");
    return *layer;
}

}  // namespace diptych::image
