// What attribute errors are worth beside distances, from how large the triangles are.
#pragma once

#include "simplify/work_mesh.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crease::simplification {

// Of the live triangles in space and, by layer, of their texture coordinates.
struct Extent {
  std::size_t triangles = 0;
  double area = 0;                    // grid units squared
  double typical_area = 0;            // of a triangle: about the geometric mean of all
  std::vector<double> area_of_layer;  // texture units squared; 0 for other layers

  double triangle_area() const { return std::max(area / double(triangles), 1e-9); }
};
Extent measure_extent(const WorkMesh& work);

// Sets the layers' length_per_unit and same; `left`: the share of the input's triangles that is
// left. Returns what a normal off by one radian is worth, grid units.
double set_scales(WorkMesh& work, const Extent& extent, double normal_weight, double left);

}  // namespace crease::simplification
