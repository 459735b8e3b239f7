// The greedy loop of one patch: which pair is contracted next, and what is left in the end.
#include "parallel/parallel.h"
#include "simplify/patch_simplifier.h"
#include "simplify/sort_by_cost.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace crease::simplification {

namespace {

// A pair that would fold something is tried again at once so often; then it waits.
constexpr std::uint32_t kTries = 2;

// A contraction that costs more than this many times the next one is not chosen now; how much more
// need not be known.
constexpr double kDear = 8;

// Pairs between two looks whether to stop: around hubs one takes milliseconds.
constexpr std::size_t kBetweenLooks = 256;

// From this share of the limit on a contraction is near it.
constexpr double kNearLimit = 0.25;

}  // namespace

// Calls take(a, b, placed) for all pairs, in their order. Where no other patch keeps the other
// threads busy they place as well.
template <typename Take>
void PatchSimplifier::place_all(double bound, Take take) {
  if (!steering_.is_alone) {
    for (const auto& [a, b] : pairs_) take(a, b, place(a, b, bound, joins_));
    return;
  }
  constexpr std::size_t kAtOnce = 16384, kTask = 512;
  PerThread<Joins> joins;
  std::vector<Placed> placed(std::min(kAtOnce, pairs_.size()));
  for (std::size_t first = 0; first < pairs_.size(); first += kAtOnce) {
    const auto pairs = std::span(pairs_).subspan(first, std::min(kAtOnce, pairs_.size() - first));
    parallel_ranges(pairs.size(), kTask, [&](std::size_t begin, std::size_t end) {
      Joins& own = joins.local();
      for (std::size_t i = begin; i != end; ++i) {
        placed[i] = place(pairs[i].first, pairs[i].second, bound, own);
      }
    });
    for (std::size_t i = 0; i != pairs.size(); ++i) {
      take(pairs[i].first, pairs[i].second, placed[i]);
    }
  }
}

