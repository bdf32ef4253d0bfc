// A scene's buffers where the host's kernels find them.
#pragma once

#include "backends/scene_data.hpp"

#include <vector>

namespace diptych {

// Readable memory behind every pointer: a kernel may load from the start of a buffer that the scene
// left empty.
alignas(64) inline constexpr unsigned char no_data[512] = {};

// In the order of SCENE_BUFFERS; the scene must outlive their use.
inline std::vector<const void*> buffers_of(const SceneData& scene)
{
    static_assert(sizeof no_data >= sizeof(Settings));
    std::vector<const void*> buffers;
#define ADD_BUFFER(type, name) \
    buffers.push_back(scene.name.empty() ? static_cast<const void*>(no_data) : scene.name.data());
    SCENE_BUFFERS(ADD_BUFFER)
#undef ADD_BUFFER
    return buffers;
}

}  // namespace diptych
