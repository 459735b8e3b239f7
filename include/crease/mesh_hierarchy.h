// The vertex hierarchy and, in parallel to it, an attribute hierarchy per layer (G03 3.3 to 3.6):
// everything that any cut needs. AdaptiveMesh moves a cut through it.
//
//   const VertexHierarchy& v = hierarchy.vertices;
//   NodeId n = v.root(0);
//   if (SplitId s = v.split_of(n); s != kNoSplit) {
//     Vec3i p = position_of_n + v.delta_of(v.first_child(s));       // where v_t stands
//     TriangleRange born = v.triangles_of(s);                       // become active
//     bool second = v.goes_to_second(s, wedge);                     // a corner that stood at n
//     a = hierarchy.below(layer, s, second, a, wedge);              // and its attribute
//   }
//
// Nodes, splits, wedges. Roots are the first nodes. Then split s makes two, v_t and v_u, the nodes
// root_count + 2 s and root_count + 2 s + 1; splits are numbered as their nodes are (breadth
// first), so a node that is split needs one bit, and the split is its rank. Leaves are the input
// vertices. Wedges are the corners of one input vertex that share their attributes in all layers.
// They are numbered along the leaves from left to right, so every subtree has a range of them, and
// the path bit of G03 is one comparison: the corner goes to v_u iff wedge >= second_wedge[s].
//
// Triangles keep their three leaf wedges for good. Those that no contraction collapses come first,
// then those introduced by split 0, by split 1, ... (the deepest of the three lowest
// common ancestors). A triangle is active iff its split is done; its corners stand at the active
// ancestors of its wedges' leaves.
//
// Attributes. At a node, the attributes of a layer are numbered 0 .. n-1: the relative index, which
// each active corner keeps. An attribute is at a node iff it is live there: some
// triangle has exactly one corner under the node and that corner has the attribute; this is exact,
// so what a cut can show is there (G03 figure 8) and nothing else is. Relative indices ascend with
// the smooth region (G03 3.5.1), so that few corner subgraphs cross. A layer tells how indices
// change up (parent maps) and down (their inverse, and a code where several attributes of one child
// became one). Nodes with one attribute, nearly all of a smooth mesh, need neither map nor code.
//
// The level that has the contractions 0 .. n-1 merged shows on every corner the value that
// apply_contractions() shows. Where the simplifier does otherwise than G03, its record decides: it
// does not join face normals, which never change (DB03 rule b). What it never saw, since only other
// cuts show it, goes by G03's rules. assemble/attribute_rules.h has both.
//
// A block has these arrays too: roots are the vertices at its band's coarse end, leaves
// those at the fine end, the first triangles those that stand at the coarse end; all ids are local.
// A decoder fills them front to back: it appends a flag per node, and per split two deltas, the
// introduced triangles and the attributes, breadth first as it decodes. Only wedges wait for the
// end of the block, since their numbers follow the leaves. Blocks then come and go in any order
// that respects the DAG: the roots of a block are leaves of coarser ones, with the same relative
// indices of attributes. The whole model is the case of one piece.
//
// Bytes per input vertex with one normal layer, on a smooth closed mesh of n vertices: n splits,
// 2 n nodes, 2 n triangles, n wedges. Left with the indices of 100,000 vertices, right with those
// of a block of 8,000. hierarchy_bytes() reports them for any mesh; docs/hierarchy.md has models.
//   triangles   3 wedges each                           12.8   9.8
//   deltas      3 numbers a node, 18 and 10 bits        13.5   7.5
//   splits      node 2.3, second wedge 2.1, bounds 14   18.4  17.4
//   bits        is_split, wide, triangles, derived       1.5   1.5
//   normals     4 a value, 2 n values, or an index       8.4   8.4
//   sum                                                 54.6  44.6
// Where the build did not round the normals they are 12 bytes each, 16 more a vertex.
//
// Room is left for one attribute at the children that becomes several at the parent (a bevel that
// is better shown as a hard edge): above() takes the wedge, so runs by wedge can say it, as they do
// for below().
#pragma once

