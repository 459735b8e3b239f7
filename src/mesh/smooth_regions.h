// Smooth regions: maximal sets of triangles connected across smooth edges (G03 3.5.1).
//
// An edge is smooth between two triangles that have the same attributes of the layer at both of its
// ends. G03 asks as well that no two triangles of a region meet in an edge that is not smooth;
// where a crease ends inside the surface, or a Moebius strip has one, no partition does that.
// Regions here are what is connected.
#pragma once

#include "crease/mesh.h"
#include "mesh/corners_around.h"

#include <cstdint>
#include <vector>

namespace crease {

// Per triangle the smallest triangle of its region. Time O(corners * log(valence)).
std::vector<std::uint32_t> smooth_regions(const Mesh& mesh, const CornersAround& around,
                                          const AttributeLayer& layer);

}  // namespace crease
