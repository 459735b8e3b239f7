#include "runtime/geomorphs.h"

#include "hierarchy/grid_sum.h"
#include "runtime/draw_values.h"
#include "runtime/interpolate.h"

#include <utility>

namespace crease {

Geomorphs::Geomorphs(const MeshHierarchy& hierarchy) : hierarchy_(hierarchy) {
  for (std::uint32_t l = 0; l < hierarchy.layers.size(); ++l) {
    if (hierarchy.layers[l].role == AttributeRole::Normal) normal_layer_ = l;
  }
}

void Geomorphs::Moving::add(const Row& added) {
  if (has_rows()) {
    more.push_back(added);
  } else {
    row = added;
  }
}

float Geomorphs::share(const Moving& m) const {
  return seconds_ > 0 ? static_cast<float>((now_ - m.began) / seconds_) : 1.0f;
}

const Geomorphs::Row* Geomorphs::row_of(const Moving& m, std::uint32_t value) {
  if (m.row.value == value) return &m.row;
  for (const Row& row : m.more) {
    if (row.value == value) return &row;
  }
  return nullptr;
}

Vec3f Geomorphs::position_of(const Moving& m) const {
  return lerp(m.from, m.to, share(m));
}

Vec3f Geomorphs::normal_of(const Moving& m, std::uint32_t index) const {
  const Row* const row = row_of(m, index);
  return row == nullptr ? value(index) : slerp(row->from, row->to, share(m));
}

// What the corners that have attribute a of a child show once s is merged, or kNone.
std::uint32_t Geomorphs::value_above(SplitId s, bool second, RelativeAttribute a) const {
  const NodeId node = hierarchy_.vertices.node_of_split[index_of(s)];
  const RelativeAttribute above = hierarchy_.above(normal_layer_, s, second, a, WedgeId{});
  if (above >= hierarchy_.layers[normal_layer_].attribute_count(node)) return kNone;  // removed
  return hierarchy_.value_index(normal_layer_, node, above);
}

// Calls visit(a, value) for each attribute.
template <typename Visit>
void Geomorphs::visit_normals(NodeId node, Visit visit) const {
  if (normal_layer_ == kNone) return;
  const std::uint32_t count = hierarchy_.layers[normal_layer_].attribute_count(node);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto a = static_cast<RelativeAttribute>(i);
    visit(a, hierarchy_.value_index(normal_layer_, node, a));
  }
}

// Something that starts where the vertex is seen now.
Geomorphs::Moving Geomorphs::going(const ActiveCut& cut, std::uint32_t slot) const {
  Moving m;
  m.slot = slot;
  m.began = now_;
  m.from = position(cut, slot);
  return m;
}

void Geomorphs::set(const Moving& m) {
  drop(m.slot);
  if (m.slot >= moving_of_slot_.size()) moving_of_slot_.resize(m.slot + std::size_t(1), kNone);
  moving_of_slot_[m.slot] = static_cast<std::uint32_t>(moving_.size());
  moving_.push_back(m);
}

void Geomorphs::drop(std::uint32_t slot) {
  const std::uint32_t i = moving_of(slot);
  if (i == kNone) return;
  at_rest_.push_back(slot);
  moving_of_slot_[slot] = kNone;
  if (i + 1 != moving_.size()) {
    moving_[i] = std::move(moving_.back());
    moving_of_slot_[moving_[i].slot] = i;
  }
  moving_.pop_back();
}

void Geomorphs::advance(double seconds) {
  if (seconds > 0) now_ += std::min(seconds, kLongest);  // what is no number is none
  for (std::size_t i = moving_.size(); i-- > 0;) {
    if (moving_[i].leaving == kNoSplit && share(moving_[i]) >= 1) drop(moving_[i].slot);
  }
}

void Geomorphs::before_split(const ActiveCut& cut, std::uint32_t slot) {
  if (!is_on() && moving_.empty()) return;
  // One that began to leave in this very frame is at rest when it stays.
  if (const SplitId by = leaving(slot); by != kNoSplit) stay(cut, by);
  const std::uint32_t i = moving_of(slot);
  if (i == kNone) {
    above_ = going(cut, slot);
    return;
  }
  above_ = moving_[i];
  above_.from = position(cut, slot);
  drop(slot);
}

