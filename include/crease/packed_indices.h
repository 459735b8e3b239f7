// Numbers of as many bits as the largest one needs.
//
//   PackedIndices<WedgeId> wedges(bits_for(wedge_count));
//   wedges.push_back(w);
//   wedges[i]
//
// A read is two loads and three shifts. Arrays of a block, or of a small model, get narrow by
// themselves: 50,000 wedges take 16 bits each, a million 20.
#pragma once

#include "crease/ids.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace crease {

// Bits for numbers below `limit`.
constexpr unsigned bits_for(std::size_t limit) {
  return limit <= 1 ? 0 : static_cast<unsigned>(std::bit_width(limit - 1));
}

template <typename Index = std::uint32_t>
class PackedIndices {
 public:
  PackedIndices() = default;
  explicit PackedIndices(unsigned bits) : bits_(bits) {}  // at most 32

  // `index` must have no more bits than said.
  void push_back(Index index) {
    const std::size_t bit = size_ * bits_;
    words_.resize((bit + bits_) / 64 + 2);  // reads look one word further
    const auto value = static_cast<std::uint64_t>(static_cast<std::uint32_t>(index));
    words_[bit / 64] |= value << (bit % 64);
    if (bit % 64 != 0) words_[bit / 64 + 1] |= value >> (64 - bit % 64);
    ++size_;
  }
  Index operator[](std::size_t i) const {
    const std::size_t bit = i * bits_;
    const std::uint64_t low = words_[bit / 64] >> (bit % 64);
    const std::uint64_t high = words_[bit / 64 + 1] << 1 << (63 - bit % 64);
    return static_cast<Index>((low | high) & ((std::uint64_t(1) << bits_) - 1));
  }
  Index back() const { return (*this)[size_ - 1]; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  unsigned bits() const { return bits_; }
  std::size_t bytes() const { return 8 * words_.size(); }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_ = 0;
  unsigned bits_ = 0;
};

}  // namespace crease
