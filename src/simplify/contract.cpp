// The greedy loop of one patch, and what one contraction changes.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

namespace {

// A solved value this near to one that is there already is that one: it costs no record.
constexpr double kSameValue = 1e-3;
constexpr double kSameCopy = 2e-2;  // for a wedge that only moved along

// A flat triangle shows its geometric normal from where that is nearer to the input by this much
// (squared chord of about two degrees).
constexpr double kDeriveMargin = 1.2e-3;

double squared(const Vec3d& v) {
  return dot(v, v);
}

float raised(float base, double own) {
  return static_cast<float>(double(base) + own);
}

LevelError worst(const LevelError& a, const LevelError& b) {
  return {std::max(a.surface, b.surface), std::max(a.line, b.line), std::max(a.degrees, b.degrees),
          std::max(a.texture, b.texture)};
}

}  // namespace

std::vector<double> PatchSimplifier::initial_costs() {
  std::vector<double> costs;
  costs.reserve(pairs_.size());
  for (const auto& [a, b] : pairs_) costs.push_back(place(a, b).cost);
  return costs;
}

void PatchSimplifier::push(Index a, Index b) {
  if (vertices_[a].locked || vertices_[b].locked) return;
  const double cost = place(a, b).cost;
  if (!(cost <= steering_.cost_limit)) return;
  heap_.push_back(
      {static_cast<float>(cost), a, b, vertices_[a].version + vertices_[b].version, kNone});
  std::push_heap(heap_.begin(), heap_.end());
}

void PatchSimplifier::push_ring(Index v) {
  ++mark_now_;
  ring_.clear();
  for (Index t : triangles_of(v)) {
    for (Index c = 0; c < 3; ++c) {
      const Index w = vertex_of_corner_[3 * t + c];
      if (w == v || mark_[w] == mark_now_) continue;
      mark_[w] = mark_now_;
      ring_.push_back(w);
    }
  }
  for (Index w : ring_) push(std::min(v, w), std::max(v, w));
  for (Index w : ring_) release(w);
}

void PatchSimplifier::hold(const Entry& entry, double cost) {
  const Index id = static_cast<Index>(held_.size());
  held_.push_back({entry.a, entry.b, held_of_vertex_[entry.a], held_of_vertex_[entry.b], true});
  held_of_vertex_[entry.a] = held_of_vertex_[entry.b] = id;
  if (!(cost <= steering_.cost_limit)) return;
  heap_.push_back({static_cast<float>(cost), entry.a, entry.b, entry.stamp, id});
  std::push_heap(heap_.begin(), heap_.end());
}

void PatchSimplifier::release(Index v) {
  Index i = held_of_vertex_[v];
  held_of_vertex_[v] = kNone;
  while (i != kNone) {
    Held& pair = held_[i];
    i = pair.a == v ? pair.next_of_a : pair.next_of_b;
    if (!pair.waiting) continue;
    pair.waiting = false;
    if (vertices_[pair.a].alive && vertices_[pair.b].alive) push(pair.a, pair.b);
  }
}

PatchResult PatchSimplifier::run() {
  result_.new_values.resize(layer_count());
  held_of_vertex_.assign(vertices_.size(), kNone);
  for (const auto& [a, b] : pairs_) {
    const double cost = place(a, b).cost;
    if (!(cost <= steering_.cost_limit)) continue;
    heap_.push_back({static_cast<float>(cost), a, b, 0, kNone});
  }
  std::make_heap(heap_.begin(), heap_.end());

  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Entry entry = heap_.back();
    heap_.pop_back();
    const Vertex &a = vertices_[entry.a], &b = vertices_[entry.b];
    if (!a.alive || !b.alive || a.version + b.version != entry.stamp) continue;
    if (entry.held != kNone) {
      if (!held_[entry.held].waiting) continue;
      held_[entry.held].waiting = false;
    }
    const Placed placed = place_legally(entry.a, entry.b);
    const double cost = placed.cost;
    const float next = heap_.empty() ? HUGE_VALF : heap_.front().cost;
    if (!(cost <= steering_.cost_limit) ||
        (static_cast<float>(cost) > entry.cost && static_cast<float>(cost) > next)) {
      hold(entry, cost);
      continue;
    }
    contract(entry.a, entry.b, placed.position, cost);
  }
  write_back();
  result_.triangles_left = live_triangles_;
  return std::move(result_);
}

