// The attribute hierarchies' part of check_hierarchy().
#pragma once

#include "crease/mesh_hierarchy.h"
#include "crease/result.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace crease {

// Whether all arrays of all layers can be read: sizes, ranges, indices.
std::optional<Failure> check_attribute_sizes(const MeshHierarchy& hierarchy);

// Follows every corner from its leaf up as far as a cut can show it: it has an attribute everywhere
// and finds back down, and every attribute of every node is had by some corner. The vertex
// hierarchy and the sizes must hold. Time O(corners * depth).
std::optional<Failure> check_attributes(const MeshHierarchy& hierarchy, std::size_t layer,
                                        const std::vector<NodeId>& leaf_of_wedge);

}  // namespace crease
