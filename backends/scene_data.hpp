// The only representation of a scene between the loaders and the devices: one vector per scene
// buffer, ready to upload.
#pragma once

#include "platform.h"

#include "backends/textures/texture_function.hpp"
#include "common/buffers.h"
#include "common/effects.h"

#include <array>
#include <string>
#include <vector>

namespace diptych {

struct SceneData {
#define SCENE_VECTOR(type, name) std::vector<type> name;
    SCENE_BUFFERS(SCENE_VECTOR)
#undef SCENE_VECTOR
    unsigned effects = 0;  // mask of EFFECT_*
    SceneTextures textures;

    // For people: not uploaded.
    std::vector<std::string> material_names;
    std::vector<std::string> instance_names;
    std::vector<std::string> notices;  // what the loader skipped, replaced or assumed, a line each
    size_t degenerate_triangles = 0;   // dropped: zero area
};

// Bytes of the buffers as they are now.
inline size_t bytes_of(const SceneData& scene)
{
    size_t bytes = 0;
#define ADD_BYTES(type, name) bytes += scene.name.size() * sizeof(type);
    SCENE_BUFFERS(ADD_BYTES)
#undef ADD_BYTES
    return bytes;
}

inline size_t texel_bytes_of(const SceneData& scene)
{
    return scene.texels_8.size() * sizeof(uint) + scene.texels_float.size() * sizeof(float4);
}

// How many planes each row of TEXTURE_BUFFERS has, and of TEXTURE_RESULT_BUFFERS.
inline std::array<int, 7> texture_planes(const SceneData& scene)
{
    const SceneTextures& textures = scene.textures;
    const int records = textures.records;
    return {textures.occlusion_results, 4 * textures.outputs,         records, records, records,
            textures.distances,         4 * int(textures.aovs.size())};
}
inline std::array<int, 2> texture_result_planes(const SceneData& scene)
{
    const bool has_textures = (scene.effects & EFFECT_PROCEDURAL) != 0;
    return {has_textures ? TEXTURE_FAULT_COUNT : 0, 4 * int(scene.textures.aovs.size())};
}

}  // namespace diptych
