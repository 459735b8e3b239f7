// The moves.
#include "runtime/active_cut.h"

#include "base/assert.h"
#include "hierarchy/grid_sum.h"

#include <algorithm>

namespace crease {

namespace {

bool has_choices(const AttributeHierarchy& layer) {
  return !layer.leaf_attribute.empty() || layer.parents_of_split.list_count() > 0;
}

}  // namespace

ActiveCut::ActiveCut(const MeshHierarchy& hierarchy)
    : hierarchy_(hierarchy),
      h_(hierarchy.vertices),
      place_of_layer_(hierarchy.layers.size(), kNone),
      done_((h_.split_count() + 63) / 64, 0),
      map_(h_.wedge_count()) {
  for (std::uint32_t l = 0; l < hierarchy_.layers.size(); ++l) {
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    if (layer.role == AttributeRole::Normal) normal_layer_ = l;
    if (layer.role == AttributeRole::Color && color_layer_ == kNone) color_layer_ = l;
    if (!has_choices(layer)) continue;
    place_of_layer_[l] = static_cast<std::uint32_t>(tracked_.size());
    tracked_.push_back(l);
  }
  touches_triangles_ = normal_layer_ == kNone || color_layer_ != kNone ||
                       place_of_layer_[normal_layer_] != kNone || !h_.deriving_splits.empty();
  for (std::uint32_t r = 0; r < h_.root_count; ++r) {
    if (h_.root_wedges[r] == h_.root_wedges[r + 1]) continue;
    const std::uint32_t slot = take_slot();
    vertices_[slot].begin = h_.root_wedges[r];
    vertices_[slot].end = h_.root_wedges[r + 1];
    map_.set(h_.root_wedges[r], slot);
    stand(slot, h_.root(r), h_.root_positions[r]);
  }
  const TriangleRange coarse = h_.coarse_triangles();
  for (std::uint32_t t = coarse.begin; t < coarse.end; ++t) {
    std::array<std::uint32_t, 3> slots;
    for (std::size_t k = 0; k < 3; ++k) slots[k] = map_.slot_at(h_.triangles[t][k]);
    activate(TriangleId{t}, h_.triangles[t], slots);
  }
}

std::size_t ActiveCut::triangle_count() const {
  std::size_t sum = 0;
  for (const ActiveTriangles& part : parts_) sum += part.count();
  return sum;
}

std::uint32_t ActiveCut::take_slot() {
  if (!free_slots_.empty()) {
    const std::uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
  }
  vertices_.emplace_back();
  vertex_changes_.grow(vertices_.size());
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void ActiveCut::stand(std::uint32_t slot, NodeId node, const Vec3i& position) {
  ActiveVertex& v = vertices_[slot];
  v.node = node;
  v.split = h_.split_of(node);
  v.position = position;
  if (normal_layer_ != kNone) {
    const AttributeHierarchy& layer = hierarchy_.layers[normal_layer_];
    v.normal = normal_in(layer.attribute_ranges.range(index_of(node)));
  }
  vertex_changes_.mark(slot);
}

// As stand() for each, with one look-up for both where there is one.
void ActiveCut::stand_at_children(SplitId s, std::uint32_t first, std::uint32_t second,
                                  const Vec3i& position) {
  const NodeId node = h_.first_child(s);
  ActiveVertex& v = vertices_[first];
  ActiveVertex& other = vertices_[second];
  const std::uint32_t rank = h_.is_split.rank(index_of(node));
  const bool is_split = h_.is_split.test(index_of(node));
  v.node = node;
  v.split = is_split ? SplitId{rank} : kNoSplit;
  v.position = grid_sum(position, h_.delta_of(node));
  other.node = h_.second_child(s);
  other.split = h_.is_split.test(index_of(other.node)) ? SplitId{rank + is_split} : kNoSplit;
  other.position = grid_sum(position, h_.delta_of(other.node));
  if (normal_layer_ != kNone) {
    const AttributeHierarchy& layer = hierarchy_.layers[normal_layer_];
    const auto ranges = layer.attribute_ranges.two_ranges(index_of(node));
    v.normal = normal_in(ranges[0]);
    other.normal = normal_in(ranges[1]);
  }
  vertex_changes_.mark(first);
  vertex_changes_.mark(second);
}

std::uint32_t ActiveCut::normal_in(const CompactRanges::Range& attributes) const {
  const std::uint32_t count = attributes.end - attributes.begin;
  if (count == 1) return hierarchy_.layers[normal_layer_].own_value(attributes.begin);
  return count == 0 ? ActiveVertex::kNoNormal : ActiveVertex::kSeveral;
}

ActiveCut::Children ActiveCut::children(SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  Children found;
  if (middle < h_.wedge_count()) {
    const std::uint32_t slot = map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle)});
    if (vertices_[slot].node == h_.second_child(s)) found.second = slot;
  }
  if (middle > 0) {
    const std::uint32_t slot = map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle - 1)});
    if (vertices_[slot].node == h_.first_child(s)) found.first = slot;
  }
  return found;
}

