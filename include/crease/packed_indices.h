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

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace crease {

// Bits for numbers below `limit`.
constexpr unsigned bits_for(std::size_t limit) {
  return limit <= 1 ? 0 : static_cast<unsigned>(std::bit_width(limit - 1));
}

// Bits one after the other.
class BitArray {
 public:
  void reserve(std::size_t bits) { words_.reserve(bits / 64 + 2); }
  // `value` must have no more bits than said, at most 32.
  void append(std::uint32_t value, unsigned bits) {
    words_.resize((size_ + bits) / 64 + 2);  // reads look one word further
    words_[size_ / 64] |= std::uint64_t(value) << (size_ % 64);
    if (size_ % 64 != 0) words_[size_ / 64 + 1] |= std::uint64_t(value) >> (64 - size_ % 64);
    size_ += bits;
  }
  std::uint32_t read(std::size_t bit, unsigned bits) const {
    const std::uint64_t mask = (std::uint64_t(1) << bits) - 1;
    if constexpr (std::endian::native == std::endian::little) {
      return static_cast<std::uint32_t>(read_57(bit) & mask);
    }
    const std::uint64_t low = words_[bit / 64] >> (bit % 64);
    const std::uint64_t high = words_[bit / 64 + 1] << 1 << (63 - bit % 64);
    return static_cast<std::uint32_t>((low | high) & mask);
  }
  // At least so many bits from there on, where bytes of words lie in the order of bits: one load,
  // wherever it begins. What is beyond the end is of no meaning.
  std::uint64_t read_57(std::size_t bit) const {
    std::uint64_t word;
    std::memcpy(&word, reinterpret_cast<const char*>(words_.data()) + bit / 8, sizeof(word));
    return word >> (bit % 8);
  }
  // The 64 bits from there on; what is beyond the end is of no meaning.
  std::uint64_t read_word(std::size_t bit) const {
    return words_[bit / 64] >> (bit % 64) | words_[bit / 64 + 1] << 1 << (63 - bit % 64);
  }
  bool test(std::size_t bit) const { return (words_[bit / 64] >> (bit % 64) & 1) != 0; }
  void prefetch(std::size_t bit) const { __builtin_prefetch(&words_[bit / 64]); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return 8 * words_.size(); }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_ = 0;
};

template <typename Index = std::uint32_t>
class PackedIndices {
 public:
  PackedIndices() = default;
  explicit PackedIndices(unsigned bits) : bits_(bits) {}  // at most 32

  void reserve(std::size_t size) { packed_.reserve(size * bits_); }
  void push_back(Index index) {
    packed_.append(static_cast<std::uint32_t>(index), bits_);
    ++size_;
  }
  Index operator[](std::size_t i) const {
    return static_cast<Index>(packed_.read(i * bits_, bits_));
  }
  // Those from i on. Three of up to 21 bits each are one look-up.
  std::array<Index, 3> three_from(std::size_t i) const {
    if (3 * bits_ > 64) return {(*this)[i], (*this)[i + 1], (*this)[i + 2]};
    const bool is_one_load = std::endian::native == std::endian::little && 3 * bits_ <= 57;
    const std::uint64_t word =
        is_one_load ? packed_.read_57(i * bits_) : packed_.read_word(i * bits_);
    const std::uint64_t mask = (std::uint64_t(1) << bits_) - 1;
    const auto field = [&](unsigned k) {
      return static_cast<Index>(static_cast<std::uint32_t>(word >> (k * bits_) & mask));
    };
    return {field(0), field(1), field(2)};
  }
  void prefetch(std::size_t i) const { packed_.prefetch(i * bits_); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  unsigned bits() const { return bits_; }
  std::size_t bytes() const { return packed_.bytes(); }

 private:
  BitArray packed_;
  std::size_t size_ = 0;
  unsigned bits_ = 0;
};

}  // namespace crease
