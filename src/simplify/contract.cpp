// What one contraction changes: errors, wedges, triangles.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

namespace {

double squared(const Vec3d& v) {
  return dot(v, v);
}

float raised(float base, double own) {
  return static_cast<float>(double(base) + own);
}

}  // namespace

CREASE_WIDE void PatchSimplifier::contract(Index a, Index b, const Vec3d& target, double cost) {
  // The nearer end stays, so that the stored step is short; with endpoints it is the target itself.
  const bool keep_a = squared(positions_[a] - target) < squared(positions_[b] - target);
  const Index kept = keep_a ? a : b, removed = keep_a ? b : a;

  Vertex& q = vertices_[kept];
  Vertex& p = vertices_[removed];
  Contraction contraction;
  contraction.removed = VertexId{p.global};
  contraction.kept = VertexId{q.global};
  contraction.position = on_grid(target);
  contraction.first_change = static_cast<Index>(result_.changes.size());
  contraction.first_derived = static_cast<Index>(result_.derived.size());

  if (kept != a) turn_ring(kept);  // else make_legal() has found it

  // Errors: the bands before, and this band's quadrics on top.
  Errors& errors = errors_[kept];
  errors.base = larger(errors.base, errors_[removed].base);
  LevelError error = errors.base;
  error.surface = surface_error(kept, removed, target);
  surface_[kept].add(surface_[removed]);
  if (!turn_.empty()) turn_[kept].add(turn_[removed]);
  const Index line_p = line_of_vertex_[removed], line_q = line_of_vertex_[kept];
  if (line_p != kNone && line_q != kNone) line_[line_q].add(line_[line_p]);
  if (line_q == kNone) line_of_vertex_[kept] = line_p;
  if (const Index line = line_of_vertex_[kept]; line != kNone && line_[line].weight > 0) {
    error.line = raised(error.line, std::sqrt(line_[line].at(target) / line_[line].weight));
  }

  // Wedges are joined while the vanishing triangles still stand.
  Index* common = joins_.common.start(vanishing_.size());
  for (const Vanishing& vanishing : vanishing_) {
    const Index* v = &vertex_of_corner_[4 * vanishing.triangle];
    *common++ = 4 * vanishing.triangle + (v[1] == kept) + 2 * (v[2] == kept);
  }
  joins_.common.finish(common);
  for (std::size_t l = 0; l < layer_count(); ++l) contract_layer(l, kept, removed, target, error);
  errors.now = larger(larger(errors.now, errors_[removed].now), error);

  // Triangles: vanish, or change hands.
  if (!shading_.empty()) hand_over_represented();
  for (std::size_t i = ring_kept_; i < ring_.size(); ++i) {
    Index* corners = &vertex_of_corner_[4 * ring_[i].triangle];
    corners[ring_[i].corner % 4] = kept;
    corners[3] = corners[0];
  }
  // In the place of either end's, where that is large enough: else fans take the square of memory.
  const Index count = static_cast<Index>(ring_.size());
  Index first = q.corners.first;
  if (count > q.corners.count) first = p.corners.first;
  if (count > q.corners.count && count > p.corners.count) {
    first = static_cast<Index>(corner_pool_.size());
    corner_pool_.resize(corner_pool_.size() + count);
  }
  for (Index i = 0; i < count; ++i) corner_pool_[first + i] = ring_[i].corner;
  q.corners = {first, count};
  positions_[kept] = target;
  for (const RingTriangle& ring : ring_) facing_[ring.triangle] = facing_of(ring.triangle);
  if (!work_->category_of_triangle.empty() && category_around_[kept] != category_around_[removed]) {
    category_around_[kept] = kNone;
  }
  q.flat_around = q.flat_around && p.flat_around;
  contract_parts(kept, removed);
  p.alive = false;
  p.into = kept;
  for (const auto& [t, third] : vanishing_) {
    triangle_alive_[t] = 0;
    --live_triangles_;
    Slice& around = vertices_[third].corners;
    Index* begin = &corner_pool_[around.first];
    Index* end = std::remove_if(begin, begin + around.count,
                                [gone = t](Index corner) { return triangle_of(corner) == gone; });
    around.count = static_cast<Index>(end - begin);
    release(t);
  }
  if (!shading_.empty()) derive_where_better(kept, errors.now);
  errors.now.surface = std::max(errors.now.surface, farthest_witness_);
  witness_mover_.settle(work_->witnesses);

  contraction.error = errors.now;
  contraction.change_count = static_cast<Index>(result_.changes.size()) - contraction.first_change;
  contraction.derived_count =
      static_cast<Index>(result_.derived.size()) - contraction.first_derived;
  last_key_ = std::max(last_key_, cost);
  result_.contractions.push_back({last_key_, contraction});
  const Index now = static_cast<Index>(result_.contractions.size());
  q.changed_at = now;
  changed_around_[kept] = now;
  for (const RingTriangle& ring : ring_) {
    changed_around_[ring.next] = changed_around_[ring.previous] = now;
  }
  for (const Vanishing& vanishing : vanishing_) changed_around_[vanishing.third] = now;
  for (const RingTriangle& ring : ring_) {
    if (held_of_triangle_[ring.triangle] != kNone) release(ring.triangle);
  }
}