std::uint32_t ActiveCut::split(std::uint32_t slot) {
  const SplitId s = vertices_[slot].split;
  const WedgeId begin = vertices_[slot].begin, end = vertices_[slot].end;
  const Vec3i position = vertices_[slot].position;
  const bool had_one = vertices_[slot].has_one_normal();
  CREASE_ASSERT(s != kNoSplit);
  set_done(s, true);
  const WedgeId middle = h_.second_wedge[index_of(s)];
  if (middle == begin || middle == end) {
    const bool is_second = middle == begin;
    const NodeId child = h_.child(s, is_second);
    stand(slot, child, grid_sum(position, h_.delta_of(child)));
    touch_corners(slot, had_one);
    pass_down(s, slot, is_second, had_one);
    touch_derived(s);
    return kNoSlot;
  }
  const std::uint32_t other = take_slot();
  vertices_[slot].end = middle;
  vertices_[other].begin = middle;
  vertices_[other].end = end;
  map_.set(middle, other);
  stand_at_children(s, slot, other, position);
  give_corners(slot, other, middle);
  touch_corners(slot, had_one);
  touch_corners(other, had_one);
  pass_down(s, slot, false, had_one);
  pass_down(s, other, true, had_one);

  const TriangleRange born = h_.triangles_of(s);
  for (std::uint32_t t = born.begin; t < born.end; ++t) {
    const std::array<WedgeId, 3> wedges = h_.triangles[t];
    std::array<std::uint32_t, 3> slots;
    for (std::size_t k = 0; k < 3; ++k) {
      const WedgeId wedge = wedges[k];
      slots[k] = wedge < begin || wedge >= end ? map_.slot_at(wedge)
                 : wedge < middle              ? slot
                                               : other;
    }
    activate(TriangleId{t}, wedges, slots);
  }
  touch_derived(s);
  return other;
}

// Those from `middle` on. Which way a corner goes is a coin toss, so both ways are written and one
// counts. `to` has none yet.
void ActiveCut::give_corners(std::uint32_t from, std::uint32_t to, WedgeId middle) {
  CornerList& list = vertices_[from].corners;
  CornerList& other = vertices_[to].corners;
  const std::span<CornerAt> all = lists_.of(list);
  const bool fits = all.size() <= CornerList::kOwn;
  if (!fits) leaving_.resize(all.size());
  CornerAt* const leaving = fits ? other.own.data() : leaving_.data();
  std::uint32_t stay = 0, leave = 0;
  for (const CornerAt at : all) {
    const bool leaves = at.wedge >= middle;
    leaving[leave] = at;
    all[stay] = at;
    leave += leaves ? 1 : 0;
    stay += leaves ? 0 : 1;
  }
  if (fits) {
    list.count = stay;
    other.count = leave;
  } else {
    lists_.resize(list, stay);
    lists_.resize(other, leave);
    std::copy_n(leaving_.begin(), leave, lists_.of(other).begin());
  }
  for (const CornerAt& at : lists_.of(other)) {
    slots_of(at.corner)[at.corner.corner()] = to;
    parts_[at.corner.part()].moved.mark(at.corner.triangle());
  }
}