void PatchSimplifier::contract(Index a, Index b, const Vec3d& target, double cost) {
  // The nearer end stays, so that the stored step is short; with endpoints it is the target itself.
  const bool keep_a =
      squared(vertices_[a].position - target) < squared(vertices_[b].position - target);
  const Index kept = keep_a ? a : b, removed = keep_a ? b : a;

  Vertex& q = vertices_[kept];
  Vertex& p = vertices_[removed];
  Contraction contraction;
  contraction.removed = VertexId{p.global};
  contraction.kept = VertexId{q.global};
  contraction.position = center_grid_ + Vec3i{static_cast<std::int32_t>(std::lround(target.x)),
                                              static_cast<std::int32_t>(std::lround(target.y)),
                                              static_cast<std::int32_t>(std::lround(target.z))};
  contraction.first_change = static_cast<Index>(result_.changes.size());
  contraction.first_derived = static_cast<Index>(result_.derived.size());

  // Errors: the bands before, and this band's quadrics on top.
  q.base = worst(q.base, p.base);
  LevelError error = q.base;
  surface_[kept].add(surface_[removed]);
  if (surface_[kept].weight > 0) {
    error.surface =
        raised(error.surface, std::sqrt(surface_[kept].at(target) / surface_[kept].weight));
  }
  const Index line_p = line_of_vertex_[removed], line_q = line_of_vertex_[kept];
  if (line_p != kNone && line_q != kNone) line_[line_q].add(line_[line_p]);
  if (line_q == kNone) line_of_vertex_[kept] = line_p;
  if (const Index line = line_of_vertex_[kept]; line != kNone && line_[line].weight > 0) {
    error.line = raised(error.line, std::sqrt(line_[line].at(target) / line_[line].weight));
  }

  // Wedges are joined while the vanishing triangles still stand.
  for (std::size_t l = 0; l < layer_count(); ++l) contract_layer(l, kept, removed, target, error);
  q.error = worst(worst(q.error, p.error), error);

  // Triangles: vanish, or change hands.
  const Slice of_kept = q.triangles, of_removed = p.triangles;
  const Index first = static_cast<Index>(triangle_pool_.size());
  ring_.clear();
  for (Index i = 0; i < of_kept.count; ++i) {
    const Index t = triangle_pool_[of_kept.first + i];
    if (corner_of(t, removed) >= 0) {
      ring_.push_back(t);
    } else {
      triangle_pool_.push_back(t);
    }
  }
  for (Index i = 0; i < of_removed.count; ++i) {
    const Index t = triangle_pool_[of_removed.first + i];
    if (corner_of(t, kept) >= 0) continue;
    vertex_of_corner_[3 * t + static_cast<Index>(corner_of(t, removed))] = kept;
    triangle_pool_.push_back(t);
  }
  q.triangles = {first, static_cast<Index>(triangle_pool_.size()) - first};
  q.position = target;
  ++q.version;
  p.alive = false;
  for (Index t : ring_) {
    triangle_alive_[t] = 0;
    --live_triangles_;
    for (Index c = 0; c < 3; ++c) {
      const Index w = vertex_of_corner_[3 * t + c];
      if (w == kept || w == removed) continue;
      Slice& around = vertices_[w].triangles;
      Index* begin = &triangle_pool_[around.first];
      Index* end = std::remove(begin, begin + around.count, t);
      around.count = static_cast<Index>(end - begin);
    }
    if (!represented_.empty()) hand_over_represented(t, kept);
  }
  if (!represented_.empty()) derive_where_better(kept);

  contraction.error = q.error;
  contraction.change_count = static_cast<Index>(result_.changes.size()) - contraction.first_change;
  contraction.derived_count =
      static_cast<Index>(result_.derived.size()) - contraction.first_derived;
  last_key_ = std::max(last_key_, cost);
  result_.contractions.push_back({last_key_, contraction});
  push_ring(kept);
}

