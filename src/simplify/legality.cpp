// What a contraction does to the triangles around it: folds, coincidences, and flat triangles that
// turn away from the normal they show or vanish. Each is a cost, not a ban: at detail scale it
// keeps such a contraction from being chosen while there is another, and as the bands grow nothing
// gets stuck.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace crease::simplification {

namespace {

// A triangle that turns by more than this has folded over; so has one without area that opens.
constexpr double kFoldCosine = 0.2;

// A triangle that turns by less than a millionth stays in its plane.
constexpr double kCoplanarCosine2 = 1 - 1e-12;

// A flat triangle whose error is at most this share of its area (0.06 degrees) shows what it stands
// for.
constexpr double kRight = 1e-3;

// Folds that cost less than this share of the rest are no reason to look for another place.
constexpr double kMinor = 0.01;

// What an area that changes hands between materials or parts counts, beside one whose normal is off
// by a radian.
constexpr double kCategoryShare = 1;

// Where it changes hands between parts of one material nothing is to be seen: this much of it.
constexpr double kPartShare = 0.1;

// What the area of a part that disappears counts: quadrics count it at each of its three corners.
constexpr double kPartWeight = 3;

// To join a card to something takes no triangle away: what does will cost as well. So leaves vanish
// one by one as long as there are others beside them.
constexpr double kJoinWeight = 6;

using Lane = long long;
constexpr Lanes kLane = {0, 1, 2, 3};

double squared(const Vec3d& v) {
  return dot(v, v);
}

}  // namespace

inline void PatchSimplifier::blame(Index t, double cost) {
  const bool dearest = cost > blamed_cost_;  // no branch: nobody could foretell it
  blamed_ = dearest ? t : blamed_;
  blamed_cost_ = std::max(blamed_cost_, cost);
}

// The ring's triangles from `first` on, of which the last one fills up the block.
inline void PatchSimplifier::gather(std::size_t first, RingBlock& block) const {
  const RingTriangle* ring[RingBlock::kTriangles];
  for (std::size_t k = 0; k < RingBlock::kTriangles; ++k) {
    ring[k] = &ring_[std::min(first + k, ring_.size() - 1)];
  }
  const Vec3d* at = positions_.data();
  take_axes(at[ring[0]->next], at[ring[1]->next], at[ring[2]->next], at[ring[3]->next], block.next);
  take_axes(at[ring[0]->previous], at[ring[1]->previous], at[ring[2]->previous],
            at[ring[3]->previous], block.previous);
  const Facing &f0 = facing_[ring[0]->triangle], &f1 = facing_[ring[1]->triangle],
               &f2 = facing_[ring[2]->triangle], &f3 = facing_[ring[3]->triangle];
  static_assert(offsetof(Facing, area) == 3 * sizeof(double));
  take_pairs(&f0.normal.x, &f1.normal.x, &f2.normal.x, &f3.normal.x, block.normal[0],
             block.normal[1]);
  take_pairs(&f0.normal.z, &f1.normal.z, &f2.normal.z, &f3.normal.z, block.normal[2], block.area);
  block.shows = block.right = Lanes{};
  block.has_shading = false;
  if (shading_.empty()) return;
  const auto shows = [&](int k) {
    const Index t = ring[k]->triangle;
    return (flat_[t] | derived_[t]) != 0;
  };
  take_lanes(shows(0), shows(1), shows(2), shows(3), block.shows);
  const auto counts = [&](int k) { return shading_[ring[k]->triangle].counts; };
  block.right = Row{counts(0), counts(1), counts(2), counts(3)} <= kRight * block.area;
}

inline void PatchSimplifier::gather_shading(std::size_t first, RingBlock& block) const {
  const auto at = [&](std::size_t k) -> const FlatShading& {
    return shading_[ring_[std::min(first + k, ring_.size() - 1)].triangle];
  };
  const FlatShading &s0 = at(0), &s1 = at(1), &s2 = at(2), &s3 = at(3);
  ShadingBlock& to = block.shading;
  static_assert(offsetof(Represented, area) == 3 * sizeof(float));
  take_floats(&s0.input.sum.x, &s1.input.sum.x, &s2.input.sum.x, &s3.input.sum.x, to.input_sum,
              &to.input_area);
  take_floats(&s0.faced.x, &s1.faced.x, &s2.faced.x, &s3.faced.x, to.faced);
  static_assert(offsetof(FlatShading, counts) ==
                offsetof(FlatShading, stored_counts) + sizeof(double));
  static_assert(offsetof(FlatShading, stored_counts) ==
                offsetof(FlatShading, stored_error) + sizeof(double));
  take_pairs(&s0.stored_error, &s1.stored_error, &s2.stored_error, &s3.stored_error,
             to.stored_error, to.stored_counts);
  take_pairs(&s0.stored_counts, &s1.stored_counts, &s2.stored_counts, &s3.stored_counts,
             to.stored_counts, to.counts);
  take_lanes(s0.derived, s1.derived, s2.derived, s3.derived, to.derived);
  block.has_shading = true;
}