void ActiveCut::merge(SplitId s, const Children& slots) {
  CREASE_ASSERT(is_done(s));
  const NodeId node = h_.node_of_split[index_of(s)];
  set_done(s, false);
  if (slots.first == kNoSlot || slots.second == kNoSlot) {
    const bool is_second = slots.first == kNoSlot;
    const std::uint32_t slot = is_second ? slots.second : slots.first;
    if (slot == kNoSlot) return;
    const Vec3i delta = h_.delta_of(vertices_[slot].node);
    pass_up(s, slot, is_second);
    const bool had_one = vertices_[slot].has_one_normal();
    stand(slot, node, grid_difference(vertices_[slot].position, delta));
    touch_corners(slot, had_one);
    touch_derived(s);
    return;
  }
  ActiveVertex& first = vertices_[slots.first];
  ActiveVertex& second = vertices_[slots.second];
  const Vec3i position = grid_difference(first.position, h_.delta_of(first.node));
  pass_up(s, slots.first, false);
  pass_up(s, slots.second, true);
  map_.clear(second.begin);
  first.end = second.end;
  take_corners(slots.second, slots.first);
  const bool had_one = first.has_one_normal() || second.has_one_normal();
  stand(slots.first, node, position);
  touch_corners(slots.first, had_one);
  lists_.clear(second.corners);
  second.node = kNoNode;
  second.split = kNoSplit;
  free_slots_.push_back(slots.second);
  touch_derived(s);
}

// All of them, but for those of triangles that have a corner at either.
void ActiveCut::take_corners(std::uint32_t from, std::uint32_t to) {
  leaving_.clear();
  collapsed_.clear();
  for (const CornerAt& at : lists_.of(vertices_[from].corners)) {
    std::uint32_t* const slots = slots_of(at.corner);
    if (slots[0] == to || slots[1] == to || slots[2] == to) {
      collapsed_.push_back(at.corner.triangle_key());
      deactivate(at.corner, from, to);
    } else {
      slots[at.corner.corner()] = to;
      parts_[at.corner.part()].moved.mark(at.corner.triangle());
      leaving_.push_back(at);
    }
  }
  CornerList& list = vertices_[to].corners;
  if (!collapsed_.empty()) {
    if (collapsed_.size() > 8) std::sort(collapsed_.begin(), collapsed_.end());
    const auto is_collapsed = [this](const CornerAt& at) {
      const std::uint32_t key = at.corner.triangle_key();
      return collapsed_.size() > 8
                 ? std::binary_search(collapsed_.begin(), collapsed_.end(), key)
                 : std::find(collapsed_.begin(), collapsed_.end(), key) != collapsed_.end();
    };
    const std::span<CornerAt> all = lists_.of(list);
    const auto last = std::remove_if(all.begin(), all.end(), is_collapsed);
    list.count = static_cast<std::uint32_t>(last - all.begin());
  }
  const std::size_t staying = list.count;
  lists_.resize(list, staying + leaving_.size());
  std::copy(leaving_.begin(), leaving_.end(), lists_.of(list).begin() + std::ptrdiff_t(staying));
}

void ActiveCut::activate(TriangleId t, const std::array<WedgeId, 3>& wedges,
                         const std::array<std::uint32_t, 3>& slots) {
  const std::size_t tracked = tracked_.size();
  arriving_.resize(3 * tracked);
  bool one_normal = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const ActiveVertex& v = vertices_[slots[k]];
    one_normal &= v.has_one_normal();
    for (std::size_t i = 0; i < tracked; ++i) {
      arriving_[k * tracked + i] =
          has_several(i, v) ? hierarchy_.value_at(tracked_[i], v.node, wedges[k]) : kNone;
    }
  }
  const bool is_derived = touches_triangles_ && is_derived_now(t);
  const bool is_smooth = !touches_triangles_ || (one_normal && !is_derived);
  const Part kind = is_smooth ? kSnPart : kind_of(is_derived, slots, arriving_);
  ActiveTriangles& part = parts_[kind];
  const std::uint32_t place = part.add(t, arriving_.size());
  for (std::size_t i = 0; i < arriving_.size(); ++i) {
    part.values[arriving_.size() * place + i] = arriving_[i];
  }
  part.is_derived[place] = is_derived ? 1 : 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    part.slots[3 * std::size_t(place) + k] = slots[k];
    lists_.push_back(vertices_[slots[k]].corners, {CornerRef(kind, place, k), wedges[k]});
  }
  part.moved.mark(place);
  if (kind != kSnPart || color_layer_ != kNone) part.shaded.mark(place);
}

// Which has corners at `from` and at `to`; the lists of these two are left as they are.
void ActiveCut::deactivate(CornerRef corner, std::uint32_t from, std::uint32_t to) {
  const std::uint32_t* const slots = slots_of(corner);
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (slots[k] == from || slots[k] == to) continue;
    lists_.erase(vertices_[slots[k]].corners, CornerRef(corner.part(), corner.triangle(), k));
  }
  parts_[corner.part()].remove(corner.triangle());
}

