// The greedy loop of one patch, and what one contraction changes.
#include "simplify/patch_simplifier.h"
#include "simplify/sort_by_cost.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease::simplification {

namespace {

// A solved value this near to one that is there already is that one: it costs no record.
constexpr double kSameValue = 1e-3;
constexpr double kSameCopy = 2e-2;  // for a wedge that only moved along

// A pair that would fold something is tried again at once so often; then it waits.
constexpr std::uint32_t kTries = 2;

// A contraction that costs more than this many times the next one is not chosen now; how much more
// need not be known.
constexpr double kDear = 8;

double squared(const Vec3d& v) {
  return dot(v, v);
}

float raised(float base, double own) {
  return static_cast<float>(double(base) + own);
}

}  // namespace

std::vector<double> PatchSimplifier::initial_costs() {
  std::vector<double> costs;
  costs.reserve(pairs_.size());
  for (const auto& [a, b] : pairs_) costs.push_back(place(a, b, HUGE_VAL).cost);
  return costs;
}

bool PatchSimplifier::pop(Entry& entry) {
  const bool ordered = next_in_order_ != order_.size();
  if (heap_.empty() && !ordered) return false;
  if (heap_.empty() || (ordered && order_[next_in_order_].cost <= heap_.top().cost())) {
    const Ordered& next = order_[next_in_order_++];
    entry = {next.cost, next.pair, kNone, 0};
    return true;
  }
  entry = heap_.top();
  heap_.pop();
  return true;
}

float PatchSimplifier::next_cost() const {
  const float in_order = next_in_order_ == order_.size() ? HUGE_VALF : order_[next_in_order_].cost;
  return heap_.empty() ? in_order : std::min(in_order, heap_.top().cost());
}

PatchSimplifier::Index PatchSimplifier::survivor(Index v) {
  while (!vertices_[v].alive) {
    const Index into = vertices_[v].into;
    if (!vertices_[into].alive) vertices_[v].into = vertices_[into].into;
    v = into;
  }
  return v;
}

void PatchSimplifier::hold(const Entry& entry, double cost, const Placed& placed) {
  const bool waits = placed.cost <= steering_.cost_limit;
  const float cost_with_ring = static_cast<float>(placed.cost);
  if (blamed_ == kNone || entry.tries >= kTries) {
    if (waits) heap_.push({cost_with_ring, entry.pair(), kNone, entry.tries});
    return;
  }
  const Index id = static_cast<Index>(held_.size());
  Held& held = held_.emplace_back();
  held.pair = entry.pair();
  held.next = held_of_triangle_[blamed_];
  held.cost = static_cast<float>(cost);
  held.tries = static_cast<std::uint16_t>(entry.tries + 1);
  held.waiting = true;
  held.lasts = placed.lasts;
  held.looked_at = static_cast<Index>(result_.contractions.size());
  held.position = whole(placed.position);
  held.cost_with_ring = placed.cost;
  held_of_triangle_[blamed_] = id;
  if (waits) heap_.push({cost_with_ring, entry.pair(), id, entry.tries + 1});
}

void PatchSimplifier::release(Index triangle) {
  Index i = held_of_triangle_[triangle];
  held_of_triangle_[triangle] = kNone;
  for (; i != kNone; i = held_[i].next) {
    if (!held_[i].waiting) continue;
    held_[i].waiting = false;
    heap_.push({held_[i].cost, held_[i].pair, kNone, held_[i].tries});
  }
}

void PatchSimplifier::order_pairs() {
  clear_for(order_, pairs_.size() / 2);
  next_in_order_ = 0;
  clear_for(candidates_, pairs_.size() / 2);
  for (const auto& [a, b] : pairs_) {
    const Placed placed = place(a, b, steering_.cost_limit);
    if (!(placed.cost <= steering_.cost_limit)) continue;
    order_.push_back({static_cast<float>(placed.cost), static_cast<Index>(candidates_.size())});
    Candidate& pair = candidates_.emplace_back();
    pair.a = a;
    pair.b = b;
    pair.placed_at = 0;
    keep_placed(placed, pair);
  }
  sort_by_cost(order_, order_scratch_);
}

// Whether the pair is the first with these ends. One that is dropped keeps its old ones, of which
// one is gone, so that it is not taken for the owner.
bool PatchSimplifier::claim(Index pair, Index a, Index b) {
  if (2 * owner_count_ >= owners_.size()) {
    const std::vector<Index> old = std::move(owners_);
    owners_.assign(2 * old.size(), kNone);
    owner_count_ = 0;
    for (Index owner : old) {
      if (owner == kNone) continue;
      const Candidate& old_pair = candidates_[owner];
      if (vertices_[old_pair.a].alive && vertices_[old_pair.b].alive) {
        claim(owner, old_pair.a, old_pair.b);
      }
    }
  }
  const std::size_t mask = owners_.size() - 1;
  std::size_t slot = (a * 0x9e3779b1u ^ b * 0x85ebca77u) & mask;
  for (; owners_[slot] != kNone; slot = (slot + 1) & mask) {
    const Candidate& owner = candidates_[owners_[slot]];
    if (owner.a == a && owner.b == b) return owners_[slot] == pair;
  }
  owners_[slot] = pair;
  ++owner_count_;
  candidates_[pair].a = a;
  candidates_[pair].b = b;
  return true;
}

