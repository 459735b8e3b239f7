#include "runtime/cut_oracle.h"

#include "hierarchy/hierarchy_walk.h"

#include <algorithm>
#include <map>

namespace crease {

namespace {

template <typename Corner>
void add_edges(const std::array<Corner, 3>& corners,
               std::vector<std::pair<Corner, Corner>>& edges) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner a = corners[k], b = corners[(k + 1) % 3];
    edges.emplace_back(std::min(a, b), std::max(a, b));
  }
}

// Those that are there an odd number of times.
template <typename Edge>
void keep_odd(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> odd;
  for (const Edge& edge : edges) {
    if (!odd.empty() && odd.back() == edge) {
      odd.pop_back();
    } else {
      odd.push_back(edge);
    }
  }
  edges = std::move(odd);
}

}  // namespace

CutOracle::CutOracle(const HierarchyCase& hierarchy_case) : case_(hierarchy_case) {
  const VertexHierarchy& h = hierarchy().vertices;
  const std::vector<WedgeRange> ranges = wedge_ranges(h);
  leaf_of_wedge_ = leaves_of_wedges(h, ranges);
  for (const WedgeRange& range : ranges) seen_.push_back(range.begin != range.end);
  done_.assign(h.split_count(), false);
  for (std::uint32_t t = 0; t < h.triangles.size(); ++t) {
    const auto& wedges = h.triangles[t];
    add_edges(std::array{leaf_of_wedge_[index_of(wedges[0])], leaf_of_wedge_[index_of(wedges[1])],
                         leaf_of_wedge_[index_of(wedges[2])]},
              border_);
  }
  keep_odd(border_);
}

void CutOracle::set(const Cut& cut) {
  for (std::size_t i = 0; i < cut.size(); ++i) {
    done_[index_of(case_.maps.split_of_contraction[i])] = !cut[i];
  }
}

std::vector<NodeEdge> CutOracle::border() const {
  std::vector<NodeEdge> edges;
  for (const auto& [a, b] : border_) {
    const NodeId now_a = active_ancestor(a), now_b = active_ancestor(b);
    if (now_a != now_b) edges.emplace_back(std::min(now_a, now_b), std::max(now_a, now_b));
  }
  keep_odd(edges);
  return edges;
}

NodeId CutOracle::active_ancestor(NodeId leaf) const {
  const VertexHierarchy& h = hierarchy().vertices;
  NodeId active = leaf;
  for (NodeId n = active; !h.is_root(n);) {
    const SplitId s = h.split_above(n);
    n = h.node_of_split[index_of(s)];
    if (!is_done(s)) active = n;
  }
  return active;
}

RelativeAttribute CutOracle::attribute(std::size_t layer, WedgeId wedge, NodeId node) const {
  const MeshHierarchy& h = hierarchy();
  RelativeAttribute a = h.at_leaf(layer, leaf_of_wedge_[index_of(wedge)], wedge);
  for (NodeId n = leaf_of_wedge_[index_of(wedge)]; n != node; n = h.vertices.parent(n)) {
    a = h.above(layer, h.vertices.split_above(n), h.vertices.is_second(n), a, wedge);
  }
  return a;
}

std::optional<OracleTriangle> CutOracle::triangle(TriangleId t) const {
  const auto& wedges = hierarchy().vertices.triangles[index_of(t)];
  OracleTriangle found;
  for (std::size_t k = 0; k < 3; ++k) found.nodes[k] = active_ancestor(wedges[k]);
  const auto& n = found.nodes;
  if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) return std::nullopt;
  for (std::size_t l = 0; l < hierarchy().layers.size(); ++l) {
    auto& at = found.relative.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) at[k] = attribute(l, wedges[k], n[k]);
  }
  return found;
}

bool CutOracle::is_derived(TriangleId t) const {
  const SplitId s = hierarchy().vertices.deriving_split(t);
  return s != kNoSplit && !is_done(s);
}