// Of their contraction, of which find_ring() knows the triangles, without what witnesses tell.
CREASE_WIDE float PatchSimplifier::surface_error(Index a, Index b, const Vec3d& target) const {
  float error = std::max(errors_[a].base.surface, errors_[b].base.surface);
  const Quadric surface = surface_[a] + surface_[b];
  if (surface.weight > 0) error = raised(error, std::sqrt(surface.at(target) / surface.weight));
  if (!ring_.empty()) return error;
  // A part disappears: its planes fit what is left of it, but what it stood for is gone.
  double longest2 = 0;
  for (const Vanishing& vanishing : vanishing_) {
    if (!(facing_[vanishing.triangle].area > 0)) continue;
    const Index* v = &vertex_of_corner_[4 * vanishing.triangle];
    for (Index c = 0; c < 3; ++c) {
      longest2 = std::max(longest2, squared(positions_[v[c]] - positions_[v[(c + 1) % 3]]));
    }
  }
  return raised(error, std::sqrt(longest2));
}

// How far from the ring the input will be, by witnesses of what changes of it and of what vanishes.
// A witness's distance is known if it changes nothing: neither the error, which is as large without
// it, nor the cost.
CREASE_WIDE void PatchSimplifier::measure_witnesses(Index a, Index b, const Placed& placed) {
  const Vec3d& target = placed.position;
  const Witnesses& witnesses = work_->witnesses;
  farthest_witness_ = 0;
  witness_mover_.start();
  if (witnesses.all.empty()) return;
  const std::size_t begin = target == positions_[a] ? ring_kept_ : 0;
  const std::size_t end = target == positions_[b] ? ring_kept_ : ring_.size();
  for (Index i = 0; i < ring_.size(); ++i) {
    const RingTriangle& ring = ring_[i];
    const Index t = global_triangle_[ring.triangle];
    witness_mover_.add(t, positions_[ring.next] - target, positions_[ring.previous] - target);
    if (i >= begin && i < end) witness_mover_.take(t, i, witnesses);
  }
  for (const Vanishing& vanishing : vanishing_) {
    witness_mover_.take(global_triangle_[vanishing.triangle], kNone, witnesses);
  }
  const float error =
      std::max({errors_[a].now.surface, errors_[b].now.surface, surface_error(a, b, target)});
  const double known =
      std::min(double(error), std::sqrt(placed.cost / steering_.far_area) + kRounding);
  farthest_witness_ = witness_mover_.measure(witnesses, on_grid(target), static_cast<float>(known));
}

CREASE_WIDE void PatchSimplifier::find_ring(Index kept, Index removed) {
  const std::span<const Index> around_kept = corners_of(kept);
  const std::span<const Index> around_removed = corners_of(removed);
  // What does not belong to a list is written over by what comes next: no branches.
  RingTriangle* ring = ring_.start(around_kept.size() + around_removed.size());
  Vanishing* vanishing = vanishing_.start(around_kept.size());
  for (Index corner : around_kept) {
    const RingTriangle own = ring_triangle(corner);
    const bool vanishes = (own.next == removed) | (own.previous == removed);
    *ring = own;
    *vanishing = {own.triangle, own.next ^ own.previous ^ removed};  // the one that is not
    vanishing += vanishes;
    ring += !vanishes;
  }
  vanishing_.finish(vanishing);
  ring_kept_ = static_cast<std::size_t>(ring - ring_.begin());
  for (Index corner : around_removed) {
    const RingTriangle own = ring_triangle(corner);
    *ring = own;
    ring += (own.previous != kept) & (own.next != kept);
  }
  ring_.finish(ring);
}

// As find_ring() finds it with `kept` first, which has been second.
void PatchSimplifier::turn_ring(Index kept) {
  const std::size_t ring_kept = ring_.size() - ring_kept_;
  std::rotate(ring_.begin(), ring_.begin() + ring_kept_, ring_.begin() + ring_.size());
  ring_kept_ = ring_kept;
  Vanishing* next = vanishing_.begin();
  Vanishing* const end = next + vanishing_.size();
  for (Index corner : corners_of(kept)) {
    if (end - next < 2) break;
    Vanishing* here = next;
    while (here != end && here->triangle != triangle_of(corner)) ++here;
    if (here != end) std::swap(*here, *next++);
  }
}

