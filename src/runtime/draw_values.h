// The floats that a renderer sees, from grid positions and attribute values.
#pragma once

#include "crease/mesh.h"
#include "crease/vec.h"
#include "mesh/drawn_texcoords.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Relative to the grid's origin.
inline Vec3f draw_position(const Grid& grid, const Vec3i& g) {
  return {static_cast<float>(grid.step * g.x), static_cast<float>(grid.step * g.y),
          static_cast<float>(grid.step * g.z)};
}

// A colour of 1 to 4 components: grey, grey and alpha, RGB, RGBA.
inline std::array<float, 4> draw_color(std::span<const float> value) {
  switch (value.size()) {
    case 1:
      return {value[0], value[0], value[0], 1};
    case 2:
      return {value[0], value[0], value[0], value[1]};
    case 3:
      return {value[0], value[1], value[2], 1};
    default:
      return {value[0], value[1], value[2], value[3]};
  }
}

// Part `count` triangles from `first` on; an empty array stays empty.
template <typename T>
std::span<const T> triangles_of(const std::vector<T>& all, std::size_t first, std::size_t count,
                                std::size_t per_triangle) {
  if (all.empty()) return {};
  return std::span<const T>(all).subspan(per_triangle * first, per_triangle * count);
}

}  // namespace crease
