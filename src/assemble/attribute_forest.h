// One layer's attribute hierarchy, contraction by contraction (G03 3.4).
#pragma once

#include "assemble/introduce_triangles.h"
#include "assemble/leaf_wedges.h"
#include "assemble/vertex_forest.h"
#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"
#include "crease/result.h"

#include <cstddef>

namespace crease {

// What all layers have in common.
struct AttributeInput {
  const Mesh& snapped;
  const ContractionSequence& sequence;
  const VertexForest& forest;
  const LeafWedges& wedges;
  const TriangleTimes& times;
  const VertexHierarchy& vertices;  // complete but for radii and cones
};

// Fails where a node has more attributes than a RelativeAttribute can tell apart. Time O(attributes
// of all nodes + introduced triangles).
Result<AttributeHierarchy> grow_attributes(const AttributeInput& input, std::size_t layer);

}  // namespace crease
