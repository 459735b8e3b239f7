#include "assemble/attribute_rules.h"

#include "hierarchy/attribute_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace crease {

RuledValues::RuledValues(const AttributeLayer& source, const ContractionSequence& sequence,
                         std::size_t layer)
    : source_(source),
      sequence_(sequence),
      layer_(layer),
      known_count_(source.value_count() + new_value_count(source, sequence, layer)) {
  if (source.interpolation != Interpolation::Direction || source.dimension != 3) return;
  if (const auto bits = octahedral_bits_of(source.values)) lattice_.emplace(*bits);
}

std::span<const float> RuledValues::value(AttributeId id) const {
  if (index_of(id) < known_count_) return attribute_value(source_, sequence_, layer_, id);
  return std::span<const float>(blended_).subspan((index_of(id) - known_count_) * source_.dimension,
                                                  source_.dimension);
}

AttributeId RuledValues::blend(std::span<const AttributeId> ids) {
  if (sequence_.placement == Placement::Endpoint) return ids[0];
  std::array<double, 4> sum{};
  double square = 0;
  for (std::size_t i = 0; i < source_.dimension; ++i) {
    for (AttributeId id : ids) sum[i] += double(value(id)[i]);
    square += sum[i] * sum[i];
  }
  double scale = 1.0 / double(ids.size());
  if (source_.interpolation == Interpolation::Direction) {
    if (std::sqrt(square) < 1e-2 * double(ids.size())) return ids[0];  // opposite: no middle
    scale = 1.0 / std::sqrt(square);
  }
  if (lattice_) {
    const Vec3f on_lattice = lattice_->decode(lattice_->encode(Vec3d{sum[0], sum[1], sum[2]}));
    sum = {double(on_lattice.x), double(on_lattice.y), double(on_lattice.z), 0};
    scale = 1;
  }
  const std::size_t id = known_count_ + blended_.size() / source_.dimension;
  for (std::size_t i = 0; i < source_.dimension; ++i) {
    blended_.push_back(static_cast<float>(sum[i] * scale));
  }
  return AttributeId{static_cast<std::uint32_t>(id)};
}

std::uint32_t AttributeRules::root(std::uint32_t i) {
  while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
  return i;
}

void AttributeRules::link(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

void AttributeRules::link_equal_ids(std::span<const Candidate> candidates) {
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return candidates[a].id < candidates[b].id; });
  for (std::size_t i = 1; i < order_.size(); ++i) {
    if (candidates[order_[i]].id == candidates[order_[i - 1]].id) link(order_[i], order_[i - 1]);
  }
}

std::span<const AttributeId> AttributeRules::apply(
    std::span<const Candidate> candidates,
    std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
    std::span<const AttributeChange> changes, std::size_t layer, RuledValues& values) {
  parent_.resize(candidates.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  order_ = parent_;
  result_.assign(candidates.size(), kNoAttribute);
  for (const auto& [a, b] : links) link(a, b);
  link_equal_ids(candidates);

  // (1) The record.
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].is_live) continue;
    if (candidates[i].is_shown) result_[i] = candidates[i].id;
    for (const AttributeChange& change : changes) {
      if (change.layer == layer && change.from == candidates[i].id) result_[i] = change.to;
    }
  }

  // (3) What it says nothing about, one linked set after the other.
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ra = root(a), rb = root(b);
    return ra != rb ? ra < rb : a < b;
  });
  for (std::size_t first = 0; first < order_.size();) {
    std::size_t end = first + 1;
    while (end < order_.size() && root(order_[end]) == root(order_[first])) ++end;
    decide_unshown(candidates, std::span(order_).subspan(first, end - first), values);
    first = end;
  }
  return result_;
}

void AttributeRules::decide_unshown(std::span<const Candidate> candidates,
                                    std::span<const std::uint32_t> linked, RuledValues& values) {
  ids_.clear();
  AttributeId decided = kNoAttribute, face_value = kNoAttribute;
  bool several_decided = false, several_face_values = false;
  for (std::uint32_t i : linked) {
    const Candidate& c = candidates[i];
    if (!c.is_live) continue;
    if (result_[i] != kNoAttribute) {
      several_decided = several_decided || (decided != kNoAttribute && decided != result_[i]);
      decided = result_[i];
      continue;
    }
    if (std::find(ids_.begin(), ids_.end(), c.id) == ids_.end()) ids_.push_back(c.id);
    if (!c.is_face_value) continue;
    several_face_values = several_face_values || (face_value != kNoAttribute && face_value != c.id);
    face_value = c.id;
  }
  if (ids_.empty()) return;
  AttributeId joined = kNoAttribute;  // none: each stays what it is
  if (values.can_blend() && !several_decided && !several_face_values) {
    joined = decided != kNoAttribute      ? decided
             : face_value != kNoAttribute ? face_value
             : ids_.size() > 1            ? values.blend(ids_)
                                          : kNoAttribute;
  }
  for (std::uint32_t i : linked) {
    const Candidate& c = candidates[i];
    if (!c.is_live || result_[i] != kNoAttribute) continue;
    result_[i] = joined == kNoAttribute || c.is_face_value ? c.id : joined;
  }
}

}  // namespace crease
