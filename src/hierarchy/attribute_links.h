// Which attributes a contraction may make one: those that the triangles it collapses
// link, each having one at v_t and one at v_u. Attributes of one value are one, linked or not.
#pragma once

#include "crease/mesh_hierarchy.h"
#include "hierarchy/hierarchy_walk.h"

#include <cstdint>
#include <vector>

namespace crease {

class AttributeLinks {
 public:
  AttributeLinks(const MeshHierarchy& hierarchy, std::size_t layer,
                 const std::vector<WedgeRange>& ranges)
      : hierarchy_(hierarchy), number_(layer), ranges_(ranges) {}

  // Of two corners that stand at v_t or v_u.
  bool are_linked(SplitId s, WedgeId a, WedgeId b);

 private:
  // Members are the attributes at v_t, then those at v_u.
  void link_all(SplitId s);
  void link_corners(SplitId s);
  void link_equal_values(SplitId s);
  bool is_under(NodeId n, WedgeId wedge) const;
  std::uint32_t member(SplitId s, bool second, WedgeId wedge) const;
  std::uint32_t root(std::uint32_t m);

  const MeshHierarchy& hierarchy_;
  const std::size_t number_;
  const std::vector<WedgeRange>& ranges_;
  SplitId linked_split_ = kNoSplit;
  std::uint32_t first_count_ = 0;  // attributes at v_t
  std::vector<std::uint32_t> linked_to_, by_value_;
};

}  // namespace crease
