// Ground that no level is flat on.
#pragma once

#include "support/hashed.h"
#include "support/mesh_builder.h"

#include <cstdint>

namespace crease {

// 4 x 4 quads in each of side x side unit squares from the origin on, of heights from `low` to 0.1
// above it.
inline void add_rough_ground(MeshBuilder& builder, int side, double low) {
  constexpr int kCells = 4;
  const auto ground = [&](int x, int y) {
    const double height = low + 0.1 * hashed(std::uint32_t(1000 * y + x));
    return builder.at({double(x) / kCells, double(y) / kCells, height});
  };
  for (int y = 0; y < kCells * side; ++y) {
    for (int x = 0; x < kCells * side; ++x) {
      const VertexId v[] = {ground(x, y), ground(x + 1, y), ground(x + 1, y + 1), ground(x, y + 1)};
      builder.flat_triangle({v[0], v[1], v[2]});
      builder.flat_triangle({v[0], v[2], v[3]});
    }
  }
}

}  // namespace crease