// Of the corners at a vertex that has moved those whose triangle may have another kind or shading:
// its values are looked after by pass_down() and pass_up().
void ActiveCut::touch_corners(std::uint32_t slot, bool had_one_normal) {
  if (!touches_triangles_) return;
  const bool has_one = vertices_[slot].has_one_normal();
  const bool only_derived = !has_one && !had_one_normal && color_layer_ == kNone;
  if (only_derived && normal_layer_ != kNone && h_.deriving_splits.empty()) return;
  for (const CornerAt& at : lists_.of(vertices_[slot].corners)) {
    ActiveTriangles& part = parts_[at.corner.part()];
    const bool touched = at.corner.part() == kSnPart
                             ? !has_one || color_layer_ != kNone
                             : !only_derived || part.is_derived[at.corner.triangle()] != 0;
    if (touched) part.touched.mark(at.corner.triangle());
  }
}

void ActiveCut::set_value(const CornerAt& at, std::size_t place, std::uint32_t value) {
  ActiveTriangles& part = parts_[at.corner.part()];
  part.values[tracked_.size() * at.corner.index() + place] = value;
  part.touched.mark(at.corner.triangle());
}

// The corners at the child of s in `slot` had their values at v_s.
void ActiveCut::pass_down(SplitId s, std::uint32_t slot, bool second, bool had_one_normal) {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const std::uint32_t l = tracked_[i];
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    if (layer.parents_of_split.is_empty(index_of(s))) continue;  // neither has several
    if (!has_several(i, vertices_[slot])) continue;
    const bool had_several = l == normal_layer_
                                 ? !had_one_normal
                                 : layer.attribute_count(h_.node_of_split[index_of(s)]) > 1;
    if (had_several && !layer.keeps_values.empty() && layer.keeps_values.test(index_of(s))) {
      continue;
    }
    step_down(s, slot, second, i);
  }
}

// MeshHierarchy::below() for all of them: what each attribute above comes from.
void ActiveCut::step_down(SplitId s, std::uint32_t slot, bool second, std::size_t place) {
  const std::uint32_t l = tracked_[place];
  const AttributeHierarchy& layer = hierarchy_.layers[l];
  const CompactRanges& ranges = layer.attribute_ranges;
  const NodeId node = h_.node_of_split[index_of(s)], child = h_.child(s, second);
  const std::uint32_t count_above = ranges.count(index_of(node));
  const std::uint32_t count_below = ranges.count(index_of(child));
  const ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
  const std::size_t first = second ? parents.size() - count_below : 0;
  const bool had_several = count_above > 1;
  const auto value_below = [&](std::size_t a) {
    return hierarchy_.value_index(l, child, static_cast<RelativeAttribute>(a));
  };
  steps_.assign(count_above, {});
  for (std::size_t a = 0; a < count_below; ++a) {
    const RelativeAttribute to = parents[first + a];
    if (to == kRemoved) continue;
    Step& step = steps_[to];
    step.has_more = step.below != kNone;
    if (step.has_more) continue;
    step = {hierarchy_.value_index(l, node, to), value_below(a), to, false};
  }
  const auto is_idle = [had_several](const Step& step) {
    return step.below == kNone || (had_several && !step.has_more && step.above == step.below);
  };
  steps_.erase(std::remove_if(steps_.begin(), steps_.end(), is_idle), steps_.end());
  for (const CornerAt& at : lists_.of(vertices_[slot].corners)) {
    const std::uint32_t above =
        parts_[at.corner.part()].values[tracked_.size() * at.corner.index() + place];
    for (const Step& step : steps_) {
      if (had_several && step.above != above) continue;
      set_value(at, place,
                step.has_more
                    ? value_below(hierarchy_.below(l, s, second, step.at_parent, at.wedge))
                    : step.below);
      break;
    }
  }
}

void ActiveCut::pass_up(SplitId s, std::uint32_t slot, bool second) {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const AttributeHierarchy& layer = hierarchy_.layers[tracked_[i]];
    if (layer.parents_of_split.is_empty(index_of(s))) continue;
    const bool keeps = !layer.keeps_values.empty() && layer.keeps_values.test(index_of(s));
    if (keeps && has_several(i, vertices_[slot])) continue;
    step_up(s, slot, second, i);
  }
}