// The value of a joined wedge, written to `value`; returns its attribute id, or kNone if it is new.
PatchSimplifier::Index PatchSimplifier::chosen_value(std::size_t layer, const Joined& joined,
                                                     Index kept_first, Index kept_end,
                                                     const Vec3d& target, double* value) {
  const WorkLayer& work = work_.layers[layer];
  const std::vector<Wedge>& wedges = wedges_[layer];
  const Index* members = &members_[joined.first_member];
  Index inherited = joined.fixed;
  if (inherited == kNone) {  // from the end that stays, if it has one
    inherited = members[0];
    for (Index k = 0; k < joined.member_count; ++k) {
      if (members[k] >= kept_first && members[k] < kept_end) inherited = members[k];
    }
  }
  const auto inherit = [&] {
    std::copy_n(wedges[inherited].value, kMaxDimension, value);
    return wedges[inherited].id;
  };
  const double area = joined.quadric.own.weight;
  if (joined.fixed != kNone || !work.blends || steering_.placement == Placement::Endpoint ||
      !(area > 0)) {
    return inherit();
  }

  double norm2 = 0;
  for (int j = 0; j < work.dimension; ++j) {
    value[j] = joined.quadric.weighted_value(j, target) / area;
    norm2 += value[j] * value[j];
  }
  if (work.is_direction) {
    if (!(norm2 > 1e-4)) return inherit();  // opposite directions: there is no middle
    for (int j = 0; j < work.dimension; ++j) value[j] /= std::sqrt(norm2);
  }
  const double same = joined.member_count == 1 ? kSameCopy : kSameValue;
  double away2 = 0;
  for (int j = 0; j < work.dimension; ++j) {
    value[j] = double(static_cast<float>(value[j]));
    const double away = value[j] - wedges[inherited].value[j];
    away2 += away * away;
  }
  return away2 <= same * same ? inherit() : kNone;
}

void PatchSimplifier::contract_layer(std::size_t layer, Index kept, Index removed,
                                     const Vec3d& target, LevelError& error) {
  const WorkLayer& work = work_.layers[layer];
  join_wedges(layer, kept, removed, joined_);
  std::vector<Wedge>& wedges = wedges_[layer];
  std::vector<Index>& wedge_of_corner = wedge_of_corner_[layer];
  const Slice of_kept = wedges_of(layer, kept);

  // Which wedges a surviving triangle uses; the others are removed (G03 3.4, R).
  std::vector<Index>& new_of_member = parent_;  // join_wedges is done with it
  const auto used = [&](Index wedge) {
    for (Index v : {kept, removed}) {
      const Index other = v == kept ? removed : kept;
      for (Index t : triangles_of(v)) {
        if (corner_of(t, other) >= 0) continue;
        if (wedge_of_corner[3 * t + static_cast<Index>(corner_of(t, v))] == wedge) return true;
      }
    }
    return false;
  };

  const Index first = static_cast<Index>(wedges.size());
  new_of_member.assign(members_.size(), kNone);
  double square_error = 0, square_weight = 0;
  for (Joined& joined : joined_) {
    bool any_used = false;
    bool pinned = false;
    for (Index k = 0; k < joined.member_count; ++k) {
      const Wedge& member = wedges[members_[joined.first_member + k]];
      joined.quadric.add(member.quadric, work.dimension);
      pinned = pinned || member.pinned;
      if (!any_used && used(members_[joined.first_member + k])) any_used = true;
    }
    if (!any_used) continue;
    Wedge result{};
    result.quadric = joined.quadric;
    result.pinned = pinned;
    const Index inherited = chosen_value(layer, joined, of_kept.first,
                                         of_kept.first + of_kept.count, target, result.value);
    if (inherited != kNone) {
      result.id = inherited;
    } else {
      std::vector<float>& values = result_.new_values[layer];
      result.id =
          kLocalValue + static_cast<Index>(values.size()) / static_cast<Index>(work.dimension);
      for (int j = 0; j < work.dimension; ++j)
        values.push_back(static_cast<float>(result.value[j]));
    }
    for (Index k = 0; k < joined.member_count; ++k) {
      const Index member = members_[joined.first_member + k];
      new_of_member[joined.first_member + k] = static_cast<Index>(wedges.size());
      const Index from = wedges[member].id;
      bool told = from == result.id || !used(member);
      for (Index i = 0; i < k && !told; ++i) {
        told = wedges[members_[joined.first_member + i]].id == from;
      }
      if (told) continue;
      result_.changes.push_back(
          {static_cast<Index>(layer), AttributeId{from}, AttributeId{result.id}});
    }
    if (work.steers && joined.quadric.own.weight > 0) {
      square_error =
          std::max(square_error, joined.quadric.at(target, work.dimension, result.value) /
                                     joined.quadric.own.weight);
      square_weight = 1;
    }
    wedges.push_back(result);
  }
  if (square_weight > 0) {
    const double own = std::sqrt(square_error);
    if (work.is_normal) {
      // A chord on the unit sphere; deviations of successive bands are independent of each other.
      const double angle = degrees(2 * std::asin(std::min(1.0, own / 2)));
      error.degrees = static_cast<float>(
          std::min(180.0, std::sqrt(double(error.degrees) * error.degrees + angle * angle)));
    } else if (work.source->role == AttributeRole::TexCoord) {
      error.texture = raised(error.texture, own);
    }
  }

  const auto renamed = [&](Index wedge) {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (members_[k] == wedge) return new_of_member[k];
    }
    return kNone;
  };
  for (Index v : {kept, removed}) {
    const Index other = v == kept ? removed : kept;
    for (Index t : triangles_of(v)) {
      if (corner_of(t, other) >= 0) continue;
      Index& wedge = wedge_of_corner[3 * t + static_cast<Index>(corner_of(t, v))];
      wedge = renamed(wedge);
    }
  }
  wedges_of(layer, kept) = {first, static_cast<Index>(wedges.size()) - first};
}

