// The moves of vertices. Corners follow in active_cut_corners.cpp.
#include "runtime/active_cut.h"

#include "mesh/drawn_texcoords.h"

#include "base/assert.h"
#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <bit>

namespace crease {

namespace {

constexpr std::size_t kManyWedges = std::size_t(1) << 17;

bool has_choices(const AttributeHierarchy& layer) {
  return !layer.leaf_attribute.empty() || layer.parents_of_split.list_count() > 0;
}

}  // namespace

ActiveCut::ActiveCut(const MeshHierarchy& hierarchy, const char* is_hidden)
    : hierarchy_(hierarchy),
      h_(hierarchy.vertices),
      is_hidden_(is_hidden),
      is_large_(h_.wedge_count() > kManyWedges),
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
    if (!layer.constant_of_wedge.empty()) constants_.push_back(&layer.constant_of_wedge);
    tracks_others_ |= l != normal_layer_;
  }
  texcoord_layer_ = drawn_texcoords(hierarchy_.layers);
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
    show_vertex(slot, attributes_of_normals(h_.root(r)));
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
  following_of_slot_.push_back(kNone);
  const auto slot = static_cast<std::uint32_t>(vertices_.size() - 1);
  to_of_slot_.push_back(slot);
  return slot;
}

void ActiveCut::stand(std::uint32_t slot, NodeId node, const Vec3i& position) {
  ActiveVertex& v = vertices_[slot];
  v.node = node;
  v.split = h_.split_of(node);
  v.position = position;
}

// What it shows where it stands.
void ActiveCut::show_vertex(std::uint32_t slot, const CompactRanges::Range& normals) {
  if (normal_layer_ != kNone) vertices_[slot].normal = normal_in(normals);
  vertex_changes_.mark(slot);
}

// With one look-up for both.
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
  const std::uint32_t other = split_vertex(slot);
  bring_corners_down();
  return other;
}

void ActiveCut::merge(SplitId s, const Children& slots) {
  merge_vertices(s, slots);
  bring_corners_up();
}

std::uint32_t ActiveCut::follow(std::uint32_t slot) {
  std::uint32_t& i = following_of_slot_[slot];
  if (i == kNone) {
    i = static_cast<std::uint32_t>(following_.size());
    following_.push_back({slot, vertices_[slot].node, vertices_[slot].has_one_normal(), false});
  }
  return i;
}

std::uint32_t ActiveCut::split_vertex(std::uint32_t slot) {
  const SplitId s = vertices_[slot].split;
  const WedgeId begin = vertices_[slot].begin, end = vertices_[slot].end;
  const Vec3i position = vertices_[slot].position;
  CREASE_ASSERT(s != kNoSplit);
  const std::uint32_t i = follow(slot);
  moves_.push_back(s);
  set_done(s, true);
  const WedgeId middle = h_.second_wedge[index_of(s)];
  if (middle == begin || middle == end) {
    const NodeId child = h_.child(s, middle == begin);
    stand(slot, child, grid_sum(position, h_.delta_of(child)));
    return kNoSlot;
  }
  const std::uint32_t other = take_slot();
  following_of_slot_[other] = static_cast<std::uint32_t>(following_.size());
  following_.push_back({other, following_[i].from, following_[i].had_one_normal, true});
  vertices_[slot].end = middle;
  vertices_[other].begin = middle;
  vertices_[other].end = end;
  map_.set(middle, other);
  stand_at_children(s, slot, other, position);
  return other;
}

void ActiveCut::merge_vertices(SplitId s, const Children& slots) {
  CREASE_ASSERT(is_done(s));
  moves_.push_back(s);
  set_done(s, false);
  const bool has_both = slots.first != kNoSlot && slots.second != kNoSlot;
  const std::uint32_t slot = slots.first != kNoSlot ? slots.first : slots.second;
  if (slot == kNoSlot) return;
  follow(slot);
  ActiveVertex& v = vertices_[slot];
  v.position = grid_difference(v.position, h_.delta_of(v.node));
  v.node = h_.node_of_split[index_of(s)];
  v.split = s;
  if (!has_both) return;
  follow(slots.second);
  ActiveVertex& second = vertices_[slots.second];
  map_.clear(second.begin);
  v.end = second.end;
  second.node = kNoNode;
  second.split = kNoSplit;
}

void ActiveCut::activate(TriangleId t, const std::array<WedgeId, 3>& wedges,
                         const std::array<std::uint32_t, 3>& slots) {
  const std::size_t tracked = tracked_.size();
  ActiveVertex* const vertices = vertices_.data();
  bool one_normal = true;
  for (std::size_t k = 0; k < 3; ++k) one_normal &= vertices[slots[k]].has_one_normal();
  const bool has_values = tracked > 0 && (tracks_others_ || !one_normal);
  for (std::size_t i = 0; has_values && i < tracked; ++i) {
    // Where a vertex has one value, what is kept is of no use. Who has several nobody can foretell.
    std::uint32_t varying = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t constant = constant_at(i, wedges[k]);
      arriving_[k * tracked + i] = constant;
      varying |= std::uint32_t(constant == kNone && has_several(i, vertices[slots[k]])) << k;
    }
    for (; varying != 0; varying &= varying - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(varying));
      const ActiveVertex& v = vertices[slots[k]];
      arriving_[k * tracked + i] = varying_value_at(i, v, wedges[k], lists_.of(v.corners));
    }
  }
  const bool is_derived = touches_triangles_ && is_derived_now(t);
  const bool is_smooth = !touches_triangles_ || (one_normal && !is_derived);
  const Part kind = is_smooth ? kSnPart : kind_of(is_derived, slots, arriving_);
  ActiveTriangles& part = parts_[kind];
  const std::uint32_t place = part.add(t, arriving_.size());
  if (has_values || kind != kSnPart) {
    std::uint32_t* const values = part.values.data() + 3 * tracked * place;
    for (std::size_t i = 0; i < 3 * tracked; ++i) values[i] = arriving_[i];
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