#include "crease/compact_ranges.h"
#include "crease/contraction.h"
#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/packed_indices.h"
#include "crease/parent_maps.h"
#include "crease/result.h"
#include "crease/split_bounds.h"
#include "crease/stored_values.h"
#include "crease/vec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

enum class NodeId : std::uint32_t {};
enum class SplitId : std::uint32_t {};
enum class WedgeId : std::uint32_t {};

inline constexpr NodeId kNoNode{kNone};
inline constexpr SplitId kNoSplit{kNone};

// begin <= t < end.
struct TriangleRange {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t size() const { return end - begin; }
};

// Three leaf wedges a triangle.
struct TriangleWedges {
  PackedIndices<WedgeId> of_corner;

  std::array<WedgeId, 3> operator[](std::size_t t) const { return of_corner.three_from(3 * t); }
  std::size_t size() const { return of_corner.size() / 3; }
};

struct VertexHierarchy {
  Grid grid;
  std::uint32_t root_count = 0;
  RankedBits is_split;                  // per node: it has children
  PackedIndices<NodeId> node_of_split;  // ascending
  PackedIndices<WedgeId> second_wedge;  // per split: the first wedge under v_u
  std::vector<SplitBounds> bounds;      // per split
  std::vector<Vec3i> root_positions;    // grid units
  // Per node that is no root its position less its parent's, x, y and z plus half of the range of
  // so many bits; those that do not fit are in wide_deltas.
  PackedIndices<> deltas;
  RankedBits is_wide;
  std::vector<Vec3i> wide_deltas;
  std::vector<WedgeId> root_wedges;  // the first one under each root, and how many there are

  CompactRanges triangle_ranges{2};                // first those without a split, then per split
  TriangleWedges triangles;                        // corners in the input's order
  PackedIndices<MaterialId> material_of_triangle;  // or empty, as in Mesh
  PackedIndices<PartId> part_of_triangle;          // or empty
  // A derived triangle shows its geometric normal while its deriving split is not done.
  SparseLists<TriangleId> derived_of_split;
  RankedBits is_derived;                 // per triangle; empty if none ever is
  std::vector<SplitId> deriving_splits;  // of those, in order

  std::size_t split_count() const { return node_of_split.size(); }
  std::size_t node_count() const { return is_split.size(); }
  std::size_t wedge_count() const { return root_wedges.empty() ? 0 : index_of(root_wedges.back()); }
  NodeId root(std::uint32_t i) const { return NodeId{i}; }
  bool is_root(NodeId n) const { return index_of(n) < root_count; }
  // Where a corner stands when nothing is split. Time O(log(roots)).
  NodeId root_of(WedgeId wedge) const {
    const auto after = std::upper_bound(root_wedges.begin(), root_wedges.end(), wedge);
    return NodeId{static_cast<std::uint32_t>(after - root_wedges.begin()) - 1};
  }

  // Down. split_of() of a leaf is kNoSplit.
  SplitId split_of(NodeId n) const {
    return is_split.test(index_of(n)) ? SplitId{is_split.rank(index_of(n))} : kNoSplit;
  }
  NodeId child(SplitId s, bool second) const {
    return NodeId{root_count + 2 * static_cast<std::uint32_t>(s) + (second ? 1 : 0)};
  }
  NodeId first_child(SplitId s) const { return child(s, false); }
  NodeId second_child(SplitId s) const { return child(s, true); }
  // The path bit of a corner that stands at the node of s.
  bool goes_to_second(SplitId s, WedgeId wedge) const { return wedge >= second_wedge[index_of(s)]; }

  // Up. Not for roots.
  SplitId split_above(NodeId n) const {
    return SplitId{(static_cast<std::uint32_t>(n) - root_count) / 2};
  }
  bool is_second(NodeId n) const { return (static_cast<std::uint32_t>(n) - root_count) % 2 != 0; }
  NodeId parent(NodeId n) const { return node_of_split[index_of(split_above(n))]; }

