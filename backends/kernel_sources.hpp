// The OpenCL sources as the build flattened and embedded them (kernels_cl/CMakeLists.txt).
#pragma once

#include "common/stages/stages.h"

#include <string>

namespace diptych {

// The whole program of a stage, with #line directives naming files relative to the source tree.
std::string kernel_source(Stage stage);

enum class When { once, each_bounce, first_bounce, each_surface, each_layer, at_end };
inline bool is_of_bounce(When when)
{
    return when == When::each_bounce || when == When::each_surface;
}
When stage_when(Stage stage);

// Effects of which a scene must call for one to make the stage run; 0: it always runs.
unsigned stage_needs(Stage stage);

inline bool is_active(Stage stage, unsigned effects)
{
    return stage_needs(stage) == 0 || (stage_needs(stage) & effects) != 0;
}

}  // namespace diptych
