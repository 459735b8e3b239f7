// Relative indices of attributes, and how they change from children to parents (G03 3.6).
//
//   ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
//   RelativeAttribute above = parents[a];                       // kRemoved: no cut needs it there
#pragma once

#include "crease/compact_ranges.h"
#include "crease/packed_indices.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease {

// An attribute among those of its node and layer.
using RelativeAttribute = std::uint16_t;
inline constexpr RelativeAttribute kRemoved = 0xffff;  // as a parent: R of G03 3.5.2

// A list per split, most of them empty. Each has as many bits an attribute as its largest parent
// needs, so that a node with hundreds of attributes makes no other one's map wider.
class ParentMaps {
 public:
  class Map {
   public:
    RelativeAttribute operator[](std::size_t i) const {  // 0 stands for kRemoved
      return static_cast<RelativeAttribute>(bits_->read(first_ + i * width_, width_) - 1);
    }
    std::size_t size() const { return bit_count_ / width_; }
    bool empty() const { return bit_count_ == 0; }
    Map subspan(std::size_t first, std::size_t size) const {
      Map map = *this;
      map.first_ += first * width_;
      map.bit_count_ = static_cast<std::uint32_t>(size) * width_;
      return map;
    }

   private:
    friend class ParentMaps;
    const BitArray* bits_ = nullptr;
    std::size_t first_ = 0;
    std::uint32_t bit_count_ = 0;  // 32 bits: whoever asks for the size divides
    unsigned width_ = 1;
  };

  void push_back(std::span<const RelativeAttribute> parents) {
    if (parents.empty()) return bit_ranges_.push_back(0);
    ++map_count_;
    RelativeAttribute largest = 0;
    for (RelativeAttribute p : parents) largest = std::max(largest, plus_one(p));
    const unsigned width = std::max(1u, bits_for(std::size_t(largest) + 1));
    bits_.append(width - 1, kWidthBits);
    for (RelativeAttribute p : parents) bits_.append(plus_one(p), width);
    bit_ranges_.push_back(static_cast<std::uint32_t>(kWidthBits + width * parents.size()));
  }
  Map of(std::size_t split) const {
    Map map;
    if (is_empty(split)) return map;
    const CompactRanges::Range range = bit_ranges_.range(split);
    const std::size_t first = range.begin, bits = range.end - range.begin;
    map.bits_ = &bits_;
    map.first_ = first + kWidthBits;
    map.width_ = bits_.read(first, kWidthBits) + 1;
    map.bit_count_ = static_cast<std::uint32_t>(bits - kWidthBits);
    return map;
  }
  bool is_empty(std::size_t split) const { return bit_ranges_.is_usual(split); }
  std::size_t size() const { return bit_ranges_.size(); }
  std::size_t list_count() const { return map_count_; }
  std::size_t bytes() const { return bit_ranges_.bytes() + bits_.bytes(); }

 private:
  static constexpr unsigned kWidthBits = 4;
  static RelativeAttribute plus_one(RelativeAttribute p) {
    return static_cast<RelativeAttribute>(p + 1);
  }

  CompactRanges bit_ranges_{0};  // at most 2^32 bits in all
  BitArray bits_;
  std::size_t map_count_ = 0;
};

}  // namespace crease