  // Position of a node less that of its parent, grid units. Not for roots.
  Vec3i delta_of(NodeId n) const {
    const std::size_t i = index_of(n) - root_count;
    if (is_wide.test(i)) return wide_deltas[is_wide.rank(i)];
    const std::uint32_t half = 1u << (deltas.bits() - 1);
    const auto [x, y, z] = deltas.three_from(3 * i);
    return {static_cast<std::int32_t>(x - half), static_cast<std::int32_t>(y - half),
            static_cast<std::int32_t>(z - half)};
  }
  // From the root on; a cut keeps the positions of its nodes instead. Time O(depth).
  Vec3i position_of(NodeId n) const;

  // Triangles that become active with split s, and those that always are.
  TriangleRange triangles_of(SplitId s) const { return triangles_in(index_of(s) + 1); }
  TriangleRange coarse_triangles() const { return triangles_in(0); }
  // The split that derives a triangle, or kNoSplit.
  SplitId deriving_split(TriangleId t) const {
    if (is_derived.size() == 0 || !is_derived.test(index_of(t))) return kNoSplit;
    return deriving_splits[is_derived.rank(index_of(t))];
  }

 private:
  TriangleRange triangles_in(std::size_t key) const {
    const CompactRanges::Range range = triangle_ranges.range(key);
    return {range.begin, range.end};
  }
};

// At the corners of the wedges first_wedge and up to the next run's, the attribute at the child.
struct BranchRun {
  WedgeId first_wedge{};
  RelativeAttribute at_child = 0;
  bool operator==(const BranchRun&) const = default;
};

// One layer.
struct AttributeHierarchy {
  std::string name;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  std::uint32_t dimension = 1;

  CompactRanges attribute_ranges{1};  // per node: its attributes
  StoredValues values{{}, 1};
  PackedIndices<> value_of_attribute;  // or empty: attribute i has value i
  // Per attribute: it has its place in value_of_attribute; else its value is that of its parent. Or
  // empty: all have.
  RankedBits has_value;
  // Per wedge, at its leaf. Or empty: a leaf with several has a wedge for each, in their order.
  PackedIndices<RelativeAttribute> leaf_attribute;

  // Per split the relative index at v_s of each attribute of v_t, then of each one of v_u (the
  // parent maps of G03 3.6). Empty where neither has more than one and all become attribute 0, and
  // where v_s has none: then all are removed.
  ParentMaps parents_of_split;
  // Per split, where several attributes of v_t, or of v_u, became one: which one each wedge that
  // can stand there had (the branch codes of G03 3.6; a file needs ceil(log2 m) bits a run),
  // ascending.
  SparseLists<BranchRun> branches_of_split;

  // Where nodes have several attributes and values repeat, as on the walls of a city, hardly any
  // corner's value ever changes; that is told here, so that moves need not follow attributes. Else
  // both are empty.
  // Per wedge 1 + its value where that is the same at all nodes at which a cut can show it, or 0.
  PackedIndices<> constant_of_wedge;
  // Where a split does not keep values, all attributes of v_s, v_t and v_u have their own.
  // Per split: set only if every attribute of v_t and v_u that is not removed has its parent's
  // value.
  BitArray keeps_values;

  std::uint32_t attribute_count(NodeId n) const { return attribute_ranges.count(index_of(n)); }
  // Of an attribute by its place in attribute_ranges. The only one of a node always has its own.
  bool has_own_value(std::uint32_t i) const { return has_value.size() == 0 || has_value.test(i); }
  std::uint32_t own_value(std::uint32_t i) const { return stored_value(place_of_value(i)); }
  // The same in two steps: what has its own value side by side has its places so.
  std::uint32_t place_of_value(std::uint32_t i) const {
    return has_value.size() == 0 ? i : has_value.rank(i);
  }
  std::uint32_t stored_value(std::uint32_t place) const {
    return value_of_attribute.empty() ? place : value_of_attribute[place];
  }
};