std::vector<double> PatchSimplifier::initial_costs() {
  std::vector<double> costs;
  costs.reserve(pairs_.size());
  place_all(HUGE_VAL, [&](Index, Index, const Placed& placed) { costs.push_back(placed.cost); });
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

// What the pairs that are soon popped read first: they lie anywhere.
void PatchSimplifier::fetch_ahead() const {
  const std::size_t near = next_in_order_ + 3, far = next_in_order_ + 6;
  if (far < order_.size()) __builtin_prefetch(&candidates_[order_[far].pair]);
  if (near < order_.size()) {
    const Candidate& pair = candidates_[order_[near].pair];
    __builtin_prefetch(&vertices_[pair.a]);
    __builtin_prefetch(&vertices_[pair.b]);
    __builtin_prefetch(&owners_[slot_of(pair.a, pair.b)]);
  }
  if (!heap_.empty()) __builtin_prefetch(&candidates_[heap_.top().pair()]);
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

// Whether a cost is the least that waits, or no more than its pair was taken for.
bool PatchSimplifier::is_next(const Entry& entry, double cost) const {
  const float rounded = static_cast<float>(cost);
  return rounded <= entry.cost() || rounded <= next_cost();
}

// What make_legal() found, if it is next also when the witness that is farthest away has its say.
void PatchSimplifier::contract_or_hold(const Entry& entry, Index a, Index b, double cost,
                                       Placed& placed) {
  const auto is_due = [&] {
    return placed.cost <= steering_.cost_limit && is_next(entry, placed.cost);
  };
  if (!is_due()) return hold(entry, cost, placed);
  const float grown = keep_volume(a, b, placed);
  measure_witnesses(a, b, placed);
  const double far = std::max(double(farthest_witness_) - kRounding, 0.0);
  double least = steering_.far_area * far * far;
  if (placed.cost > kNearLimit * steering_.cost_limit) {
    result_.far_counts.add(least / placed.cost);
  }
  least = cost_with_part(a, b, least);
  if (least > placed.cost) {
    placed.cost = least;
    blamed_ = kNone;
    if (!is_due()) return hold(entry, cost, placed);
  }
  const Island island = island_broken_by(a, b, placed);
  if (island.is_locked) return;  // of other patches as well: not in this pass
  if (island.is_aside) {         // looked at again without it
    if (close_island(island, placed.cost)) {
      heap_.push({static_cast<float>(cost), entry.pair(), kNone, entry.tries});
      return;
    }
    find_ring(a, b);
    measure_witnesses(a, b, placed);
  }
  const Index broken = broken_by(a, b, placed.cost);
  const bool vanishes = broken != kNone && part_at(a) == part_at(b);
  grown_[a] = grown_[b] = grown;
  contract(a, b, placed.position, placed.cost);
  if (vanishes) vanish(a, placed.cost);
  if (!island.members.empty()) close_island(island, placed.cost);
}

void PatchSimplifier::hold(const Entry& entry, double cost, const Placed& placed) {
  const bool waits = placed.cost <= steering_.cost_limit;
  const float cost_with_ring = static_cast<float>(placed.cost);
  const bool is_tried_again = blamed_ != kNone && entry.tries < kTries;
  if (!is_tried_again && !(waits && placed.lasts)) {
    if (waits) heap_.push({cost_with_ring, entry.pair(), kNone, entry.tries});
    return;
  }
  const Index id = static_cast<Index>(held_.size());
  const std::uint32_t tries = entry.tries + is_tried_again;
  Held& held = held_.emplace_back();
  held.pair = entry.pair();
  held.cost = static_cast<float>(cost);
  held.tries = static_cast<std::uint16_t>(tries);
  held.waiting = true;
  held.lasts = placed.lasts;
  held.looked_at = static_cast<Index>(result_.contractions.size());
  held.position = whole(placed.position);
  held.cost_with_ring = placed.cost;
  if (is_tried_again) held.next = std::exchange(held_of_triangle_[blamed_], id);
  if (waits) heap_.push({cost_with_ring, entry.pair(), id, tries});
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
  place_all(steering_.cost_limit, [&](Index a, Index b, const Placed& placed) {
    if (!(placed.cost <= steering_.cost_limit)) return;
    order_.push_back({static_cast<float>(placed.cost), static_cast<Index>(candidates_.size())});
    Candidate& pair = candidates_.emplace_back();
    pair.a = a;
    pair.b = b;
    pair.known_at = 0;
    keep_placed(placed, pair);
  });
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
  std::size_t slot = slot_of(a, b);
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

PatchResult PatchSimplifier::run(SharedProgress& progress) {
  loaded_ = kNone;
  result_.new_values.resize(layer_count());
  held_of_triangle_.assign(global_triangle_.size(), kNone);
  changed_around_.assign(vertices_.size(), 0);
  order_pairs();
  owners_.assign(std::bit_ceil(2 * candidates_.size() + 64), kNone);
  owner_count_ = 0;
  std::size_t taken = 0;
  for (Entry entry; pop(entry);) {
    if (++taken % kBetweenLooks == 0) progress.advance(0);
    if (progress.stopped()) break;
    fetch_ahead();
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
    const bool owns = pair.known_at != 0 && pair.a == a && pair.b == b;
    if (!owns && !claim(entry.pair(), a, b)) continue;
    if (waited != nullptr && waited->lasts &&
        std::max(changed_around_[a], changed_around_[b]) <= waited->looked_at) {
      find_ring(a, b);
      blamed_ = kNone;
      const double known = cost_with_part(a, b, waited->cost_with_ring);
      Placed placed{known, known, to_double(waited->position), true};
      contract_or_hold(entry, a, b, known, placed);
      continue;
    }

    if (std::max(vertices_[a].changed_at, vertices_[b].changed_at) >= std::max(pair.known_at, 1u)) {
      keep_placed(place(a, b, steering_.cost_limit, joins_), pair);
    }
    pair.known_at = static_cast<Index>(result_.contractions.size()) + 1;
    const double cost = pair.cost;
    if (!(cost <= steering_.cost_limit)) continue;
    if (!is_next(entry, cost)) {
      heap_.push({static_cast<float>(cost), entry.pair(), kNone, entry.tries});
      continue;
    }
    const double dear = kDear * double(std::max(next_cost(), static_cast<float>(cost)));
    Placed placed = make_legal(pair, std::min(steering_.cost_limit, dear));
    contract_or_hold(entry, a, b, cost, placed);
  }
  write_back();
  result_.triangles_left = live_triangles_;
  return result_;  // a copy without room to grow: all patches' results wait for the last one
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
      work_->vertex_of_corner[3 * global + c] = vertices_[vertex_of_corner_[4 * t + c]].global;
      for (std::size_t l = 0; l < layer_count(); ++l) {
        work_->layers[l].of_corner[3 * global + c] = wedges_[l][wedge_of_corner_[l][4 * t + c]].id;
      }
    }
  }
  for (Index v = 0; v < vertices_.size(); ++v) {
    const Vertex& vertex = vertices_[v];
    if (vertex.locked || !vertex.alive) continue;
    work_->positions[vertex.global] = on_grid(positions_[v]);
    work_->error_of_vertex[vertex.global] = errors_[v].now;
    work_->grown_of_vertex[vertex.global] = grown_[v];
  }
}

}  // namespace crease::simplification
