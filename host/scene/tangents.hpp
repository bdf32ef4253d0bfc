// Tangents for normal maps.
#pragma once

#include "host/scene/scene_builder.hpp"

namespace diptych {

// Fills part.tangents from positions, normals and the texture coordinates that the normal map reads
// through `use`. The MikkTSpace convention: at each corner the direction of growing u in the
// triangle's plane is projected onto the vertex normal's plane and weighted by the corner's angle;
// the sum, normalised, is the tangent; the handedness w is +1 where cross(normal, tangent) points
// to the top of the image. Corners of opposite handedness never share a tangent: a vertex between
// them is duplicated. Departs from MikkTSpace in two points: vertices that the file holds apart
// stay apart even if equal, and corners are grouped by vertex, not by connectivity.
void derive_tangents(MeshPart& part, const TextureUse& use);

}  // namespace diptych
