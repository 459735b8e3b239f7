// What attribute errors are worth beside distances, from how large the triangles are.
#pragma once

#include "simplify/work_mesh.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crease::simplification {

// Of the live triangles, in grid units.
struct Extent {
  double mean_area = 0;                 // but for a few that are far larger (triangle_sizes.h)
  double typical_area = 0;              // about the geometric mean of all
  std::vector<double> length_of_layer;  // that one unit of its texture takes; 0 for other layers
};
Extent measure_extent(const WorkMesh& work);

// Sets the layers' length_per_unit and same; `left`: the share of the input's triangles that is
// left. Returns what a normal off by one radian is worth, grid units.
double set_scales(WorkMesh& work, const Extent& extent, double normal_weight, double left);

}  // namespace crease::simplification
