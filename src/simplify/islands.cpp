// Small regions of a material in another stay whole, or go: see hierarchy/island.h.
#include "hierarchy/island.h"
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace crease::simplification {

namespace {

// A rectangle has 2 triangles. One of more than few, up to nine times as many, is broken only by
// what costs more than its share of the whole, by the second power.
constexpr double kFewTriangles = 4;

// Of its area: where it changes by less nothing breaks it.
constexpr double kBreakingChange = 0.1;

// What it lies in is so many times as large.
constexpr double kLarger = 3;

// What is left of one is left as it is where it costs so many times its price to fold it away or
// out of its plane.
constexpr double kMostToClose = 8;

}  // namespace

// The triangle on the other side of t's edge from its corner c on, or kNone: none or several.
PatchSimplifier::Index PatchSimplifier::across(Index t, Index c) const {
  const Index v = vertex_of_corner_[4 * t + c], w = vertex_of_corner_[4 * t + c + 1];
  Index other = kNone;
  for (const Index corner : corners_of(v)) {
    const Index u = triangle_of(corner);
    if (u == t || !has_corner_at(u, w)) continue;
    if (other != kNone) return kNone;
    other = u;
  }
  return other;
}

// Where a window is set back its wall is beyond what leads to it: what lies in nearly the same
// plane as the member, up to so many triangles away from `other`.
void PatchSimplifier::find_beyond(Index member, Index other, int steps) {
  for (Index c = 0; c < 3; ++c) {
    const Index next = across(other, c);
    if (next == kNone || next == member || category_of(next) == category_of(member)) continue;
    const Vec3d& n = facing_[member].normal;
    if (!are_parallel(n, facing_[next].normal)) {
      if (steps > 1) find_beyond(member, next, steps - 1);
      continue;
    }
    const double away =
        dot(n, positions_[vertex_of_corner_[4 * next]] - positions_[vertex_of_corner_[4 * member]]);
    if (is_in_plane(away, facing_[member].area)) region_borders_.push_back(next);
  }
}

// The triangles of t's category in its plane, that are connected there, until they are too many or
// the area is `enough`.
PatchSimplifier::Region PatchSimplifier::region_around(Index t, double enough) {
  region_of_.resize(triangle_alive_.size(), 0);
  const Index number = ++region_count_;
  Region region;
  region_members_.assign(1, t);
  region_borders_.clear();
  region_of_[t] = number;
  for (std::size_t i = 0; i < region_members_.size(); ++i) {
    const Index member = region_members_[i];
    region.area += facing_[member].area;
    if (region.area > enough || region_members_.size() > kMostOfIsland) {
      region.is_large = true;
      return region;
    }
    for (Index c = 0; c < 3; ++c) {
      region.is_locked |= vertices_[vertex_of_corner_[4 * member + c]].locked;
      const Index other = across(member, c);
      if (other == kNone || region_of_[other] == number) continue;
      const bool coplanar = are_parallel(facing_[member].normal, facing_[other].normal);
      if (category_of(other) != category_of(t)) {
        if (coplanar) {
          region_borders_.push_back(other);
        } else {
          find_beyond(member, other, 2);
        }
        continue;
      }
      region.is_flat &= coplanar;
      if (!coplanar) continue;
      region_of_[other] = number;
      region_members_.push_back(other);
    }
  }
  return region;
}

// The island that t is of, or one without members; none has a larger area than `most`.
PatchSimplifier::Island PatchSimplifier::island_around(Index t, double most) {
  const Region region = region_around(t, most);
  if (region.is_large || !region.is_flat || region_borders_.empty()) return {};
  Island island{region.area, region.is_locked, false, region_members_};
  const std::vector<Index> borders = region_borders_;
  const Index first = region_count_;
  for (const Index other : borders) {
    if (region_of_[other] > first) continue;  // known to be larger
    const Region around = region_around(other, kLarger * region.area);
    if (!around.is_large && !around.is_locked) return {};
  }
  return island;
}

double PatchSimplifier::price_of(const Island& island) const {
  return steering_.normal_scale * steering_.normal_scale * island.area /
         double(island.members.size());
}

// The island that the contraction of the ring breaks, or none. One that it only pushes aside comes
// before one that it takes triangles from.
PatchSimplifier::Island PatchSimplifier::island_broken_by(Index a, Index b, const Placed& placed) {
  if (work_->category_of_triangle.empty()) return {};
  if (category_around_[a] == category_around_[b] && category_around_[a] != kNone) return {};
  const auto is_broken = [&](const Island& island) {
    if (island.members.empty()) return false;
    const double over = std::max(1.0, double(island.members.size()) / kFewTriangles);
    return placed.cost >= over * over * price_of(island);
  };
  // Of one that so much breaks: is_broken() by what its triangles are at the least.
  const double most =
      kFewTriangles * placed.cost / (steering_.normal_scale * steering_.normal_scale);
  Island inside;
  const Index first = region_count_;
  const auto is_known = [&](Index t) { return t < region_of_.size() && region_of_[t] > first; };
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    if (placed.position == positions_[i < ring_kept_ ? a : b]) continue;
    const Index t = ring_[i].triangle;
    const double after = 0.5 * length(normal_if_moved(ring_[i], placed.position));
    const double change = std::abs(after - facing_[t].area);
    if (change <= kBreakingChange * facing_[t].area || is_known(t)) continue;
    Island island = island_around(t, most);
    if (!is_broken(island)) continue;
    if (loses_triangles(island)) {
      inside = std::move(island);
    } else if (change > kBreakingChange * island.area) {
      island.is_aside = true;
      return island;
    }
  }
  for (const auto& [t, third] : vanishing_) {
    if (is_known(t)) continue;
    Island island = island_around(t, most);
    if (is_broken(island)) return island;
  }
  return inside;
}

