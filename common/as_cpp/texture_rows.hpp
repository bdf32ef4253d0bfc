// The rows of TEXTURE_BUFFERS by name, and who writes them.
#pragma once

#include "platform.h"

#include "common/buffers.h"
#include "common/stages/stages.h"

namespace diptych {

enum TextureRowName {
#define TEXTURE_ROW_NAME(type, name) row_##name,
    TEXTURE_BUFFERS(TEXTURE_ROW_NAME)
#undef TEXTURE_ROW_NAME
};

// The row of TEXTURE_BUFFERS that a stage writes; -1: none.
constexpr int texture_row_of(Stage stage)
{
    if (stage == STAGE_trace_texture_rays) return row_occlusion_result;
    return stage == STAGE_evaluate_textures ? int(row_texture_result) : -1;
}

}  // namespace diptych