// MeshHierarchy::above() for all of them.
void ActiveCut::step_up(SplitId s, std::uint32_t slot, bool second, std::size_t place) {
  const std::uint32_t l = tracked_[place];
  const AttributeHierarchy& layer = hierarchy_.layers[l];
  const CompactRanges& ranges = layer.attribute_ranges;
  const NodeId node = h_.node_of_split[index_of(s)], child = h_.child(s, second);
  if (ranges.count(index_of(node)) <= 1) return;
  const std::uint32_t count_below = ranges.count(index_of(child));
  const ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
  const std::size_t first = second ? parents.size() - count_below : 0;
  const bool has_several = count_below > 1;
  const bool keeps = !layer.keeps_values.empty() && layer.keeps_values.test(index_of(s));
  steps_.clear();
  for (std::size_t a = 0; a < count_below; ++a) {
    const RelativeAttribute to = parents[first + a];
    if (to == kRemoved) continue;
    const std::uint32_t below = hierarchy_.value_index(l, child, static_cast<RelativeAttribute>(a));
    const Step step{keeps ? below : hierarchy_.value_index(l, node, to), below};
    if (!has_several || step.above != step.below) steps_.push_back(step);
  }
  for (const CornerAt& at : lists_.of(vertices_[slot].corners)) {
    const std::uint32_t below =
        parts_[at.corner.part()].values[tracked_.size() * at.corner.index() + place];
    for (const Step& step : steps_) {
      if (has_several && step.below != below) continue;
      set_value(at, place, step.above);
      break;
    }
  }
}

// Triangles that show their geometric normal while s is not done.
void ActiveCut::touch_derived(SplitId s) {
  if (h_.deriving_splits.empty() || normal_layer_ == kNone) return;
  for (TriangleId t : h_.derived_of_split.of(index_of(s))) {
    const WedgeId wedge = h_.triangles[index_of(t)][0];
    for (const CornerAt& at : lists_.of(vertices_[map_.slot_at(wedge)].corners)) {
      ActiveTriangles& part = parts_[at.corner.part()];
      if (at.wedge != wedge || part.ids[at.corner.triangle()] != t) continue;
      part.is_derived[at.corner.triangle()] = is_done(s) ? 0 : 1;
      part.touched.mark(at.corner.triangle());
    }
  }
}

void ActiveCut::prefetch_split(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  prefetch_vertex(slot);
  h_.second_wedge.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (first - h_.root_count));
  h_.deltas.prefetch(3 * (first - h_.root_count) + 5);
  h_.is_split.prefetch(first);
  h_.triangle_ranges.prefetch(index_of(s) + 1);
  if (normal_layer_ != kNone) hierarchy_.layers[normal_layer_].attribute_ranges.prefetch(first);
}

void ActiveCut::prefetch_split_further(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  const std::size_t below = h_.is_split.rank(first);
  if (below < h_.bounds.size()) __builtin_prefetch(&h_.bounds[below]);
  const TriangleRange born = h_.triangles_of(s);
  if (born.begin < born.end) h_.triangles.of_corner.prefetch(3 * std::size_t(born.begin));
  if (vertices_[slot].split == s) prefetch_corners(slot);
}

void ActiveCut::prefetch_merge(std::uint32_t slot, SplitId s) const {
  prefetch_vertex(slot);
  h_.second_wedge.prefetch(index_of(s));
  h_.node_of_split.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (index_of(h_.first_child(s)) - h_.root_count));
}

void ActiveCut::prefetch_merge_further(std::uint32_t slot, SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle < h_.wedge_count()) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle)});
  if (middle > 0) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle - 1)});
  prefetch_corners(slot);
  const NodeId node = h_.node_of_split[index_of(s)];
  h_.is_split.prefetch(index_of(node));
  if (h_.is_root(node)) return;
  const SplitId above = h_.split_above(node);
  __builtin_prefetch(&h_.bounds[index_of(above)]);
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  h_.deltas.prefetch(3 * (index_of(node) - h_.root_count));
}

void ActiveCut::prefetch_siblings(SplitId s) const {
  const Children slots = children(s);
  for (const std::uint32_t slot : {slots.first, slots.second}) {
    if (slot != kNoSlot) prefetch_vertex(slot);
  }
}

void ActiveCut::prefetch_corners(std::uint32_t slot) const {
  for (const CornerAt& at : corners_of(slot)) {
    __builtin_prefetch(&parts_[at.corner.part()].slots[3 * std::size_t(at.corner.triangle())]);
  }
}

}  // namespace crease