// Stops when it is above `bound`: dear enough.
CREASE_WIDE double PatchSimplifier::fold_cost(Index a, Index b, const Vec3d& target, double bound) {
  const double step2 = squared(positions_[b] - positions_[a]);
  const double normal_scale2 = steering_.normal_scale * steering_.normal_scale;
  const bool a_stays = target == positions_[a], b_stays = target == positions_[b];
  const std::size_t begin = a_stays ? ring_kept_ : 0;
  const std::size_t end = b_stays ? ring_kept_ : ring_.size();
  double cost = 0;
  for (std::size_t first = begin & ~(RingBlock::kTriangles - 1); first < end && cost <= bound;
       first += RingBlock::kTriangles) {
    RingBlock& block = blocks_[first / RingBlock::kTriangles];
    if (block.ring != ring_count_) {
      block.ring = ring_count_;
      gather(first, block);
    }
    const RingBlock::Moved moved = block.moved_to(target);
    const Row cosine2 = moved.agreement * moved.agreement;  // times length2
    Lanes folds = (moved.agreement < 0) | (cosine2 <= kFoldCosine * kFoldCosine * moved.length2);
    if (step2 == 0) folds = Lanes{};
    const Lanes turns = block.shows & (moved.length2 > 0) &
                        (folds | ~block.right | (cosine2 < kCoplanarCosine2 * moved.length2));
    const Lanes of_moved = (kLane >= Lanes{} + (begin > first ? Lane(begin - first) : 0)) &
                           (kLane < Lanes{} + Lane(end - first));
    const Lanes counts = of_moved & (folds | turns);
    if (bits_of(counts) == 0) continue;
    Row twice_after, own;
    take_root(moved.length2, twice_after);
    own = folds ? step2 * (block.area + 0.5 * twice_after) : Row{};
    if (bits_of(turns) != 0) {
      if (!block.has_shading) gather_shading(first, block);
      const Row inverse = 1 / twice_after;
      const Row normal[] = {moved.normal[0] * inverse, moved.normal[1] * inverse,
                            moved.normal[2] * inverse};
      Row more;
      block.shading.more_with(normal, 0.5 * twice_after, more);
      own += turns ? normal_scale2 * more : Row{};
    }
    own = (counts & (own > 0)) ? own : Row{};
    // One by one, until they are too many: which these are is asked only then.
    const double with_all = (((cost + own[0]) + own[1]) + own[2]) + own[3];
    if (with_all <= bound) {
      const double most = std::max(std::max(own[0], own[1]), std::max(own[2], own[3]));
      const int at = std::countr_zero(bits_of(own == most));
      blame(ring_[first + static_cast<std::size_t>(at)].triangle, most);
      cost = with_all;
      continue;
    }
    for (std::size_t k = 0; cost <= bound; ++k) {
      blame(ring_[first + k].triangle, own[k]);
      cost += own[k];
    }
  }
  return cost;
}

// Vertices joined to both ends without a triangle over the pair: afterwards two sheets share an
// edge there, or two triangles coincide. Where borders alone meet, a triangle at either end, a hole
// closes, which costs no more than its borders say.
inline double PatchSimplifier::coincidence_cost(Index a, Index b) {
  // Vertices by how many triangles of either end have them, one or several, and those that count.
  const Index one_of_a = ++mark_now_, several_of_a = ++mark_now_, one_of_each = ++mark_now_,
              told = ++mark_now_;
  for (std::size_t i = 0; i < ring_kept_; ++i) {
    for (Index v : {ring_[i].next, ring_[i].previous}) {
      mark_[v] = mark_[v] < one_of_a ? one_of_a : several_of_a;
    }
  }
  for (const Vanishing& vanishing : vanishing_) mark_[vanishing.third] = told;
  std::size_t shared = 0;
  Index culprit = kNone;
  for (std::size_t i = ring_kept_; i < ring_.size(); ++i) {
    for (Index v : {ring_[i].next, ring_[i].previous}) {
      Index& mark = mark_[v];
      if (mark == one_of_a) {
        mark = one_of_each;
      } else if (mark == several_of_a || mark == one_of_each) {
        mark = told;
        culprit = ring_[i].triangle;
        ++shared;
      }
    }
  }
  if (shared == 0) return 0;
  const double step2 = squared(positions_[b] - positions_[a]);
  const double cost =
      static_cast<double>(shared) * step2 * (surface_[a].weight + surface_[b].weight) / 3;
  blame(culprit, cost);
  return cost;
}