// What a vanished triangle stood for is stood for by the neighbour that looks most like it.
void PatchSimplifier::hand_over_represented(Index t, Index kept) {
  const Vec3d& share = represented_[t];
  Index best = kNone;
  double best_dot = -1e300;
  for (Index u : triangles_of(kept)) {
    bool touches = false;
    for (Index c = 0; c < 3; ++c) {
      const Index w = vertex_of_corner_[3 * t + c];
      touches = touches || (w != kept && vertices_[w].alive && corner_of(u, w) >= 0);
    }
    if (!touches) continue;
    const double agreement = dot(normalized(represented_[u]), share);
    if (agreement > best_dot) {
      best_dot = agreement;
      best = u;
    }
  }
  if (best != kNone) represented_[best] += share;
}

void PatchSimplifier::derive_where_better(Index kept) {
  std::size_t l = 0;
  while (!work_.layers[l].is_normal) ++l;
  for (Index t : triangles_of(kept)) {
    if (!flat_[t]) continue;
    const Vec3d geometric = normalized(normal_of(t));
    if (dot(geometric, geometric) == 0) continue;
    const Wedge& wedge = wedges_[l][wedge_of_corner_[l][3 * t]];
    const Vec3d stored{wedge.value[0], wedge.value[1], wedge.value[2]};
    const Vec3d input = normalized(represented_[t]);
    if (squared(geometric - input) + kDeriveMargin >= squared(stored - input)) continue;
    flat_[t] = 0;
    derived_[t] = 1;
    result_.derived.push_back(TriangleId{global_triangle_[t]});
  }
}

void PatchSimplifier::write_back() {
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    const Index global = global_triangle_[t];
    if (!triangle_alive_[t]) {
      work_.vertex_of_corner[3 * global] = kNone;
      continue;
    }
    work_.derived[global] = derived_[t];
    if (!represented_.empty()) {
      const Vec3d& r = represented_[t];
      work_.represented[global] = {static_cast<float>(r.x), static_cast<float>(r.y),
                                   static_cast<float>(r.z)};
    }
    for (Index c = 0; c < 3; ++c) {
      work_.vertex_of_corner[3 * global + c] = vertices_[vertex_of_corner_[3 * t + c]].global;
      for (std::size_t l = 0; l < layer_count(); ++l) {
        work_.layers[l].of_corner[3 * global + c] = wedges_[l][wedge_of_corner_[l][3 * t + c]].id;
      }
    }
  }
  for (const Vertex& vertex : vertices_) {
    if (vertex.locked || !vertex.alive) continue;
    work_.positions[vertex.global] =
        center_grid_ + Vec3i{static_cast<std::int32_t>(std::lround(vertex.position.x)),
                             static_cast<std::int32_t>(std::lround(vertex.position.y)),
                             static_cast<std::int32_t>(std::lround(vertex.position.z))};
    work_.error_of_vertex[vertex.global] = vertex.error;
  }
}

}  // namespace crease::simplification
