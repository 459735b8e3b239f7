// The values of one attribute layer and their ids. What is flat, a value that all corners of some
// triangle have, is one attribute wherever it is met, so that the triangle has one normal.
// Elsewhere equal values at different vertices are different attributes.
#pragma once

#include "codec/layer_values.h"
#include "crease/ids.h"
#include "crease/vec.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace crease::codec {

class ValuePool {
 public:
  ValuePool(const LayerValues& values, std::uint32_t dimension)
      : values_(values), dimension_(dimension) {}

  // kFlat: of what is flat.
  static constexpr std::uint32_t kFlat = kNone;
  std::uint32_t intern(const CodedValue& code, std::uint32_t vertex) {
    if (vertex == kFlat) return intern_flat(code, [&] { add(code); });
    if (vertex >= newest_of_vertex_.size()) newest_of_vertex_.resize(vertex + 1, kNone);
    std::uint32_t& newest = newest_of_vertex_[vertex];
    std::uint32_t last = kNone;
    std::size_t tried = 0;
    for (std::uint32_t id = newest; id != kNone && tried < kMostTried; id = entries_[id].before) {
      if (entries_[id].code == code) return id;
      last = id;
      ++tried;
    }
    if (tried == kMostTried) {
      const auto older = older_.find({vertex, code});
      if (older != older_.end()) return older->second;
      older_.emplace(AtVertex{vertex, entries_[last].code}, last);
    }
    const std::uint32_t before = std::exchange(newest, size());
    add(code);
    entries_.back().before = before;
    return newest;
  }
  // An id of its own for a code that others have too.
  std::uint32_t add(const CodedValue& code) {
    entries_.push_back({code});
    numbers_.resize(numbers_.size() + dimension_);
    values_.read(code, std::span(numbers_).last(dimension_));
    return size() - 1;
  }
  // A direction that no code needs to have.
  std::uint32_t intern_direction(const Vec3f& d) {
    const CodedValue bits{std::bit_cast<std::int32_t>(d.x), std::bit_cast<std::int32_t>(d.y),
                          std::bit_cast<std::int32_t>(d.z), kIsDirection};
    return intern_flat(bits, [&] {
      entries_.push_back({bits});
      numbers_.insert(numbers_.end(), {d.x, d.y, d.z});
    });
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  bool is_flat(std::uint32_t id) const { return entries_[id].before == kIsFlat; }
  const CodedValue& code(std::uint32_t id) const { return entries_[id].code; }
  std::span<const float> value(std::uint32_t id) const {
    return std::span(numbers_).subspan(std::size_t(id) * dimension_, dimension_);
  }
  const std::vector<float>& numbers() const { return numbers_; }
  CodedValue nearest_code(std::span<const float> value) const {
    return values_.nearest_code(value);
  }

 private:
  static constexpr std::int32_t kIsDirection = 1;  // in a component that directions leave 0
  static constexpr std::uint32_t kIsFlat = kNone - 1;
  // Of a vertex's values, the newest ones; a pole may have thousands.
  static constexpr std::size_t kMostTried = 64;
  struct Entry {
    CodedValue code;
    std::uint32_t before = kNone;  // interned at the same vertex; or kIsFlat
  };

  struct AtVertex {
    std::uint32_t vertex = 0;
    CodedValue code;
    bool operator==(const AtVertex&) const = default;
  };
  struct HashOfAtVertex {
    std::size_t operator()(const AtVertex& at) const {
      return hash_of(at.code) ^ at.vertex * std::size_t(0x9e3779b97f4a7c15u);
    }
  };

  static std::size_t hash_of(const CodedValue& code) {
    std::uint64_t pairs[2];
    std::memcpy(pairs, code.data(), sizeof pairs);
    std::uint64_t h = pairs[0] * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 32 ^ pairs[1]) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h ^ h >> 32);
  }
  template <typename Add>
  std::uint32_t intern_flat(const CodedValue& code, const Add& add_it) {
    if (2 * flat_count_ >= flat_.size()) grow();
    std::size_t at = hash_of(code) & (flat_.size() - 1);
    while (flat_[at] != kNone && entries_[flat_[at]].code != code)
      at = (at + 1) & (flat_.size() - 1);
    if (flat_[at] != kNone) return flat_[at];
    flat_[at] = size();
    ++flat_count_;
    add_it();
    entries_.back().before = kIsFlat;
    return size() - 1;
  }
  void grow() {
    const std::vector<std::uint32_t> before = std::exchange(flat_, {});
    flat_.resize(before.empty() ? 64 : 4 * before.size(), kNone);
    for (const std::uint32_t id : before) {
      if (id == kNone) continue;
      std::size_t at = hash_of(entries_[id].code) & (flat_.size() - 1);
      while (flat_[at] != kNone) at = (at + 1) & (flat_.size() - 1);
      flat_[at] = id;
    }
  }

  const LayerValues& values_;
  std::uint32_t dimension_;
  std::vector<Entry> entries_;  // per id
  std::vector<float> numbers_;
  std::vector<std::uint32_t> newest_of_vertex_;                        // interned at it, or kNone
  std::unordered_map<AtVertex, std::uint32_t, HashOfAtVertex> older_;  // than the newest ones
  std::vector<std::uint32_t> flat_;  // ids by hash, at most half of them taken
  std::size_t flat_count_ = 0;
};

}  // namespace crease::codec
