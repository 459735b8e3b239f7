// Spheres and normal cones of all splits, from the leaves up.
#pragma once

#include "assemble/vertex_forest.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"

#include <vector>

namespace crease {

// Fills radius and cone of hierarchy.vertices.bounds; everything else of `hierarchy` is complete.
void bound_splits(const Mesh& snapped, const std::vector<Vec3i>& leaf_positions,
                  const VertexForest& forest, MeshHierarchy& hierarchy);

}  // namespace crease
