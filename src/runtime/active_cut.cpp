// The moves.
#include "runtime/active_cut.h"

#include "mesh/painted_layer.h"

#include "base/assert.h"
#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <bit>

namespace crease {

namespace {

bool has_choices(const AttributeHierarchy& layer) {
  return !layer.leaf_attribute.empty() || layer.parents_of_split.list_count() > 0;
}

}  // namespace

ActiveCut::ActiveCut(const MeshHierarchy& hierarchy, const char* is_hidden)
    : hierarchy_(hierarchy),
      h_(hierarchy.vertices),
      is_hidden_(is_hidden),
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
    orders_.push_back(layer.constant_of_wedge.empty() ? AttributeOrder(hierarchy, l)
                                                      : AttributeOrder());
    tracks_others_ |= l != normal_layer_;
  }
  texcoord_layer_ = painted_layer(hierarchy_.layers, hierarchy_.materials);
  arriving_.assign(3 * tracked_.size(), kNone);
  touches_triangles_ = normal_layer_ == kNone || is_painted() ||
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
    if (this->is_hidden(TriangleId{t})) continue;
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
    pass_down(s, is_second ? kNoSlot : slot, is_second ? slot : kNoSlot, had_one);
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
  pass_down(s, slot, other, had_one);

  const TriangleRange born = h_.triangles_of(s);
  for (std::uint32_t t = born.begin; t < born.end; ++t) {
    if (is_hidden(TriangleId{t})) continue;
    const std::array<WedgeId, 3> wedges = h_.triangles[t];
    const auto is_outside = [&](WedgeId wedge) { return wedge < begin || wedge >= end; };
    std::array<std::uint32_t, 3> slots;
    for (std::size_t k = 0; k < 3; ++k) slots[k] = wedges[k] < middle ? slot : other;
    const std::size_t third = is_outside(wedges[0]) ? 0 : is_outside(wedges[1]) ? 1 : 2;
    slots[third] = map_.slot_at(wedges[third]);
    activate(TriangleId{t}, wedges, slots);
  }
  touch_derived(s);
  return other;
}

// Those from `middle` on. `to` has none yet.
void ActiveCut::give_corners(std::uint32_t from, std::uint32_t to, WedgeId middle) {
  lists_.give(vertices_[from].corners, vertices_[to].corners, middle,
              [&](CornerRef corner) { stand_at(corner, to); });
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
    pass_up(s, slots.first, slots.second);
    const bool had_one = vertices_[slot].has_one_normal();
    stand(slot, node, grid_difference(vertices_[slot].position, delta));
    renew_after_merge(s, slot);
    touch_corners(slot, had_one);
    touch_derived(s);
    return;
  }
  ActiveVertex& first = vertices_[slots.first];
  ActiveVertex& second = vertices_[slots.second];
  const Vec3i position = grid_difference(first.position, h_.delta_of(first.node));
  pass_up(s, slots.first, slots.second);
  map_.clear(second.begin);
  first.end = second.end;
  take_corners(slots.second, slots.first);
  const bool had_one = first.has_one_normal() || second.has_one_normal();
  stand(slots.first, node, position);
  renew_after_merge(s, slots.first);
  touch_corners(slots.first, had_one);
  lists_.clear(second.corners);
  second.node = kNoNode;
  second.split = kNoSplit;
  free_slots_.push_back(slots.second);
  touch_derived(s);
}

// All of them, but for those of triangles that have a corner at either: they are told by what
// stands in both lists, so no triangle that stays is read.
void ActiveCut::take_corners(std::uint32_t from, std::uint32_t to) {
  CornerList& list = vertices_[from].corners;
  CornerList& kept = vertices_[to].corners;
  if (!list.is_own() || !kept.is_own()) return take_many_corners(from, to);
  std::uint32_t vanishing = 0, vanishing_of_kept = 0;
  for (std::uint32_t i = 0; i < list.count; ++i) {
    const std::uint32_t same = kept.of_triangle(list.refs[i]);
    vanishing_of_kept |= same;
    vanishing |= std::uint32_t(same != 0) << i;
  }
  while (vanishing_of_kept != 0) {
    const auto i = static_cast<std::uint32_t>(31 - std::countl_zero(vanishing_of_kept));
    vanishing_of_kept ^= 1u << i;
    kept.erase_own(i);
  }
  for (std::uint32_t left = list.all() & ~vanishing; left != 0; left &= left - 1) {
    const CornerAt at = list.own(static_cast<std::uint32_t>(std::countr_zero(left)));
    stand_at(at.corner, to);
    lists_.push_back(kept, at);
  }
  for (; vanishing != 0; vanishing &= vanishing - 1) {
    deactivate(list.refs[static_cast<std::size_t>(std::countr_zero(vanishing))], from, to);
  }
}

void ActiveCut::take_many_corners(std::uint32_t from, std::uint32_t to) {
  leaving_.clear();
  for (const CornerAt at : lists_.of(vertices_[from].corners)) leaving_.push_back(at);
  CornerList& kept = vertices_[to].corners;
  for (const CornerAt& at : leaving_) {
    const std::uint32_t* const slots = slots_of(at.corner);
    const auto other = static_cast<std::uint32_t>(std::find(slots, slots + 3, to) - slots);
    if (other == 3) {
      stand_at(at.corner, to);
      lists_.push_back(kept, at);
    } else {
      lists_.erase(kept, CornerRef(at.corner.part(), at.corner.triangle(), other));
      deactivate(at.corner, from, to);
    }
  }
}

