#include "hierarchy/corner_subgraph.h"

#include <algorithm>

namespace crease {

namespace {

using Parents = std::vector<RelativeAttribute>;

bool contains(const Parents& parents, RelativeAttribute p) {
  return std::find(parents.begin(), parents.end(), p) != parents.end();
}

bool ascends(const Parents& parents) {
  RelativeAttribute last = 0;
  for (RelativeAttribute p : parents) {
    if (p == kRemoved) continue;
    if (p < last) return false;
    last = p;
  }
  return true;
}

std::vector<AttributeSymbol> symbols_of(const Parents& own, const Parents& other) {
  std::vector<AttributeSymbol> symbols;
  RelativeAttribute last = kRemoved;
  for (RelativeAttribute p : own) {
    if (p == kRemoved) {
      symbols.push_back(AttributeSymbol::Remove);
      continue;
    }
    symbols.push_back(p == last            ? AttributeSymbol::More
                      : contains(other, p) ? AttributeSymbol::Merge
                                           : AttributeSymbol::Copy);
    last = p;
  }
  return symbols;
}

// One side while decoding.
struct Stream {
  const std::vector<AttributeSymbol>& symbols;
  Parents parents;

  // Takes what has its parent already; then the next symbol opens a new one, or there is none.
  void skip(RelativeAttribute last) {
    while (parents.size() < symbols.size()) {
      const AttributeSymbol next = symbols[parents.size()];
      if (next == AttributeSymbol::Copy || next == AttributeSymbol::Merge) return;
      if (next == AttributeSymbol::More && last == kRemoved) return;  // fits nothing before it
      parents.push_back(next == AttributeSymbol::Remove ? kRemoved : last);
    }
  }
  bool is_done() const { return parents.size() == symbols.size(); }
  AttributeSymbol head() const { return symbols[parents.size()]; }
};

}  // namespace

CornerSubgraph corner_subgraph(const MeshHierarchy& hierarchy, std::size_t layer, SplitId s) {
  const VertexHierarchy& v = hierarchy.vertices;
  const AttributeHierarchy& attributes = hierarchy.layers[layer];
  const std::uint32_t at_t = attributes.attribute_count(v.first_child(s));
  const std::uint32_t at_u = attributes.attribute_count(v.second_child(s));
  const ParentMaps::Map parents = attributes.parents_of_split.of(index_of(s));
  if (!parents.empty()) {
    CornerSubgraph graph;
    for (std::size_t i = 0; i < at_t; ++i) graph.parents_of_first.push_back(parents[i]);
    for (std::size_t i = at_t; i < at_t + at_u; ++i) graph.parents_of_second.push_back(parents[i]);
    return graph;
  }
  const bool none = attributes.attribute_count(v.node_of_split[index_of(s)]) == 0;
  const RelativeAttribute all = none ? kRemoved : RelativeAttribute{0};
  return {Parents(at_t, all), Parents(at_u, all)};
}

bool has_crossing(const CornerSubgraph& graph) {
  return !ascends(graph.parents_of_first) || !ascends(graph.parents_of_second);
}

SubgraphCode encode_subgraph(const CornerSubgraph& graph) {
  SubgraphCode code;
  code.is_explicit = has_crossing(graph);
  if (code.is_explicit) {
    code.graph = graph;
    return code;
  }
  const Parents &t = graph.parents_of_first, &u = graph.parents_of_second;
  code.first = symbols_of(t, u);
  code.second = symbols_of(u, t);
  // Parents that only one side has, in order, as the decoder meets them.
  std::size_t i = 0, j = 0;
  const auto skip = [](const std::vector<AttributeSymbol>& symbols, std::size_t& k) {
    while (k < symbols.size() && symbols[k] != AttributeSymbol::Copy &&
           symbols[k] != AttributeSymbol::Merge) {
      ++k;
    }
    return k < symbols.size();
  };
  while (true) {
    const bool has_t = skip(code.first, i), has_u = skip(code.second, j);
    if (!has_t && !has_u) return code;
    const bool copies_t = has_t && code.first[i] == AttributeSymbol::Copy;
    const bool copies_u = has_u && code.second[j] == AttributeSymbol::Copy;
    if (copies_t && copies_u) code.second_goes_first.push_back(u[j] < t[i]);
    const bool take_u = copies_u && (!copies_t || u[j] < t[i]);
    if (take_u) {
      ++j;
    } else if (copies_t) {
      ++i;
    } else {
      ++i;
      ++j;
    }
  }
}

std::optional<CornerSubgraph> decode_subgraph(const SubgraphCode& code) {
  if (code.is_explicit) return code.graph;
  Stream t{code.first, {}}, u{code.second, {}};
  RelativeAttribute last_t = kRemoved, last_u = kRemoved, next = 0;
  std::size_t bit = 0;
  while (true) {
    t.skip(last_t);
    u.skip(last_u);
    if (t.is_done() && u.is_done()) return CornerSubgraph{t.parents, u.parents};
    const bool copies_t = !t.is_done() && t.head() == AttributeSymbol::Copy;
    const bool copies_u = !u.is_done() && u.head() == AttributeSymbol::Copy;
    const bool both_merge = !t.is_done() && !u.is_done() && t.head() == AttributeSymbol::Merge &&
                            u.head() == AttributeSymbol::Merge;
    bool take_u = copies_u && !copies_t;
    if (copies_t && copies_u) {
      if (bit == code.second_goes_first.size()) return std::nullopt;
      take_u = code.second_goes_first[bit++];
    }
    if (!copies_t && !copies_u && !both_merge) return std::nullopt;
    if (take_u || both_merge) u.parents.push_back(last_u = next);
    if (!take_u) t.parents.push_back(last_t = next);
    ++next;
  }
}

}  // namespace crease
