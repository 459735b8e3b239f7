// Equal values found and numbered: what turns stored vertices and values into an index structure.
//
//   const Weld weld = weld_positions(positions);
//   for (std::uint32_t& v : corner) v = weld.new_of_old[v];
//   keep_rows(positions, weld.first_old);
//
// Two values are equal iff all components have equal bits, after -0 became +0. New indices follow
// the order of first appearance, so the result depends on the input alone. A flat hash table: time
// O(n), memory 16 to 24 bytes a value.
#pragma once

#include "crease/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct Weld {
  std::vector<std::uint32_t> new_of_old;  // old_count values
  std::vector<std::uint32_t> first_old;   // new_count values: where each was seen first, ascending

  bool changes_nothing() const { return new_of_old.size() == first_old.size(); }
};

Weld weld_positions(std::span<const Vec3d> positions);
Weld weld_values(std::span<const float> values, std::uint32_t dimension);

// rows[i] becomes the old rows[kept[i]]; `kept` ascends.
template <typename T>
void keep_rows(std::vector<T>& rows, std::span<const std::uint32_t> kept, std::size_t width = 1) {
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) rows[i * width + k] = rows[kept[i] * width + k];
  }
  rows.resize(kept.size() * width);
}

}  // namespace crease