// Materials and parts: a window that vanishes leaves its area to the wall, and one that swells
// takes the wall's. Area that only vanishes costs nothing here.
double PatchSimplifier::category_cost(Index a, Index b, const Vec3d& target) {
  if (work_->category_of_triangle.empty()) return 0;
  if (category_around_[a] == category_around_[b] && category_around_[a] != kNone) return 0;
  by_category_.clear();
  by_material_.clear();
  const auto change = [&](Index t, double area) {
    by_category_.add(category_of(t), area);
    by_material_.add(material_of_category(category_of(t)), area);
  };
  for (const auto& [t, third] : vanishing_) change(t, -facing_[t].area);
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    if (target == positions_[i < ring_kept_ ? a : b]) continue;
    const Index t = ring_[i].triangle;
    change(t, 0.5 * length(normal_if_moved(ring_[i], target)) - facing_[t].area);
  }
  const double area =
      kPartShare * by_category_.exchanged() + (1 - kPartShare) * by_material_.exchanged();
  return kCategoryShare * steering_.normal_scale * steering_.normal_scale * area;
}

// What does not depend on where the vertex goes.
CREASE_WIDE double PatchSimplifier::vanishing_cost(Index a, Index b) {
  double cost = coincidence_cost(a, b);
  if (ring_.empty()) {
    // A part disappears. Its own planes may not mind; whoever looks at it does.
    if (steering_.keep_one_triangle && vanishing_.size() >= live_triangles_) {
      return std::numeric_limits<double>::infinity();
    }
    double area = 0;
    for (const auto& [t, third] : vanishing_) area += facing_[t].area;
    cost += kPartWeight * area * squared(positions_[b] - positions_[a]);
  }
  if (!shading_.empty()) {
    const double normal_scale2 = steering_.normal_scale * steering_.normal_scale;
    for (const Vanishing& v : vanishing_) cost += normal_scale2 * vanishing_error(v);
  }
  return cost;
}

double PatchSimplifier::ring_cost(Index a, Index b, const Vec3d& target, double bound) {
  const double cost = fold_cost(a, b, target, bound);
  return cost <= bound ? cost + category_cost(a, b, target) : cost;
}

// At the pass's start.
bool PatchSimplifier::is_of_card(Index v) const {
  if (work_->part_count < 2) return false;
  return work_->triangles_of_part[work_->part_of_vertex[vertices_[v].global]] < kCard;
}

// The place with the triangles around it included: where the optimum would fold one, an end of the
// pair or its middle may not. A cost above `bound` is a lower one.
CREASE_WIDE PatchSimplifier::Placed PatchSimplifier::make_legal(Candidate& pair, double bound) {
  const Index a = pair.a, b = pair.b;
  blamed_ = kNone;
  blamed_cost_ = 0;
  find_ring(a, b);
  ++ring_count_;
  blocks_.resize(std::max(blocks_.size(), ring_.size() / RingBlock::kTriangles + 1));
  const double free_cost = pair.free_cost;
  const Vec3d position = to_double(pair.position);
  const double fold = ring_cost(a, b, position, bound - free_cost);
  Placed best{free_cost + fold, free_cost, position};
  const double noise = kGridNoise * kGridNoise * (surface_[a].weight + surface_[b].weight);
  if (fold > kMinor * free_cost + noise) {
    if (pair.cost_of_other[0] == Candidate::kUnknown) find_costs_of_others(pair);
    const Vec3d &pa = positions_[a], &pb = positions_[b];
    const Vec3d others[] = {pa, pb, rounded((pa + pb) * 0.5)};
    const int count = steering_.placement == Placement::Endpoint ? 2 : 3;
    for (int i = 0; i < count; ++i) {
      const double cost = std::max(free_cost, pair.cost_of_other[i]);
      if (!(cost < best.cost)) continue;
      if (cost == free_cost && others[i] == position) continue;  // that is where it was
      const double total = cost + ring_cost(a, b, others[i], std::min(best.cost, bound) - cost);
      if (total < best.cost) best = {total, cost, others[i]};
    }
  }
  if (best.cost <= bound) {
    best.cost += vanishing_cost(a, b);
    if (vanishing_.empty() && (is_of_card(a) || is_of_card(b))) best.cost *= kJoinWeight;
    if (const double with_part = cost_with_part(a, b, best.cost); with_part > best.cost) {
      best.cost = with_part;
      blamed_ = kNone;
    }
    best.lasts = !ring_.empty();
  }
  return best;
}

}  // namespace crease::simplification