void ActiveCut::activate(TriangleId t, const std::array<WedgeId, 3>& wedges,
                         const std::array<std::uint32_t, 3>& slots) {
  const std::size_t tracked = tracked_.size();
  ActiveVertex* const vertices = vertices_.data();
  bool one_normal = true;
  for (std::size_t k = 0; k < 3; ++k) one_normal &= vertices[slots[k]].has_one_normal();
  const bool has_values = tracked > 0 && (tracks_others_ || !one_normal);
  for (std::size_t k = 0; has_values && k < 3; ++k) {
    const ActiveVertex& v = vertices[slots[k]];
    for (std::size_t i = 0; i < tracked; ++i) {
      if (!has_several(i, v)) continue;  // what is kept is of no use
      arriving_[k * tracked + i] = value_at(i, v, wedges[k]);
    }
  }
  const bool is_derived = touches_triangles_ && is_derived_now(t);
  const bool is_smooth = !touches_triangles_ || (one_normal && !is_derived);
  const Part kind = is_smooth ? kSnPart : kind_of(is_derived, slots, arriving_);
  ActiveTriangles& part = parts_[kind];
  const std::uint32_t place = part.add(t, arriving_.size());
  if (has_values || kind != kSnPart) {
    std::copy_n(arriving_.begin(), 3 * tracked, part.values.begin() + 3 * tracked * place);
  }
  part.is_derived[place] = is_derived ? 1 : 0;
  std::uint32_t* const placed = &part.slots[3 * std::size_t(place)];
  for (std::uint32_t k = 0; k < 3; ++k) {
    placed[k] = slots[k];
    lists_.push_back(vertices[slots[k]].corners, {CornerRef(kind, place, k), wedges[k]});
  }
  part.moved.mark(place);
  if (kind != kSnPart || is_painted()) part.shaded.mark(place);
}

// Whose third corner is at neither of two, whose lists are left as they are.
void ActiveCut::deactivate(CornerRef corner, std::uint32_t from, std::uint32_t to) {
  const std::uint32_t* const slots = slots_of(corner);
  const bool first = (slots[0] != from) & (slots[0] != to);
  const bool second = (slots[1] != from) & (slots[1] != to);
  const std::uint32_t k = first ? 0 : 2 - std::uint32_t(second);
  lists_.erase(vertices_[slots[k]].corners, CornerRef(corner.part(), corner.triangle(), k));
  parts_[corner.part()].remove(corner.triangle());
}

// Of the corners at a vertex that has moved those whose triangle may have another kind or shading:
// its values are looked after by pass_down() and pass_up().
void ActiveCut::touch_corners(std::uint32_t slot, bool had_one_normal) {
  if (!touches_triangles_) return;
  const bool has_one = vertices_[slot].has_one_normal();
  const bool only_derived = !has_one && !had_one_normal;
  if (only_derived && !is_painted() && normal_layer_ != kNone && h_.deriving_splits.empty()) {
    return;
  }
  const CornerList& list = vertices_[slot].corners;
  const bool needs_derived = only_derived && !is_painted();
  const auto touch = [&](CornerRef corner) {
    ActiveTriangles& part = parts_[corner.part()];
    const bool is_derived = part.is_derived[corner.triangle()] != 0;
    part.touched.mark_if(corner.triangle(),
                         !needs_derived | is_derived | (corner.part() == kSnPart));
  };
  const bool only_others = has_one && !is_painted();
  if (!list.is_own()) {
    for (const CornerAt at : lists_.of(list)) {
      if (!only_others || at.corner.part() != kSnPart) touch(at.corner);
    }
    return;
  }
  std::uint32_t left = only_others ? list.of_other_parts(kSnPart) : list.all();
  for (; left != 0; left &= left - 1) {
    touch(list.refs[static_cast<std::size_t>(std::countr_zero(left))]);
  }
}

void ActiveCut::touch_moving(std::uint32_t slot, bool with_normals) {
  vertex_changes_.mark(slot);
  if (!touches_triangles_) return;
  for (const CornerAt at : lists_.of(vertices_[slot].corners)) {
    const std::uint32_t part = at.corner.part(), triangle = at.corner.triangle();
    if (part == kSnPart) continue;
    if (with_normals || parts_[part].is_derived[triangle] != 0) parts_[part].touched.mark(triangle);
  }
}

// Triangles that show their geometric normal while s is not done.
void ActiveCut::touch_derived(SplitId s) {
  if (h_.deriving_splits.empty() || normal_layer_ == kNone) return;
  for (TriangleId t : h_.derived_of_split.of(index_of(s))) {
    const WedgeId wedge = h_.triangles[index_of(t)][0];
    for (const CornerAt at : lists_.of(vertices_[map_.slot_at(wedge)].corners)) {
      ActiveTriangles& part = parts_[at.corner.part()];
      if (at.wedge != wedge || part.ids[at.corner.triangle()] != t) continue;
      part.is_derived[at.corner.triangle()] = is_done(s) ? 0 : 1;
      part.touched.mark(at.corner.triangle());
    }
  }
}

}  // namespace crease
