// What an adaptive mesh shows at a cut, by the plain definition: every input triangle
// with its leaf corners replaced by their active ancestors, kept iff the three differ.
//
//   CutOracle oracle(hierarchy_case);
//   oracle.set(random_cut(hierarchy_case, random));
//   walk_to(oracle, active_cut);
//   CHECK(difference(oracle, active_cut) == "");
#pragma once

#include "pipeline/hierarchy_case.h"
#include "runtime/active_cut.h"

#include <array>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace crease {

struct OracleTriangle {
  std::array<NodeId, 3> nodes{};
  std::vector<std::array<RelativeAttribute, 3>> relative;  // per layer
};

using NodeEdge = std::pair<NodeId, NodeId>;  // the smaller one first

class CutOracle {
 public:
  explicit CutOracle(const HierarchyCase& hierarchy_case);

  const HierarchyCase& hierarchy_case() const { return case_; }
  const MeshHierarchy& hierarchy() const { return case_.hierarchy; }
  void set(const Cut& cut);
  void set_done(std::vector<bool> done) { done_ = std::move(done); }
  bool is_done(SplitId s) const { return done_[index_of(s)]; }
  // It has triangles; else no cut can show it.
  bool is_seen(NodeId n) const { return seen_[index_of(n)]; }

  NodeId active_ancestor(NodeId leaf) const;
  NodeId active_ancestor(WedgeId wedge) const {
    return active_ancestor(leaf_of_wedge_[index_of(wedge)]);
  }
  // Where the input's border is now: edges of an odd number of its triangles, as far as they have
  // not met others or shrunk to a vertex.
  std::vector<NodeEdge> border() const;
  // By walking up from the leaf (MeshHierarchy::above).
  RelativeAttribute attribute(std::size_t layer, WedgeId wedge, NodeId node) const;
  // Nothing if two corners stand at one node.
  std::optional<OracleTriangle> triangle(TriangleId t) const;
  bool is_derived(TriangleId t) const;

 private:
  const HierarchyCase& case_;
  std::vector<bool> done_, seen_;
  std::vector<NodeId> leaf_of_wedge_;
  std::vector<NodeEdge> border_;  // at full resolution
};

// By splits from above and merges from below, in an order that `random` mixes.
void walk_to(const CutOracle& oracle, ActiveCut& cut, std::mt19937_64& random);

// Empty if the cut has exactly the oracle's triangles, positions and attributes, its lists of
// corners are right, and it has no crack: an edge has an odd number of triangles iff an odd number
// of the input's border edges has come to lie there.
std::string difference(const CutOracle& oracle, const ActiveCut& cut);

}  // namespace crease