void walk_to(const CutOracle& oracle, ActiveCut& cut, std::mt19937_64& random) {
  const VertexHierarchy& h = oracle.hierarchy().vertices;
  const auto split_all = [&] {
    std::vector<std::uint32_t> slot_of_node(h.node_count(), kNoSlot);
    const auto note = [&](std::uint32_t slot) {
      if (slot == kNoSlot) return;
      const NodeId n = cut.vertices()[slot].node;
      if (n != kNoNode) slot_of_node[index_of(n)] = slot;
    };
    for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) note(slot);
    for (std::uint32_t s = 0; s < h.split_count(); ++s) {
      const NodeId n = h.node_of_split[s];
      if (!oracle.is_seen(n) || !oracle.is_done(SplitId{s}) || cut.is_done(SplitId{s})) continue;
      const std::uint32_t slot = slot_of_node[index_of(n)];
      if (slot == kNoSlot || random() % 8 == 0) continue;
      note(cut.split(slot));
      note(slot);
    }
  };
  const auto merge_all = [&] {
    for (std::uint32_t s = static_cast<std::uint32_t>(h.split_count()); s-- > 0;) {
      if (oracle.is_done(SplitId{s}) || !cut.can_merge(SplitId{s})) continue;
      if (random() % 8 != 0) cut.merge(SplitId{s});
    }
  };
  const auto arrived = [&] {
    for (std::uint32_t s = 0; s < h.split_count(); ++s) {
      if (oracle.is_seen(h.node_of_split[s]) &&
          oracle.is_done(SplitId{s}) != cut.is_done(SplitId{s})) {
        return false;
      }
    }
    return true;
  };
  while (!arrived()) {
    random() % 2 == 0 ? split_all() : merge_all();
  }
}

namespace {

std::string cracks_of(const CutOracle& oracle, const ActiveCut& cut) {
  std::vector<NodeEdge> edges;
  for (const ActiveTriangles& part : cut.parts()) {
    for (std::uint32_t i = 0; i < part.size(); ++i) {
      if (part.ids[i] == kNoTriangle) continue;
      const auto node = [&](std::size_t k) {
        return cut.vertices()[part.slots[3 * std::size_t(i) + k]].node;
      };
      add_edges(std::array{node(0), node(1), node(2)}, edges);
    }
  }
  keep_odd(edges);
  return edges == oracle.border() ? "" : "a crack";
}

// Which corners the lists say stand at each vertex.
std::string difference_of_lists(const ActiveCut& cut) {
  std::map<std::pair<std::size_t, std::uint32_t>, int> seen;
  const VertexHierarchy& h = cut.hierarchy().vertices;
  for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) {
    if (cut.vertices()[slot].node == kNoNode) continue;
    for (const CornerAt at : cut.corners_of(slot)) {
      const ActiveTriangles& part = cut.parts()[at.corner.part()];
      if (at.corner.triangle() >= part.size()) return "a corner beyond the triangles";
      const TriangleId t = part.ids[at.corner.triangle()];
      if (t == kNoTriangle) return "a corner of a hole";
      if (part.slots[at.corner.index()] != slot) return "a corner at another slot";
      if (h.triangles[index_of(t)][at.corner.corner()] != at.wedge) return "wedge";
      if (++seen[{at.corner.part(), at.corner.index()}] > 1) return "a corner twice";
    }
  }
  return seen.size() == 3 * cut.triangle_count() ? "" : "a corner in no list";
}

}  // namespace

std::string difference(const CutOracle& oracle, const ActiveCut& cut) {
  const MeshHierarchy& h = oracle.hierarchy();
  std::map<TriangleId, std::pair<Part, std::uint32_t>> place;
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    const ActiveTriangles& part = cut.parts()[p];
    for (std::uint32_t i = 0; i < part.size(); ++i) {
      if (part.ids[i] == kNoTriangle) continue;
      if (!place.try_emplace(part.ids[i], p, i).second) return "a triangle twice";
    }
  }
  for (std::uint32_t t = 0; t < h.vertices.triangles.size(); ++t) {
    const std::string of = " of triangle " + std::to_string(t);
    const std::optional<OracleTriangle> expected = oracle.triangle(TriangleId{t});
    const auto found = place.find(TriangleId{t});
    if (expected.has_value() != (found != place.end())) return "activity" + of;
    if (!expected) continue;
    const ActiveTriangles& part = cut.parts()[found->second.first];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = static_cast<std::uint32_t>(3 * found->second.second + k);
      const ActiveVertex& v = cut.vertices()[part.slots[corner]];
      if (v.node != expected->nodes[k]) return "vertex" + of;
      if (v.position != h.vertices.position_of(v.node)) return "position" + of;
      for (std::size_t l = 0; l < h.layers.size(); ++l) {
        const RelativeAttribute a = expected->relative[l][k];
        if (a >= h.layers[l].attribute_count(v.node)) return "missing attribute" + of;
        if (cut.value_index(part, corner, l) != h.value_index(l, v.node, a))
          return h.layers[l].name + of;
      }
    }
  }
  if (std::string cracks = cracks_of(oracle, cut); !cracks.empty()) return cracks;
  return difference_of_lists(cut);
}

}  // namespace crease
