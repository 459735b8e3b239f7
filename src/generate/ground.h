// The land: streets, fields around, the river between its quays, as one closed body.
#pragma once

#include "generate/model_builder.h"
#include "generate/street_grid.h"

#include <functional>

namespace crease {

struct BlockRange {
  int low_x = 0, high_x = 0, low_y = 0, high_y = 0;  // inclusive
  bool empty = true;

  void add(int i, int j);
};

// Covers the blocks of the range and one more around. `coat_of` says what is on block i, j.
void add_ground(ModelBuilder& b, const StreetGrid& grid, const BlockRange& range,
                const std::function<Coat(int i, int j)>& coat_of);
// How many triangles that will have.
std::size_t ground_triangle_count(const BlockRange& range);

}  // namespace crease
