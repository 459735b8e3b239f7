// Whether some cut shades across an edge that is hard in the input. Every edge is followed up by
// both its ends, as far as both its triangles are in some cut: this is exact over all cuts.
#include "crease/mesh_hierarchy.h"

#include <optional>
#include "hierarchy/attribute_links.h"
#include "hierarchy/hierarchy_walk.h"

#include <algorithm>
#include <string>
#include <tuple>

namespace crease {

namespace {

// A side of an edge: a triangle, and its corners at both ends.
struct Side {
  NodeId ends[2];  // leaves, the smaller one first
  std::uint32_t triangle = 0;
  std::uint8_t corners[2] = {};
};

class HardEdgeChecker {
 public:
  HardEdgeChecker(const MeshHierarchy& hierarchy, std::size_t layer)
      : hierarchy_(hierarchy),
        h_(hierarchy.vertices),
        number_(layer),
        ranges_(wedge_ranges(h_)),
        leaf_of_wedge_(leaves_of_wedges(h_, ranges_)),
        links_(hierarchy, layer, ranges_) {}

  Result<HardEdges> run() {
    const std::vector<Side> sides = find_sides();
    for (std::size_t first = 0; first < sides.size();) {
      std::size_t end = first + 1;
      while (end < sides.size() && sides[end].ends[0] == sides[first].ends[0] &&
             sides[end].ends[1] == sides[first].ends[1]) {
        ++end;
      }
      for (std::size_t a = first; a < end; ++a) {
        for (std::size_t b = a + 1; b < end; ++b) {
          if (auto broken = check(sides[a], sides[b])) return *broken;
        }
      }
      first = end;
    }
    return found_;
  }

 private:
  NodeId leaf(WedgeId wedge) const { return leaf_of_wedge_[index_of(wedge)]; }

  std::vector<Side> find_sides() const {
    std::vector<Side> sides;
    sides.reserve(h_.triangles.of_corner.size());
    for (std::uint32_t t = 0; t < h_.triangles.size(); ++t) {
      const std::array<WedgeId, 3> wedges = h_.triangles[t];
      for (std::uint8_t c = 0; c < 3; ++c) {
        std::uint8_t from = c, to = static_cast<std::uint8_t>((c + 1) % 3);
        if (leaf(wedges[from]) > leaf(wedges[to])) std::swap(from, to);
        sides.push_back({{leaf(wedges[from]), leaf(wedges[to])}, t, {from, to}});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.ends[0], a.ends[1], a.triangle, a.corners[0]) <
             std::tie(b.ends[0], b.ends[1], b.triangle, b.corners[0]);
    });
    return sides;
  }

  std::optional<Failure> check(const Side& a, const Side& b) {
    if (a.triangle == b.triangle) return std::nullopt;
    int soft_ends = 0;
    for (int end : {0, 1}) {
      if (attribute_at_leaf(a, end) == attribute_at_leaf(b, end)) return std::nullopt;  // not hard
    }
    for (int end : {0, 1}) {
      const SplitId s = where_joined(a, b, end);
      if (s == kNoSplit) continue;
      ++soft_ends;
      if (links_.are_linked(s, wedge(a, end), wedge(b, end))) continue;
      return fail(Error::Invalid, "split " + std::to_string(index_of(s)) +
                                      ": shades across the hard edge between triangles " +
                                      std::to_string(a.triangle) + " and " +
                                      std::to_string(b.triangle));
    }
    ++found_.count;
    found_.soft_at_one_end += soft_ends == 1 ? 1 : 0;
    found_.soft_at_both_ends += soft_ends == 2 ? 1 : 0;
    return std::nullopt;
  }

  WedgeId wedge(const Side& side, int end) const {
    return h_.triangles[side.triangle][side.corners[end]];
  }
  RelativeAttribute attribute_at_leaf(const Side& side, int end) const {
    return hierarchy_.attribute_at(number_, side.ends[end], wedge(side, end));
  }

  // The lowest node above the corner where another corner of its triangle stands, too: there it has
  // collapsed. kNoNode if there is none.
  NodeId where_collapsed(const Side& side, int end) const {
    NodeId lowest = kNoNode;
    for (std::size_t k : {1u, 2u}) {
      const WedgeId other = h_.triangles[side.triangle][(side.corners[end] + k) % 3];
      const NodeId both = lowest_common_ancestor(h_, side.ends[end], leaf(other));
      if (both != kNoNode && (lowest == kNoNode || both > lowest)) lowest = both;
    }
    return lowest;
  }

  // The split above which both sides have one attribute at this end while both are active.
  SplitId where_joined(const Side& a, const Side& b, int end) const {
    const NodeId stops[2] = {where_collapsed(a, end), where_collapsed(b, end)};
    RelativeAttribute of_a = attribute_at_leaf(a, end), of_b = attribute_at_leaf(b, end);
    for (NodeId n = a.ends[end]; !h_.is_root(n);) {
      const SplitId s = h_.split_above(n);
      const bool second = h_.is_second(n);
      n = h_.parent(n);
      if (n == stops[0] || n == stops[1]) return kNoSplit;
      of_a = hierarchy_.above(number_, s, second, of_a, wedge(a, end));
      of_b = hierarchy_.above(number_, s, second, of_b, wedge(b, end));
      if (of_a == of_b) return s;
    }
    return kNoSplit;
  }

  const MeshHierarchy& hierarchy_;
  const VertexHierarchy& h_;
  const std::size_t number_;
  const std::vector<WedgeRange> ranges_;
  const std::vector<NodeId> leaf_of_wedge_;
  AttributeLinks links_;
  HardEdges found_;
};

}  // namespace

Result<HardEdges> check_hard_edges(const MeshHierarchy& hierarchy) {
  HardEdges all;
  for (std::size_t l = 0; l < hierarchy.layers.size(); ++l) {
    if (hierarchy.layers[l].role != AttributeRole::Normal) continue;
    const Result<HardEdges> found = HardEdgeChecker(hierarchy, l).run();
    if (!found.ok()) return found;
    all.count += found->count;
    all.soft_at_one_end += found->soft_at_one_end;
    all.soft_at_both_ends += found->soft_at_both_ends;
  }
  return all;
}

}  // namespace crease
