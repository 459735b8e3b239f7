// The values of a layer of an attribute hierarchy: numbers, or, where all of them are directions of
// one octahedral lattice, four bytes each. Nothing is rounded: what is read is the same either way.
//
//   StoredValues values(std::move(numbers), 3);
//   values.pack_directions();              // 12 bytes a value to 4, if they are of a lattice
//   Vec3f n = values.direction(i);         // or, of any dimension:
//   StoredValue same = values[i];
//
// Normals that a build rounded (its default) are of a lattice, and so are those of every file that
// it wrote.
#pragma once

#include "crease/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease {

// A copy of one value.
struct StoredValue {
  std::array<float, 4> numbers{};
  std::uint32_t dimension = 0;

  std::size_t size() const { return dimension; }
  const float* begin() const { return numbers.data(); }
  const float* end() const { return numbers.data() + dimension; }
  float operator[](std::size_t i) const { return numbers[i]; }
  operator std::span<const float>() const& { return {numbers.data(), dimension}; }
  operator std::span<const float>() const&& = delete;  // it would be gone
};

class StoredValues {
 public:
  StoredValues() = default;
  // `dimension` numbers a value, 1 to 4.
  StoredValues(std::vector<float> numbers, std::uint32_t dimension)
      : numbers_(std::move(numbers)), dimension_(dimension) {}

  std::size_t size() const { return !is_packed() ? numbers_.size() / dimension_ : codes_.size(); }
  std::uint32_t dimension() const { return dimension_; }
  std::size_t bytes_per_value() const { return is_packed() ? 4 : 4 * std::size_t(dimension_); }
  std::size_t bytes() const { return bytes_per_value() * size(); }
  bool is_finite() const;

  StoredValue operator[](std::size_t i) const;
  Vec3f direction(std::size_t i) const;  // dimension() 3
  // The same of several.
  void directions(std::span<const std::uint32_t> which, std::span<Vec3f> found) const;
  // Those values, in this order.
  StoredValues chosen(std::span<const std::uint32_t> which) const;

  // Keeps values of three numbers as codes if each is exactly a direction, or zero, of one lattice
  // of 8 to 16 bits a component; otherwise nothing changes. Time O(size), and little where they are
  // of none.
  void pack_directions();

 private:
  bool is_packed() const { return max_component_ != 0; }

  std::vector<float> numbers_;        // dimension_ a value; or empty:
  std::vector<std::uint32_t> codes_;  // the second component above the first
  std::uint32_t dimension_ = 1;
  std::uint32_t max_component_ = 0;  // of a code; 0: numbers
};

}  // namespace crease
