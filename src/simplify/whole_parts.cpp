// Small parts stay whole, or go: see hierarchy/whole_part.h.
#include "hierarchy/resting_parts.h"
#include "hierarchy/whole_part.h"
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace crease::simplification {

namespace {

// One with more triangles will not be down to few when the pass ends.
constexpr std::uint32_t kNotSmall = 512;

}  // namespace

void PatchSimplifier::load_parts() {
  parts_.clear();
  if (work_->part_count < 2) return;
  const auto part_vertex = [&](Index v) { return work_->part_of_vertex[vertices_[v].global]; };
  const Index n = static_cast<Index>(vertices_.size());
  Index small = 0;
  while (small < n && work_->triangles_of_part[part_vertex(small)] > kNotSmall) ++small;
  if (small == n) return;

  part_of_.resize(n);
  next_in_part_.resize(n);
  std::vector<Index> last;  // of its vertices, so far
  Index* const known = local_of_vertex_.data();
  for (Index v = 0; v < n; ++v) {
    Index& part = known[part_vertex(v)];
    if (part == kNone) {
      part = static_cast<Index>(parts_.size());
      Part& own = parts_.emplace_back();
      own.triangles = work_->triangles_of_part[part_vertex(v)];
      own.whole = own.triangles <= kNotSmall;
      last.push_back(v);
      next_in_part_[v] = v;
    }
    part_of_[v] = part;
    if (vertices_[v].locked) parts_[part].whole = false;
    next_in_part_[v] = std::exchange(next_in_part_[last[part]], v);
    last[part] = v;
  }
  for (Index v = 0; v < n; ++v) known[part_vertex(v)] = kNone;  // as it was

  std::vector<PartDamage> damages(parts_.size());
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    const Index* v = &vertex_of_corner_[4 * t];
    if (!parts_[part_of_[v[0]]].whole) continue;
    damages[part_of_[v[0]]].add(positions_[v[0]], positions_[v[1]], positions_[v[2]]);
  }
  std::vector<PartBox> boxes(parts_.size());
  for (Index v = 0; v < n; ++v) boxes[part_of_[v]].add(positions_[v]);
  const std::vector<Index> rests_on = only_contacts(boxes);
  for (Index i = 0; i < parts_.size(); ++i) {
    const Vec3d half = boxes[i].half();
    parts_[i].damage = damages[i].distances();
    parts_[i].loss = damages[i].all(steering_.normal_scale);
    parts_[i].reach2 = dot(half, half);
    if (rests_on[i] == kNone || !parts_[i].whole) continue;
    parts_[i].next_on_same = std::exchange(parts_[rests_on[i]].first_on_it, i);
  }
}

PatchSimplifier::Index PatchSimplifier::part_at(Index v) {
  Index& part = part_of_[v];
  while (parts_[part].into != kNone) part = parts_[part].into;
  return part;
}

// If `kept` and `removed` become one, and that many triangles vanish.
void PatchSimplifier::contract_parts(Index kept, Index removed) {
  if (parts_.empty()) return;
  const Index into = part_at(kept), other = part_at(removed);
  Part& part = parts_[into];
  if (into != other) {
    parts_[other].into = into;
    part.damage += parts_[other].damage;
    part.loss += parts_[other].loss;
    part.reach2 = std::max(part.reach2, parts_[other].reach2);
    part.triangles += parts_[other].triangles;
    part.whole = part.whole && parts_[other].whole;
    Index* end = &part.first_on_it;
    while (*end != kNone) end = &parts_[*end].next_on_same;
    *end = parts_[other].first_on_it;
    std::swap(next_in_part_[kept], next_in_part_[removed]);
  }
  part.triangles -= static_cast<Index>(vanishing_.size());
}

// The part that a contraction of this cost breaks, or kNone. One that joins parts may break the
// larger one.
PatchSimplifier::Index PatchSimplifier::broken_by(Index a, Index b, double cost) {
  if (parts_.empty()) return kNone;
  const Index of_a = part_at(a), of_b = part_at(b);
  const Index larger = parts_[of_a].damage > parts_[of_b].damage ? of_a : of_b;
  const Part& part = parts_[larger];
  const bool may_go = part.whole && part.triangles < live_triangles_;
  return may_go && breaks_part(cost, part.damage, part.triangles) ? larger : kNone;
}

// What a part costs at the least on which others rest: they go before it.
double PatchSimplifier::price_of_what_rests_on(Index part, Index but) const {
  double price = 0;
  for (Index i = parts_[part].first_on_it; i != kNone; i = parts_[i].next_on_same) {
    const Part& on_it = parts_[i];
    if (i == but || !on_it.whole || on_it.into != kNone || on_it.triangles == 0) continue;
    // By then it has no more triangles than a small one.
    const std::size_t few = std::min<std::size_t>(on_it.triangles, std::size_t(kSmallPart));
    const double own = std::max(price_of_part(on_it.loss, few), steering_.far_area * on_it.reach2);
    price = std::max(price, kAfter * own);
  }
  return price;
}

// One that breaks a part costs at least the part's price, and no less than what is as far away as
// the part is large (far_area.h).
double PatchSimplifier::cost_with_part(Index a, Index b, double cost) {
  if (parts_.empty()) return cost;
  const Index of_a = part_at(a), of_b = part_at(b), broken = broken_by(a, b, cost);
  if (of_a != of_b) {
    cost = std::max({cost, price_of_what_rests_on(of_a, of_b), price_of_what_rests_on(of_b, of_a)});
  }
  if (broken == kNone) return cost;
  const Part& part = parts_[broken];
  return std::max({cost, price_of_part(part.loss, part.triangles),
                   price_of_what_rests_on(broken, kNone), steering_.far_area * part.reach2});
}

// After a contraction has broken it: the rest of the part that `member` is of. Their errors are
// what they are: a view within them cannot tell what is left of a part from all of it.
void PatchSimplifier::vanish(Index member, double cost) {
  parts_[part_at(member)].whole = false;
  Index v = member;
  do {
    v = next_in_part_[v];
    while (vertices_[v].alive && vertices_[v].corners.count > 0) {
      Index nearest = kNone;
      double least = 0;
      for (const Index corner : corners_of(v)) {
        for (const Index other : {others_of(corner)[0], others_of(corner)[1]}) {
          const Vec3d gap = positions_[other] - positions_[v];
          const double away2 = dot(gap, gap);
          if (nearest != kNone && (away2 > least || (away2 == least && other >= nearest))) continue;
          nearest = other;
          least = away2;
        }
      }
      find_ring(nearest, v);
      const Placed placed{cost, cost, positions_[nearest], false};
      measure_witnesses(nearest, v, placed);
      contract(nearest, v, placed.position, cost);
    }
  } while (v != member);
}

}  // namespace crease::simplification