// One quadric out of the members', in the place of one of them; none if all show one attribute that
// is the same all over their triangles.
inline void PatchSimplifier::combine_quadrics(std::size_t layer, std::span<const Index> members,
                                              Wedge& result) {
  const std::vector<Wedge>& wedges = wedges_[layer];
  Index host = kNone;
  bool constant = true;
  for (Index w : members) {
    if (wedges[w].quadric != kNone) host = w;
    constant = constant && wedges[w].quadric == kNone && wedges[w].id == wedges[members[0]].id;
  }
  result.quadric = host == kNone ? kNone : wedges[host].quadric;
  if (constant) return;
  std::vector<AttributeQuadric>& quadrics = attribute_quadrics_[layer];
  if (host == kNone) {
    result.quadric = static_cast<Index>(quadrics.size());
    quadrics.emplace_back();
  }
  AttributeQuadric& all = quadrics[result.quadric];
  for (Index w : members) {
    if (w != host) add_quadric(layer, wedges[w], all);
  }
}

// What the ends have, each the mean of its own by area, mixed by where the vertex will stand
// between them.
void PatchSimplifier::blend_along(std::size_t layer, std::span<const Index> members, Slice of_kept,
                                  double kept_share, double* value) const {
  const std::vector<Wedge>& wedges = wedges_[layer];
  const auto is_kept = [&](Index w) { return w - of_kept.first < of_kept.count; };
  double kept_area = 0, removed_area = 0;
  for (Index w : members) (is_kept(w) ? kept_area : removed_area) += wedges[w].area;
  if (!(kept_area > 0)) kept_share = 0;
  if (!(removed_area > 0)) kept_share = 1;
  for (Index w : members) {
    const double share = is_kept(w) ? kept_share / kept_area : (1 - kept_share) / removed_area;
    if (!(share > 0)) continue;
    for (int j = 0; j < work_->layers[layer].dimension; ++j) {
      value[j] += share * wedges[w].area * double(wedges[w].value[j]);
    }
  }
}

// Gives a joined wedge, whose area and quadric are known, its value; returns its attribute id, or
// kNone if it is new. `kept_share`: 1 where the vertex stays at the kept end, 0 at the removed one.
inline PatchSimplifier::Index PatchSimplifier::chosen_value(std::size_t layer,
                                                            std::span<const Index> members,
                                                            Index fixed, Slice of_kept,
                                                            const Vec3d& target, double kept_share,
                                                            Wedge& result) {
  const WorkLayer& work = work_->layers[layer];
  const std::vector<Wedge>& wedges = wedges_[layer];
  Index inherited = fixed;
  if (inherited == kNone) {  // from the end that stays, if it has one
    inherited = members[0];
    for (Index w : members) {
      if (w - of_kept.first < of_kept.count) inherited = w;
    }
  }
  const auto inherit = [&] {
    std::copy_n(wedges[inherited].value, kMaxDimension, result.value);
    return wedges[inherited].id;
  };
  if (fixed != kNone || !work.blends || steering_.placement == Placement::Endpoint ||
      !(result.area > 0) || (work.steers && result.quadric == kNone)) {
    return inherit();
  }

  double value[kMaxDimension] = {};
  if (work.steers) {
    for (int j = 0; j < work.dimension; ++j) {
      value[j] = attribute_quadrics_[layer][result.quadric].weighted_value(j, target) / result.area;
    }
  } else {
    blend_along(layer, members, of_kept, kept_share, value);
  }
  double norm2 = 0;
  for (int j = 0; j < work.dimension; ++j) norm2 += value[j] * value[j];
  if (work.is_direction) {
    if (!(norm2 > 1e-4)) return inherit();  // opposite directions: there is no middle
    for (int j = 0; j < work.dimension; ++j) value[j] /= std::sqrt(norm2);
  }
  const double same = members.size() == 1 ? work.same.moved : work.same.joined;
  double away2 = 0;
  for (int j = 0; j < work.dimension; ++j) {
    result.value[j] = static_cast<float>(value[j]);
    const double away = double(result.value[j]) - double(wedges[inherited].value[j]);
    away2 += away * away;
  }
  return away2 <= same * same ? inherit() : kNone;
}

