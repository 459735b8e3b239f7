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
    Place& place = place_of(code, vertex);
    if (place.id != kNone) return place.id;
    place = {vertex, size()};
    add(code);
    ++interned_count_;
    return size() - 1;
  }
  // An id of its own for a code that others have too.
  std::uint32_t add(const CodedValue& code) {
    codes_.push_back(code);
    numbers_.resize(numbers_.size() + dimension_);
    values_.read(code, std::span(numbers_).last(dimension_));
    return size() - 1;
  }
  // A direction that no code needs to have.
  std::uint32_t intern_direction(const Vec3f& d) {
    const CodedValue bits{std::bit_cast<std::int32_t>(d.x), std::bit_cast<std::int32_t>(d.y),
                          std::bit_cast<std::int32_t>(d.z), kIsDirection};
    Place& place = place_of(bits, kFlat);
    if (place.id != kNone) return place.id;
    place = {kFlat, size()};
    codes_.push_back(bits);
    numbers_.insert(numbers_.end(), {d.x, d.y, d.z});
    ++interned_count_;
    return size() - 1;
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(codes_.size()); }
  const CodedValue& code(std::uint32_t id) const { return codes_[id]; }
  std::span<const float> value(std::uint32_t id) const {
    return std::span(numbers_).subspan(std::size_t(id) * dimension_, dimension_);
  }
  const std::vector<float>& numbers() const { return numbers_; }
  CodedValue code_of(std::span<const float> value) const { return values_.code(value); }

 private:
  static constexpr std::int32_t kIsDirection = 1;  // in a component that directions leave 0
  struct Place {                                   // of an interned value; free: kNone
    std::uint32_t vertex = 0, id = kNone;
  };

  static std::size_t hash_of(const CodedValue& code, std::uint32_t vertex) {
    std::uint64_t pairs[2];
    std::memcpy(pairs, code.data(), sizeof pairs);
    std::uint64_t h = (pairs[0] ^ vertex) * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 32 ^ pairs[1]) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h ^ h >> 32);
  }
  // Where it is, or would be.
  Place& place_of(const CodedValue& code, std::uint32_t vertex) {
    if (2 * interned_count_ >= places_.size()) grow();
    std::size_t at = hash_of(code, vertex) & (places_.size() - 1);
    while (places_[at].id != kNone &&
           (places_[at].vertex != vertex || codes_[places_[at].id] != code)) {
      at = (at + 1) & (places_.size() - 1);
    }
    return places_[at];
  }
  void grow() {
    std::vector<Place> before = std::exchange(places_, {});
    places_.resize(before.empty() ? 64 : 4 * before.size());
    for (const Place& place : before) {
      if (place.id == kNone) continue;
      std::size_t at = hash_of(codes_[place.id], place.vertex) & (places_.size() - 1);
      while (places_[at].id != kNone) at = (at + 1) & (places_.size() - 1);
      places_[at] = place;
    }
  }

  const LayerValues& values_;
  std::uint32_t dimension_;
  std::vector<CodedValue> codes_;
  std::vector<float> numbers_;
  std::vector<Place> places_;  // by hash, at most half of them taken
  std::size_t interned_count_ = 0;
};

}  // namespace crease::codec
