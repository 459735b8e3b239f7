// A layer's attributes as they were grown, by births and contractions; and their place in the
// arrays.
#pragma once

#include "assemble/attribute_forest.h"
#include "assemble/attribute_rules.h"
#include "crease/ids.h"
#include "crease/mesh_hierarchy.h"

#include <cstdint>
#include <vector>

namespace crease {

struct Slice {
  std::uint32_t first = 0, count = 0;
};

struct GrownAttributes {
  struct AtNode {
    std::uint32_t set;  // a leaf attribute of it
    AttributeId id;     // what it is at this node
  };
  std::vector<Slice> at_birth;  // in at_node
  std::vector<AtNode> at_node;
  // As in AttributeHierarchy; per contraction where its own are.
  std::vector<RelativeAttribute> parents;
  std::vector<Slice> parents_at;
  std::vector<BranchRun> branches;
  std::vector<Slice> branches_at;
  std::vector<bool> varies_of_wedge;  // its id changes while a cut can show it
};

// From births to nodes, from contractions to splits, from ids to values.
AttributeHierarchy number_attributes(const AttributeInput& input, std::size_t layer,
                                     const RuledValues& values, const GrownAttributes& grown);

}  // namespace crease