PatchResult PatchSimplifier::run() {
  result_.new_values.resize(layer_count());
  held_of_triangle_.assign(global_triangle_.size(), kNone);
  changed_around_.assign(vertices_.size(), 0);
  order_pairs();
  owners_.assign(std::bit_ceil(2 * candidates_.size() + 64), kNone);
  owner_count_ = 0;
  for (Entry entry; pop(entry);) {
    const Held* waited = nullptr;
    if (entry.held != kNone) {
      if (!held_[entry.held].waiting) continue;
      held_[entry.held].waiting = false;
      waited = &held_[entry.held];
    }
    Candidate& pair = candidates_[entry.pair()];
    Index a = survivor(pair.a), b = survivor(pair.b);
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    if (!claim(entry.pair(), a, b)) continue;
    if (waited != nullptr && waited->lasts &&
        std::max(changed_around_[a], changed_around_[b]) <= waited->looked_at) {
      find_ring(a, b);
      contract(a, b, to_double(waited->position), waited->cost_with_ring);
      continue;
    }
    const float next = next_cost();

    if (std::max(vertices_[a].changed_at, vertices_[b].changed_at) > pair.placed_at) {
      pair.placed_at = static_cast<Index>(result_.contractions.size());
      keep_placed(place(a, b, steering_.cost_limit), pair);
    }
    const double cost = pair.cost;
    if (!(cost <= steering_.cost_limit)) continue;
    if (static_cast<float>(cost) > entry.cost() && static_cast<float>(cost) > next) {
      heap_.push({static_cast<float>(cost), entry.pair(), kNone, entry.tries});
      continue;
    }
    const double bound =
        std::min(steering_.cost_limit, kDear * double(std::max(next, static_cast<float>(cost))));
    const Placed placed = make_legal(pair, bound);
    if (!(placed.cost <= steering_.cost_limit) || (static_cast<float>(placed.cost) > entry.cost() &&
                                                   static_cast<float>(placed.cost) > next)) {
      hold(entry, cost, placed);
      continue;
    }
    contract(a, b, placed.position, placed.cost);
  }
  write_back();
  result_.triangles_left = live_triangles_;
  result_.contractions.shrink_to_fit();  // all patches' results wait for the last one
  result_.changes.shrink_to_fit();
  return std::move(result_);
}

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

  // Errors: the bands before, and this band's quadrics on top.
  Errors& errors = errors_[kept];
  errors.base = larger(errors.base, errors_[removed].base);
  LevelError error = errors.base;
  surface_[kept].add(surface_[removed]);
  if (!turn_.empty()) turn_[kept].add(turn_[removed]);
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

  if (kept != a) find_ring(kept, removed);  // else make_legal() has
  if (ring_.empty()) {
    // A part disappears: its planes fit what is left of it, but what it stood for is gone.
    double longest2 = 0;
    for (const Vanishing& vanishing : vanishing_) {
      const Index* v = &vertex_of_corner_[3 * vanishing.triangle];
      for (Index c = 0; c < 3; ++c) {
        longest2 = std::max(longest2, squared(positions_[v[c]] - positions_[v[(c + 1) % 3]]));
      }
    }
    error.surface = raised(error.surface, std::sqrt(longest2));
  }

  // Wedges are joined while the vanishing triangles still stand.
  for (std::size_t l = 0; l < layer_count(); ++l) contract_layer(l, kept, removed, target, error);
  errors.now = larger(larger(errors.now, errors_[removed].now), error);

  // Triangles: vanish, or change hands.
  if (!shading_.empty()) hand_over_represented();
  for (std::size_t i = ring_kept_; i < ring_.size(); ++i) vertex_of_corner_[ring_[i].corner] = kept;
  const Index first = static_cast<Index>(triangle_pool_.size());
  for (const RingTriangle& ring : ring_) triangle_pool_.push_back(ring.triangle);
  q.triangles = {first, static_cast<Index>(triangle_pool_.size()) - first};
  positions_[kept] = target;
  for (Index t : triangles_of(kept)) facing_[t] = facing_of(t);
  if (!work_->category_of_triangle.empty() && category_around_[kept] != category_around_[removed]) {
    category_around_[kept] = kNone;
  }
  q.flat_around = q.flat_around && p.flat_around;
  p.alive = false;
  p.into = kept;
  for (const auto& [t, third] : vanishing_) {
    triangle_alive_[t] = 0;
    --live_triangles_;
    Slice& around = vertices_[third].triangles;
    Index* begin = &triangle_pool_[around.first];
    Index* end = std::remove(begin, begin + around.count, t);
    around.count = static_cast<Index>(end - begin);
    release(t);
  }
  if (!shading_.empty()) derive_where_better(kept, errors.now);

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
  for (Index t : triangles_of(kept)) release(t);
}

