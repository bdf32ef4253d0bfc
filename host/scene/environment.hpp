// The light that comes from everywhere: an image, or a sky of our own.
#pragma once

#include "backends/scene_data.hpp"
#include "host/scene/picture.hpp"

namespace diptych {

// Fills the environment's settings, texels and importance cells from a latitude-longitude map,
// turned by `rotation` radians about +Y. Returns the integral of its luminance over all directions.
double assemble_environment(const Picture& map, double rotation, float scale, SceneData& data);

// A neutral gradient: soft white at the horizon, a little blue above, grey ground.
Picture neutral_sky();

}  // namespace diptych