void Geomorphs::after_split(const ActiveCut& cut, SplitId s, std::uint32_t slot,
                            std::uint32_t other) {
  if (!is_on()) return;
  const VertexHierarchy& h = hierarchy_.vertices;
  const bool had_rows = above_.has_rows();
  for (const std::uint32_t child : {slot, other}) {
    if (child == kNoSlot) continue;
    const ActiveVertex& v = cut.vertices()[child];
    Moving m;
    m.slot = child;
    m.began = now_;
    m.from = above_.from;
    m.to = draw_position(h.grid, v.position);
    visit_normals(v.node, [&](RelativeAttribute a, std::uint32_t own) {
      const std::uint32_t before = value_above(s, h.is_second(v.node), a);
      if (before == kNone || (before == own && !had_rows)) return;
      const Row row{own, normal_of(above_, before), value(own)};
      if (!(row.from == row.to) && row_of(m, own) == nullptr) m.add(row);
    });
    if (m.goes()) set(m);
    if (had_rows) at_rest_.push_back(child);
  }
}

bool Geomorphs::leave(const ActiveCut& cut, SplitId s, const ActiveCut::Children& children,
                      bool for_room) {
  if (!is_on()) return false;
  const VertexHierarchy& h = hierarchy_.vertices;
  std::vector<Moving> going_there;
  bool goes = false;
  for (const std::uint32_t slot : {children.first, children.second}) {
    if (slot == kNoSlot) continue;
    const ActiveVertex& v = cut.vertices()[slot];
    Moving m = going(cut, slot);
    m.leaving = s;
    m.for_room = for_room;
    m.speaks = going_there.empty();
    m.to = draw_position(h.grid, grid_difference(v.position, h.delta_of(v.node)));
    const bool had_rows = is_moving(slot) && moving_[moving_of(slot)].has_rows();
    visit_normals(v.node, [&](RelativeAttribute a, std::uint32_t own) {
      const std::uint32_t after = value_above(s, h.is_second(v.node), a);
      if ((after == kNone || after == own) && !had_rows) return;
      const Row row{own, normal(slot, own), value(after == kNone ? own : after)};
      const bool stays = row.from == row.to && row.to == value(own);
      if (!stays && row_of(m, own) == nullptr) m.add(row);
    });
    goes |= m.goes();
    going_there.push_back(std::move(m));
  }
  if (!goes) return false;
  for (const Moving& m : going_there) set(m);
  leaving_triangles_ += h.triangles_of(s).size();
  return true;
}

bool Geomorphs::is_leaving(SplitId s, const ActiveCut::Children& children) const {
  return (children.first != kNoSlot && leaving(children.first) == s) ||
         (children.second != kNoSlot && leaving(children.second) == s);
}

void Geomorphs::stay(const ActiveCut& cut, SplitId s) {
  const ActiveCut::Children children = cut.children(s);
  if (!is_leaving(s, children)) return;
  leaving_triangles_ -= hierarchy_.vertices.triangles_of(s).size();
  for (const std::uint32_t slot : {children.first, children.second}) {
    if (slot == kNoSlot) continue;
    const ActiveVertex& v = cut.vertices()[slot];
    Moving m = going(cut, slot);
    m.to = draw_position(hierarchy_.vertices.grid, v.position);
    visit_normals(v.node, [&](RelativeAttribute, std::uint32_t own) {
      const Row row{own, normal(slot, own), value(own)};
      if (!(row.from == row.to) && row_of(m, own) == nullptr) m.add(row);
    });
    drop(slot);
    if (m.goes()) set(m);
  }
}

void Geomorphs::merged(SplitId s, const ActiveCut::Children& children) {
  if (is_leaving(s, children)) leaving_triangles_ -= hierarchy_.vertices.triangles_of(s).size();
  bool moved = false;
  for (const std::uint32_t slot : {children.first, children.second}) {
    if (slot == kNoSlot || !is_moving(slot)) continue;
    drop(slot);
    moved = true;
  }
  // Corners of the second one stand at the first one now.
  if (moved && children.first != kNoSlot) at_rest_.push_back(children.first);
}

const std::vector<Geomorphs::Leaving>& Geomorphs::all_leaving() {
  all_leaving_.clear();
  for (const Moving& m : moving_) {
    if (m.leaving == kNoSplit || !m.speaks) continue;
    all_leaving_.push_back({m.leaving, m.slot, m.for_room, share(m) >= 1});
  }
  return all_leaving_;
}

void Geomorphs::mark(ActiveCut& cut) {
  for (const Moving& m : moving_) cut.touch_moving(m.slot, m.has_rows());
  for (const std::uint32_t slot : at_rest_) {
    if (cut.vertices()[slot].node != kNoNode) cut.touch_moving(slot, true);
  }
  at_rest_.clear();
}

std::size_t Geomorphs::bytes() const {
  std::size_t sum = sizeof(Moving) * moving_.capacity() + 4 * moving_of_slot_.capacity() +
                    4 * at_rest_.capacity() + sizeof(Leaving) * all_leaving_.capacity();
  for (const Moving& m : moving_) sum += sizeof(Row) * m.more.capacity();
  return sum;
}

}  // namespace crease
