// The trees that the walk of common/bvh.h descends.
#pragma once

#include "backends/scene_data.hpp"

namespace diptych {

// Fills bvh_nodes, bvh_items and the instances' root_node: a tree for each mesh, shared by its
// instances, and over them, at node 0, the top level, if the scene calls for EFFECT_INSTANCES.
// Depths stay within BVH_MESH_DEPTH and BVH_TOP_DEPTH whatever the geometry; a scene without
// triangles gets an empty node, one without instances an instance. Throws std::runtime_error when
// a limit of the layout is exceeded or Embree fails.
void build_bvh(SceneData& scene);

}  // namespace diptych