struct MeshHierarchy {
  VertexHierarchy vertices;
  std::vector<AttributeHierarchy> layers;  // as in the mesh
  std::vector<Material> materials;
  std::vector<std::string> parts;
  UpAxis up = UpAxis::Unknown;
  Placement placement = Placement::Optimal;

  // The attribute at v_s of a corner that stands at v_t, or v_u if `second`, with attribute a
  // there. What it gives for an attribute that is removed is of no meaning: its triangles are not
  // active.
  RelativeAttribute above(std::size_t layer, SplitId s, bool second, RelativeAttribute a,
                          WedgeId wedge) const;
  // And back: the attribute at v_t, or v_u if `second`, of a corner that stands at v_s with a.
  RelativeAttribute below(std::size_t layer, SplitId s, bool second, RelativeAttribute a,
                          WedgeId wedge) const;
  // The attribute of a wedge at its leaf.
  RelativeAttribute at_leaf(std::size_t layer, NodeId leaf, WedgeId wedge) const;
  // The attribute at node n, which the wedge's leaf is under, of a corner that can stand there. It
  // is what a triangle that becomes active needs. Time O(1) if n has one attribute, else O(depth
  // from n to the next node that has one, or to the leaf).
  RelativeAttribute attribute_at(std::size_t layer, NodeId n, WedgeId wedge) const;
  // The number of an attribute's value in its layer, and the value. Time O(1), but O(depth) within
  // regions where values stay the same.
  std::uint32_t value_index(std::size_t layer, NodeId n, RelativeAttribute a) const;
  StoredValue value(std::size_t layer, NodeId n, RelativeAttribute a) const {
    return layers[layer].values[value_index(layer, n, a)];
  }

 private:
  RelativeAttribute attribute_far_below(std::size_t layer, NodeId n, WedgeId wedge) const;
};

// Where the bytes are.
struct HierarchyBytes {
  std::size_t triangles = 0;  // wedges of triangles, materials, parts, ranges, derived ones
  std::size_t positions = 0;  // deltas, roots
  std::size_t splits = 0;     // nodes, second wedges, bounds, bits
  std::size_t values = 0;     // attributes' values and indices
  // Ranges, leaf attributes, parent maps, branch runs, and where values stay.
  std::size_t attributes = 0;
  std::size_t total() const { return triangles + positions + splits + values + attributes; }
};
HierarchyBytes hierarchy_bytes(const MeshHierarchy& hierarchy);

// The first invariant that does not hold, in words: all that is said above of ranges and orders;
// errors monotone; spheres that hold those below; cones that hold the normals below; attributes
// exactly where they are live; maps and branches that fit the wedges; every triangle introduced
// where it collapses. Whoever moves in a hierarchy that passes need check nothing. Time near linear
// (O(triangles * depth) at worst), memory about the hierarchy's own.
Status check_hierarchy(const MeshHierarchy& hierarchy);

// Pairs of triangles at an edge of the input that is hard: they share no normal at either end.
struct HardEdges {
  std::size_t count = 0;
  // In some cut that has both triangles they share a normal at one end: a crease that ended at a
  // vertex is contracted from there (G03 figure 6 e).
  std::size_t soft_at_one_end = 0;
  // In some cut at both: a crease shorter than it was contracted from either side.
  std::size_t soft_at_both_ends = 0;
};

// No cut shades across an edge that is hard in the input and whose both triangles are there, but
// from where its crease ended: normals from both sides become one only at a contraction whose
// collapsed triangles link them, directly or by others. Else the first split where
// they do. Exact over all cuts. `hierarchy` must hold check_hierarchy(). Time O(edges * depth) at
// worst.
Result<HardEdges> check_hard_edges(const MeshHierarchy& hierarchy);

}  // namespace crease
