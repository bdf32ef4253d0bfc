// Accessors: stored numbers of any type to floats and indices.
#include "host/scene/gltf_check.hpp"
#include "host/scene/gltf_document.hpp"
#include "host/scene/scene_error.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace diptych {
namespace {

// More elements than this without any data behind them are a trap, not a mesh.
constexpr size_t most_implied_elements = size_t(1) << 24;

// Elements in memory, `stride` bytes apart.
struct Elements {
    const std::uint8_t* bytes;
    size_t count;
    size_t stride;
};

double component(const std::uint8_t* at, int type, bool is_normalized)
{
    const auto read = [at]<typename T>(T) {
        T value;
        std::memcpy(&value, at, sizeof value);
        return value;
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return is_normalized ? std::max(read(std::int8_t()) / 127.0, -1.0) : read(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return is_normalized ? *at / 255.0 : *at;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return is_normalized ? std::max(read(std::int16_t()) / 32767.0, -1.0)
                             : read(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return is_normalized ? read(std::uint16_t()) / 65535.0 : read(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return is_normalized ? read(std::uint32_t()) / 4294967295.0 : read(std::uint32_t());
    default:
        return double(read(float()));
    }
}

size_t stored_component_size(int type) { return element_size(type, "SCALAR"); }

void store_floats(const tinygltf::Accessor& accessor, const Elements& from, int components,
                  const std::vector<size_t>& to, std::vector<float>& values)
{
    const int stored = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    const size_t size = stored_component_size(accessor.componentType);
    const int used = std::min(stored, components);
    for (size_t k = 0; k < from.count; ++k) {
        const size_t element = to.empty() ? k : to[k];
        for (int c = 0; c < used; ++c) {
            values[element * size_t(components) + size_t(c)] =
                float(component(from.bytes + k * from.stride + size_t(c) * size,
                                accessor.componentType, accessor.normalized));
        }
    }
}

Elements stored_elements(GltfDocument& document, const tinygltf::Accessor& accessor, size_t size)
{
    const auto view = document.buffer_view(accessor.bufferView);
    const size_t stride = document.model().bufferViews[size_t(accessor.bufferView)].byteStride;
    return {view.data() + accessor.byteOffset, accessor.count, stride == 0 ? size : stride};
}

std::vector<size_t> sparse_targets(GltfDocument& document, const tinygltf::Accessor& accessor,
                                   const std::string& where)
{
    const auto& indices = accessor.sparse.indices;
    const auto view = document.buffer_view(indices.bufferView);
    const size_t size = stored_component_size(indices.componentType);
    std::vector<size_t> targets(size_t(accessor.sparse.count));
    for (size_t k = 0; k < targets.size(); ++k) {
        targets[k] = size_t(component(view.data() + size_t(indices.byteOffset) + k * size,
                                      indices.componentType, false));
        if (targets[k] >= accessor.count) {
            throw SceneError(fmt::format("{}: sparse index {} names element {} of {}; repair the "
                                         "file",
                                         where, k, targets[k], accessor.count));
        }
    }
    return targets;
}

std::string named(int accessor, const std::string& where)
{
    return fmt::format("accessors[{}] ({})", accessor, where);
}

}  // namespace

std::vector<float> accessor_floats(GltfDocument& document, int index, int components, float fill,
                                   const std::string& use)
{
    const tinygltf::Accessor& accessor = document.model().accessors[size_t(index)];
    const std::string where = named(index, use);
    const int stored = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    // The numbers of the types VEC2 to VEC4 are those of their components.
    if (accessor.type != components &&
        !(components == 4 && accessor.type == TINYGLTF_TYPE_VEC3 && fill != 0)) {
        throw SceneError(fmt::format("{}: has {} components an element, where {} belong; repair "
                                     "the file",
                                     where, stored, components));
    }
    if (accessor.bufferView < 0 && accessor.count > most_implied_elements) {
        throw SceneError(
            fmt::format("{}: {} elements without data; repair the file", where, accessor.count));
    }
    const size_t size = stored_component_size(accessor.componentType) * size_t(stored);
    Elements elements{nullptr, 0, size};
    if (accessor.bufferView >= 0) {
        elements = stored_elements(document, accessor, size);
    }
    std::vector<float> values(accessor.count * size_t(components), 0.0f);
    for (size_t k = 0; stored < components && k < accessor.count; ++k) {
        values[k * size_t(components) + size_t(components) - 1] = fill;
    }
    const bool is_plain = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT &&
                          elements.stride == size && stored == components && elements.count > 0;
    if (is_plain) {
        std::memcpy(values.data(), elements.bytes, values.size() * sizeof(float));
    } else {
        store_floats(accessor, elements, components, {}, values);
    }
    if (accessor.sparse.isSparse && accessor.sparse.count > 0) {
        const auto targets = sparse_targets(document, accessor, where);
        const auto view = document.buffer_view(accessor.sparse.values.bufferView);
        store_floats(
            accessor,
            {view.data() + size_t(accessor.sparse.values.byteOffset), targets.size(), size},
            components, targets, values);
    }
    return values;
}

std::vector<unsigned> accessor_indices(GltfDocument& document, int index, const std::string& use)
{
    const tinygltf::Accessor& accessor = document.model().accessors[size_t(index)];
    const std::string where = named(index, use);
    const int type = accessor.componentType;
    const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned) {
        throw SceneError(where + ": indices must be unsigned scalars; repair the file");
    }
    if (accessor.bufferView < 0 && accessor.count > most_implied_elements) {
        throw SceneError(
            fmt::format("{}: {} elements without data; repair the file", where, accessor.count));
    }
    const size_t size = stored_component_size(type);
    Elements elements{nullptr, 0, size};
    if (accessor.bufferView >= 0) {
        elements = stored_elements(document, accessor, size);
    }
    std::vector<unsigned> values(accessor.count, 0);
    const auto store = [&](const Elements& from, const std::vector<size_t>& to) {
        for (size_t k = 0; k < from.count; ++k) {
            values[to.empty() ? k : to[k]] =
                unsigned(component(from.bytes + k * from.stride, type, false));
        }
    };
    store(elements, {});
    if (accessor.sparse.isSparse && accessor.sparse.count > 0) {
        const auto targets = sparse_targets(document, accessor, where);
        const auto view = document.buffer_view(accessor.sparse.values.bufferView);
        store({view.data() + size_t(accessor.sparse.values.byteOffset), targets.size(), size},
              targets);
    }
    return values;
}

}  // namespace diptych
