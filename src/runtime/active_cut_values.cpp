// The values of corners, whose vertices move.
#include "runtime/active_cut.h"

#include <algorithm>

namespace crease {

namespace {

bool keeps_values(const AttributeHierarchy& layer, SplitId s) {
  return !layer.keeps_values.empty() && layer.keeps_values.test(index_of(s));
}

}  // namespace

// What a corner that comes to v shows. Where the wedge varies, another corner of it often stands
// there already.
std::uint32_t ActiveCut::value_at(std::size_t place, const ActiveVertex& v, WedgeId wedge) const {
  const std::uint32_t l = tracked_[place];
  if (!orders_[place].empty()) {
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    const AttributeOrder::Node node = orders_[place].node(layer, v.node);
    return layer.stored_value(layer.place_of_value(node.begin) +
                              orders_[place].attribute_at(node, wedge));
  }
  const PackedIndices<>& constants = hierarchy_.layers[l].constant_of_wedge;
  const std::uint32_t constant = constants.empty() ? 0 : constants[index_of(wedge)];
  if (constant != 0) return constant - 1;
  for (const CornerAt at : lists_.of(v.corners)) {
    if (at.wedge == wedge) return kept_value(at, place);
  }
  return hierarchy_.value_index(l, v.node, hierarchy_.attribute_at(l, v.node, wedge));
}

// The corners at the children of s had their values at v_s.
void ActiveCut::pass_down(SplitId s, std::uint32_t first, std::uint32_t second,
                          bool had_one_normal) {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const std::uint32_t l = tracked_[i];
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    if (layer.parents_of_split.is_empty(index_of(s))) continue;  // neither has several
    if (!orders_[i].empty()) {
      for (const std::uint32_t slot : {first, second}) renew_values(slot, i);
      continue;
    }
    const bool had_several = l == normal_layer_
                                 ? !had_one_normal
                                 : layer.attribute_count(h_.node_of_split[index_of(s)]) > 1;
    if (had_several && keeps_values(layer, s)) continue;
    for (const std::uint32_t slot : {first, second}) {
      if (slot == kNoSlot || !has_several(i, vertices_[slot])) continue;
      step_down(s, slot, slot == second, i);
    }
  }
}

// Looks up what all corners at a vertex have now.
void ActiveCut::renew_values(std::uint32_t slot, std::size_t place) {
  if (slot == kNoSlot || !has_several(place, vertices_[slot])) return;
  const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
  const AttributeOrder::Node node = orders_[place].node(layer, vertices_[slot].node);
  const std::uint32_t first = layer.place_of_value(node.begin);
  for (const CornerAt at : corners_of(slot)) {
    const std::uint32_t value =
        layer.stored_value(first + orders_[place].attribute_at(node, at.wedge));
    ActiveTriangles& part = parts_[at.corner.part()];
    std::uint32_t& kept = part.values[tracked_.size() * at.corner.index() + place];
    part.touched.mark_if(at.corner.triangle(), value != kept);
    kept = value;
  }
}

void ActiveCut::renew_after_merge(SplitId s, std::uint32_t slot) {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    if (orders_[i].empty()) continue;
    if (hierarchy_.layers[tracked_[i]].parents_of_split.is_empty(index_of(s))) continue;
    renew_values(slot, i);
  }
}

// MeshHierarchy::below() for all of them: what each attribute above comes from. Where values stay,
// v_s has a single one.
void ActiveCut::step_down(SplitId s, std::uint32_t slot, bool second, std::size_t place) {
  const std::uint32_t l = tracked_[place];
  const AttributeHierarchy& layer = hierarchy_.layers[l];
  const CompactRanges::Range at_s =
      layer.attribute_ranges.range(index_of(h_.node_of_split[index_of(s)]));
  const CompactRanges::Range at_child =
      layer.attribute_ranges.range(index_of(vertices_[slot].node));
  const std::uint32_t count_above = at_s.end - at_s.begin;
  const std::uint32_t count_below = at_child.end - at_child.begin;
  const std::uint32_t above = layer.place_of_value(at_s.begin);
  if (keeps_values(layer, s)) {
    const std::uint32_t value = layer.stored_value(above);
    for (const CornerAt at : corners_of(slot)) set_value(at, place, value);
    return;
  }
  const std::uint32_t below = layer.place_of_value(at_child.begin);
  const ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
  const std::size_t first = second ? parents.size() - count_below : 0;
  const bool had_several = count_above > 1;
  steps_.assign(count_above, {});
  for (std::uint32_t a = 0; a < count_below; ++a) {
    const RelativeAttribute to = parents[first + a];
    if (to == kRemoved) continue;
    Step& step = steps_[to];
    step.has_more = step.below != kNone;
    if (step.has_more) continue;
    step = {layer.stored_value(above + to), layer.stored_value(below + a), to, false};
  }
  const auto is_idle = [had_several](const Step& step) {
    return step.below == kNone || (had_several && !step.has_more && step.above == step.below);
  };
  steps_.erase(std::remove_if(steps_.begin(), steps_.end(), is_idle), steps_.end());
  if (steps_.empty()) return;
  for (const CornerAt at : corners_of(slot)) {
    const std::uint32_t value = kept_value(at, place);
    for (const Step& step : steps_) {
      if (had_several && step.above != value) continue;
      set_value(
          at, place,
          step.has_more
              ? layer.stored_value(below + hierarchy_.below(l, s, second, step.at_parent, at.wedge))
              : step.below);
      break;
    }
  }
}

void ActiveCut::pass_up(SplitId s, std::uint32_t first, std::uint32_t second) {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const AttributeHierarchy& layer = hierarchy_.layers[tracked_[i]];
    if (!orders_[i].empty() || layer.parents_of_split.is_empty(index_of(s))) continue;
    const bool keeps = keeps_values(layer, s);
    for (const std::uint32_t slot : {first, second}) {
      if (slot == kNoSlot || (keeps && has_several(i, vertices_[slot]))) continue;
      step_up(s, slot, slot == second, i);
    }
  }
}

// MeshHierarchy::above() for all of them. Where values stay, the child has a single one.
void ActiveCut::step_up(SplitId s, std::uint32_t slot, bool second, std::size_t place) {
  const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
  const CompactRanges::Range at_s =
      layer.attribute_ranges.range(index_of(h_.node_of_split[index_of(s)]));
  if (at_s.end - at_s.begin <= 1) return;
  const CompactRanges::Range at_child =
      layer.attribute_ranges.range(index_of(vertices_[slot].node));
  const std::uint32_t count_below = at_child.end - at_child.begin;
  const std::uint32_t below = layer.place_of_value(at_child.begin);
  if (keeps_values(layer, s)) {
    const std::uint32_t value = layer.stored_value(below);
    for (const CornerAt at : corners_of(slot)) set_value(at, place, value);
    return;
  }
  const std::uint32_t above = layer.place_of_value(at_s.begin);
  const ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
  const std::size_t first = second ? parents.size() - count_below : 0;
  const bool has_several = count_below > 1;
  steps_.clear();
  for (std::uint32_t a = 0; a < count_below; ++a) {
    const RelativeAttribute to = parents[first + a];
    if (to == kRemoved) continue;
    const Step step{layer.stored_value(above + to), layer.stored_value(below + a)};
    if (!has_several || step.above != step.below) steps_.push_back(step);
  }
  if (steps_.empty()) return;
  for (const CornerAt at : corners_of(slot)) {
    const std::uint32_t value = kept_value(at, place);
    for (const Step& step : steps_) {
      if (has_several && step.below != value) continue;
      set_value(at, place, step.above);
      break;
    }
  }
}

}  // namespace crease
