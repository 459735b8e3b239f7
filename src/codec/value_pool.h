// The values of one attribute layer and their ids. What is flat, a value that all corners of some
// triangle have, is one attribute wherever it is met, so that the triangle has one normal.
// Elsewhere equal values at different vertices are different attributes.
#pragma once

#include "codec/layer_values.h"
#include "crease/ids.h"
#include "crease/vec.h"

#include <bit>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace crease::codec {

class ValuePool {
 public:
  ValuePool(const LayerValues& values, std::uint32_t dimension)
      : values_(values), dimension_(dimension) {}

  // kFlat: of what is flat.
  static constexpr std::uint32_t kFlat = kNone;
  std::uint32_t intern(const CodedValue& code, std::uint32_t vertex) {
    const auto [at, is_new] = id_of_key_.try_emplace(Key{code, vertex}, size());
    if (is_new) add(code);
    return at->second;
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
    const auto [at, is_new] = id_of_key_.try_emplace(Key{bits, kFlat}, size());
    if (is_new) {
      codes_.push_back(bits);
      numbers_.insert(numbers_.end(), {d.x, d.y, d.z});
    }
    return at->second;
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
  struct Key {
    CodedValue code;
    std::uint32_t vertex;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = key.vertex;
      for (const std::int32_t c : key.code) {
        h = (h ^ static_cast<std::uint32_t>(c)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return static_cast<std::size_t>(h);
    }
  };

  const LayerValues& values_;
  std::uint32_t dimension_;
  std::vector<CodedValue> codes_;
  std::vector<float> numbers_;
  std::unordered_map<Key, std::uint32_t, Hash> id_of_key_;
};

}  // namespace crease::codec
