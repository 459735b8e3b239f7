// The rebuilt value array of a layer (DB03 8.3): first what the slots own, value i of slot i, so
// that values which several slots own are there several times; then what only indices refer to. An
// index to a value that a slot owns leads to the first such slot (DB03 newPosition).
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "hierarchy/attribute_values.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease {

class ValueTable {
 public:
  ValueTable(const AttributeLayer& source, const ContractionSequence& sequence, std::size_t layer)
      : source_(source), sequence_(sequence), layer_(layer) {
    number_of_id_.assign(source.value_count() + new_value_count(source, sequence, layer), kNone);
    is_used_.assign(number_of_id_.size(), false);
  }

  void add_owned(std::span<const std::uint32_t> id_of_slot) {
    for (std::uint32_t id : id_of_slot) {
      if (id == kNone) {  // a vertex that no triangle has, in a layer without values
        values_.insert(values_.end(), source_.dimension, 0.0f);
        ++count_;
        continue;
      }
      if (number_of_id_[id] == kNone) number_of_id_[id] = count_;
      append(id);
    }
  }
  void use(std::uint32_t id) { is_used_[id] = true; }
  void number_the_rest() {
    for (std::uint32_t id = 0; id < is_used_.size(); ++id) {
      if (!is_used_[id] || number_of_id_[id] != kNone) continue;
      number_of_id_[id] = count_;
      append(id);
    }
  }

  std::uint32_t number(std::uint32_t id) const { return number_of_id_[id]; }
  const std::vector<float>& values() const { return values_; }
  std::vector<float> take_values() { return std::move(values_); }

 private:
  void append(std::uint32_t id) {
    const auto value = attribute_value(source_, sequence_, layer_, AttributeId{id});
    values_.insert(values_.end(), value.begin(), value.end());
    ++count_;
  }

  const AttributeLayer& source_;
  const ContractionSequence& sequence_;
  std::size_t layer_;
  std::vector<std::uint32_t> number_of_id_;
  std::vector<bool> is_used_;
  std::vector<float> values_;
  std::uint32_t count_ = 0;
};

}  // namespace crease
