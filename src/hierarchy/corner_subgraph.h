// The corner subgraph of a split, and its code of one symbol an attribute (G03 3.5).
//
//   CornerSubgraph g = corner_subgraph(hierarchy, layer, s);
//   SubgraphCode code = encode_subgraph(g);
//   assert(*decode_subgraph(code) == g);
//
//       v_t   v_s   v_u         v_t, v_u: attributes from top to bottom, as their indices ascend.
//        0----.                 R: no parent. C: the first child of a parent that the other side
//        1----0-----0           has no part in. M: the first child of one that it has. X: same
//        2    1-----1           parent as the attribute before it.
//
//    v_t: M X R    v_u: M C
//
// This differs from G03 in two places. There X marks all of three or more that merge, and a bit
// follows each to tell where they end; here X marks the second and later ones of a side, so that
// symbols need no bits between them and a parent may have all its children on one side. And where
// both sides have a C next, their parents' order is that of the smooth regions, which the symbols
// do not tell: a bit says which comes first.
//
// No two edges of the graph cross where the order is consistent. Where it is not (a Moebius strip
// with a crease, G03 figure 10), the code is the graph itself, and flagged.
#pragma once

#include "crease/mesh_hierarchy.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace crease {

struct CornerSubgraph {
  std::vector<RelativeAttribute> parents_of_first;   // per attribute of v_t, or kRemoved
  std::vector<RelativeAttribute> parents_of_second;  // per attribute of v_u
  bool operator==(const CornerSubgraph&) const = default;
};

CornerSubgraph corner_subgraph(const MeshHierarchy& hierarchy, std::size_t layer, SplitId s);

// Whether two edges cross: then symbols cannot say it.
bool has_crossing(const CornerSubgraph& graph);

enum class AttributeSymbol : std::uint8_t { Remove, Copy, Merge, More };  // R, C, M, X

struct SubgraphCode {
  bool is_explicit = false;
  std::vector<AttributeSymbol> first, second;  // one per attribute of v_t, of v_u
  std::vector<bool> second_goes_first;         // for every two C that face each other
  CornerSubgraph graph;                        // if explicit
};

SubgraphCode encode_subgraph(const CornerSubgraph& graph);

// Nothing if the symbols fit no graph.
std::optional<CornerSubgraph> decode_subgraph(const SubgraphCode& code);

}  // namespace crease
