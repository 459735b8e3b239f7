// DB03 phase I: which class every triangle has for life, and how every other layer is stored. The
// paper looks at the input alone; here the sequence is followed once, so that no class is broken
// by it later.
#pragma once

#include "assemble/sharing.h"
#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/progressive_arrays.h"
#include "crease/shading.h"

#include <cstdint>
#include <vector>

namespace crease {

struct Restructured {
  std::size_t normal_layer = 0;
  std::vector<TriangleKind> kind_of_triangle;
  std::vector<std::uint32_t> lost_triangles;  // those that ever vanish, in order
  // Per layer of the mesh; the normal layer's storage says nothing.
  std::vector<Sharing> sharing;
  std::vector<ProgressiveLayer::Storage> storage;
};

// Needs a normal layer. Time O(corners and changes), one Replay.
Restructured restructure(const Mesh& snapped, const ContractionSequence& sequence);

}  // namespace crease
