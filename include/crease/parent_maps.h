// Relative indices of attributes, and how they change from children to parents (G03 3.6).
//
//   ParentMaps::Map parents = layer.parents_of_split.of(index_of(s));
//   RelativeAttribute above = parents[a];                       // kRemoved: no cut needs it there
#pragma once

#include "crease/compact_ranges.h"
#include "crease/packed_indices.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace crease {

// An attribute among those of its node and layer.
using RelativeAttribute = std::uint16_t;
inline constexpr RelativeAttribute kRemoved = 0xffff;  // as a parent: R of G03 3.5.2

// A list per split, most of them empty; kRemoved takes no bits of its own.
class ParentMaps {
 public:
  class Map {
   public:
    RelativeAttribute operator[](std::size_t i) const {  // 0 stands for kRemoved
      return static_cast<RelativeAttribute>((*packed_)[first_ + i] - 1);
    }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    Map subspan(std::size_t first, std::size_t size) const {
      return Map(packed_, first_ + first, size);
    }

   private:
    friend class ParentMaps;
    Map(const PackedIndices<>* packed, std::size_t first, std::size_t size)
        : packed_(packed), first_(first), size_(size) {}
    const PackedIndices<>* packed_;
    std::size_t first_, size_;
  };

  ParentMaps() = default;
  // No node has more attributes than said.
  explicit ParentMaps(std::uint32_t most_attributes) : parents_(bits_for(most_attributes + 1)) {}

  void push_back(std::span<const RelativeAttribute> parents) {
    ranges_.push_back(static_cast<std::uint32_t>(parents.size()));
    for (RelativeAttribute p : parents) {
      parents_.push_back(static_cast<RelativeAttribute>(p + 1));
    }
    map_count_ += parents.empty() ? 0 : 1;
  }
  Map of(std::size_t split) const {
    const std::uint32_t count = ranges_.count(split);
    return Map(&parents_, count == 0 ? 0 : ranges_.begin(split), count);
  }
  std::size_t size() const { return ranges_.size(); }
  std::size_t list_count() const { return map_count_; }
  std::size_t bytes() const { return ranges_.bytes() + parents_.bytes(); }

 private:
  CompactRanges ranges_{0};
  PackedIndices<> parents_;
  std::size_t map_count_ = 0;
};

}  // namespace crease