// With the contraction of the ring.
bool PatchSimplifier::loses_triangles(const Island& island) const {
  for (const Vanishing& v : vanishing_) {
    const auto& members = island.members;
    if (std::find(members.begin(), members.end(), v.triangle) != members.end()) return true;
  }
  return false;
}

// What it costs to fold the pair into one of its ends.
PatchSimplifier::Placed PatchSimplifier::place_at_end(const Candidate& pair, int end) {
  const Vec3d target = positions_[end == 0 ? pair.a : pair.b];
  find_ring(pair.a, pair.b);
  ++ring_count_;
  blocks_.resize(std::max(blocks_.size(), ring_.size() / RingBlock::kTriangles + 1));
  Placed placed{0, pair.cost_of_other[end], target, false};
  placed.cost = placed.free_cost + ring_cost(pair.a, pair.b, target, HUGE_VAL) +
                vanishing_cost(pair.a, pair.b);
  return placed;
}

// Others stay where they are while one is closed.
bool PatchSimplifier::pushes_another(const Island& island, const Candidate& pair,
                                     const Placed& placed) {
  const Island other = island_broken_by(pair.a, pair.b, placed);
  return other.is_aside && other.members != island.members;
}

// The rest of it; whether there was any.
bool PatchSimplifier::close_island(const Island& island, double cost) {
  const double most = kMostToClose * std::max(cost, price_of(island));
  const std::size_t before = result_.contractions.size();
  for (;;) {
    Index a = kNone, b = kNone;
    Placed best{HUGE_VAL, HUGE_VAL, {}, false};
    bool best_pushes = true;
    for (const Index t : island.members) {
      if (!triangle_alive_[t]) continue;
      for (Index corner = 4 * t; corner != 4 * t + 3; ++corner) {
        const Index v = vertex_of_corner_[corner], w = vertex_of_corner_[corner + 1];
        Candidate pair{std::min(v, w), std::max(v, w), 0, {}, 0, 0, {}};
        find_costs_of_others(pair);
        for (const int end : {0, 1}) {
          const Placed placed = place_at_end(pair, end);
          if (placed.cost >= best.cost && !best_pushes) continue;
          const bool pushes = pushes_another(island, pair, placed);
          if (pushes > best_pushes || (pushes == best_pushes && placed.cost >= best.cost)) continue;
          best_pushes = pushes;
          best = placed;
          a = pair.a;
          b = pair.b;
        }
      }
    }
    if (a == kNone) break;
    const double off = (surface_[a] + surface_[b]).at(best.position);
    if (off + best.cost - best.free_cost > most) break;
    find_ring(a, b);
    measure_witnesses(a, b, best);
    contract(a, b, best.position, cost);
  }
  return result_.contractions.size() > before;
}

}  // namespace crease::simplification