CREASE_WIDE void PatchSimplifier::contract_layer(std::size_t layer, Index kept, Index removed,
                                                 const Vec3d& target, LevelError& error) {
  const WorkLayer& work = work_->layers[layer];
  join_wedges(layer, kept, removed, joins_);
  std::vector<Wedge>& wedges = wedges_[layer];
  std::vector<Index>& wedge_of_corner = wedge_of_corner_[layer];
  const Slice of_kept = wedges_of(layer, kept), of_removed = wedges_of(layer, removed);
  const auto slot_of = [&](Index wedge) {
    const Index slot = wedge - of_kept.first;
    return slot < of_kept.count ? slot : of_kept.count + (wedge - of_removed.first);
  };

  // Wedges that no surviving triangle uses are removed (G03 3.4, R). A triangle that shows its
  // geometric normal has a wedge, but its attribute no longer stands at the vertex.
  constexpr char kUsed = 1, kShown = 2;
  used_.assign(of_kept.count + of_removed.count, 0);
  for (const RingTriangle& ring : ring_) {
    const bool shown = !(work.is_normal && derived_[ring.triangle]);
    used_[slot_of(wedge_of_corner[ring.corner])] |= shown ? kUsed | kShown : kUsed;
  }

  Index* result_of_slot = joins_.parent.start(used_.size());  // join_wedges is done with it
  results_.clear();
  double square_error = -1, displacement = 0;
  const Vec3d along = positions_[kept] - positions_[removed];
  const double length2 = dot(along, along);
  const double kept_share =
      length2 > 0 ? std::clamp(dot(target - positions_[removed], along) / length2, 0.0, 1.0) : 0.5;
  for (const Joined& joined : joins_.joined) {
    const std::span<const Index> members(&joins_.members[joined.first_member], joined.member_count);
    bool any_used = false;
    for (Index w : members) any_used = any_used || used_[slot_of(w)];
    if (!any_used) continue;
    Wedge& result = results_.emplace_back(wedges[members[0]]);
    for (Index w : members.subspan(1)) {
      result.area += wedges[w].area;
      result.pinned = result.pinned || wedges[w].pinned;
    }
    if (work.steers) combine_quadrics(layer, members, result);
    const Index inherited =
        chosen_value(layer, members, joined.fixed, of_kept, target, kept_share, result);
    if (inherited != kNone) {
      result.id = inherited;
    } else {
      std::vector<float>& values = result_.new_values[layer];
      result.id =
          kLocalValue + static_cast<Index>(values.size()) / static_cast<Index>(work.dimension);
      values.insert(values.end(), result.value, result.value + work.dimension);
    }
    for (std::size_t k = 0; k < members.size(); ++k) {
      result_of_slot[slot_of(members[k])] = static_cast<Index>(results_.size() - 1);
      const Index from = wedges[members[k]].id;
      bool told = from == result.id || !(used_[slot_of(members[k])] & kShown);
      for (std::size_t i = 0; i < k && !told; ++i) {
        told = wedges[members[i]].id == from && (used_[slot_of(members[i])] & kShown);
      }
      if (told) continue;
      result_.changes.push_back(
          {static_cast<Index>(layer), AttributeId{from}, AttributeId{result.id}});
    }
    if (work.steers && result.area > 0) {
      double square = 0;
      if (result.quadric != kNone) {
        const AttributeQuadric& quadric = attribute_quadrics_[layer][result.quadric];
        square = quadric.at(target, work.dimension, result.value);
        displacement = std::max(displacement, quadric.displacement(square, work.source->role));
      }
      square_error = std::max(square_error, square / result.area);
    }
  }
  if (square_error >= 0) {
    const double own = std::sqrt(square_error);
    if (work.is_normal) {
      // A chord on the unit sphere; deviations of successive bands are independent of each other.
      const double angle = degrees(2 * std::asin(std::min(1.0, own / 2)));
      error.degrees = static_cast<float>(
          std::min(180.0, std::sqrt(double(error.degrees) * error.degrees + angle * angle)));
    } else if (work.source->role == AttributeRole::TexCoord) {
      error.texture = raised(error.texture, own);
    }
    error.line = std::max(error.line, raised(errors_[kept].base.line, displacement));
  }

  // The results take the place of what they come from, where that is large enough.
  const Index count = static_cast<Index>(results_.size());
  Index first = of_kept.first;
  if (count > of_kept.count) first = of_removed.first;
  if (count > of_kept.count && count > of_removed.count) {
    first = static_cast<Index>(wedges.size());
    if (wedges.capacity() < wedges.size() + count) {
      wedges.reserve(wedges.size() + wedges.size() / 8 + count);
    }
    wedges.resize(wedges.size() + count);
  }
  std::copy(results_.begin(), results_.end(), wedges.begin() + first);
  for (const RingTriangle& ring : ring_) {
    Index& wedge = wedge_of_corner[ring.corner];
    wedge = first + result_of_slot[slot_of(wedge)];
  }
  wedges_of(layer, kept) = {first, count};
}

}  // namespace crease::simplification