CREASE_WIDE void PatchSimplifier::find_ring(Index kept, Index removed) {
  const std::span<const Index> around_kept = triangles_of(kept);
  const std::span<const Index> around_removed = triangles_of(removed);
  // What does not belong to a list is written over by what comes next: no branches.
  RingTriangle* ring = ring_.start(around_kept.size() + around_removed.size());
  Vanishing* vanishing = vanishing_.start(around_kept.size());
  for (Index t : around_kept) {
    const RingTriangle own = ring_triangle(t, kept);
    const bool before = own.previous == removed, after = own.next == removed;
    *ring = own;
    *vanishing = {t, after ? own.previous : own.next};
    vanishing += before | after;
    ring += !(before | after);
  }
  vanishing_.finish(vanishing);
  ring_kept_ = static_cast<std::size_t>(ring - ring_.begin());
  for (Index t : around_removed) {
    const RingTriangle own = ring_triangle(t, removed);
    *ring = own;
    ring += (own.previous != kept) & (own.next != kept);
  }
  ring_.finish(ring);
}

// One quadric out of the members', in the place of one of them; none if all show one attribute that
// is the same all over their triangles.
void PatchSimplifier::combine_quadrics(std::size_t layer, std::span<const Index> members,
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

// Gives a joined wedge, whose area and quadric are known, its value; returns its attribute id, or
// kNone if it is new.
PatchSimplifier::Index PatchSimplifier::chosen_value(std::size_t layer,
                                                     std::span<const Index> members, Index fixed,
                                                     Slice of_kept, const Vec3d& target,
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
  double norm2 = 0;
  for (int j = 0; j < work.dimension; ++j) {
    if (work.steers) {
      value[j] = attribute_quadrics_[layer][result.quadric].weighted_value(j, target);
    } else {
      for (Index w : members) value[j] += wedges[w].area * double(wedges[w].value[j]);
    }
    value[j] /= result.area;
    norm2 += value[j] * value[j];
  }
  if (work.is_direction) {
    if (!(norm2 > 1e-4)) return inherit();  // opposite directions: there is no middle
    for (int j = 0; j < work.dimension; ++j) value[j] /= std::sqrt(norm2);
  }
  const double same = members.size() == 1 ? kSameCopy : kSameValue;
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
  join_wedges(layer, kept, removed);
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

  Index* result_of_slot = parent_.start(used_.size());  // join_wedges is done with it
  results_.clear();
  double square_error = -1;
  for (const Joined& joined : joined_) {
    const std::span<const Index> members(&members_[joined.first_member], joined.member_count);
    bool any_used = false;
    for (Index w : members) any_used = any_used || used_[slot_of(w)];
    if (!any_used) continue;
    Wedge& result = results_.emplace_back(wedges[members[0]]);
    for (Index w : members.subspan(1)) {
      result.area += wedges[w].area;
      result.pinned = result.pinned || wedges[w].pinned;
    }
    if (work.steers) combine_quadrics(layer, members, result);
    const Index inherited = chosen_value(layer, members, joined.fixed, of_kept, target, result);
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
        square =
            attribute_quadrics_[layer][result.quadric].at(target, work.dimension, result.value);
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

void PatchSimplifier::write_back() {
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    const Index global = global_triangle_[t];
    if (!triangle_alive_[t]) {
      work_->vertex_of_corner[3 * global] = kNone;
      continue;
    }
    work_->derived[global] = derived_[t];
    if (!shading_.empty()) work_->represented[global] = shading_[t].input;
    for (Index c = 0; c < 3; ++c) {
      work_->vertex_of_corner[3 * global + c] = vertices_[vertex_of_corner_[3 * t + c]].global;
      for (std::size_t l = 0; l < layer_count(); ++l) {
        work_->layers[l].of_corner[3 * global + c] = wedges_[l][wedge_of_corner_[l][3 * t + c]].id;
      }
    }
  }
  for (Index v = 0; v < vertices_.size(); ++v) {
    const Vertex& vertex = vertices_[v];
    if (vertex.locked || !vertex.alive) continue;
    work_->positions[vertex.global] = on_grid(positions_[v]);
    work_->error_of_vertex[vertex.global] = errors_[v].now;
  }
}

}  // namespace crease::simplification
