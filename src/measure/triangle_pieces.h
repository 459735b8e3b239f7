// Triangles in pieces, for searches that go by boxes: the box of a long thin triangle that lies
// askew has room for thousands of others, those of its pieces have not.
#pragma once

#include "crease/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace crease {

using TriangleCorners = std::array<Vec3d, 3>;

// Between two planes across the longest side, which `of` pieces divide equally.
struct TrianglePiece {
  std::uint32_t triangle = 0;
  std::uint16_t part = 0, of = 1;
};

// At most 256 of one, 16 a triangle on average, and of many triangles fewer: four million in all,
// or two each. Empty: each is one piece, as of all meshes whose triangles have some width.
std::vector<TrianglePiece> pieces_of(std::size_t triangle_count,
                                     const std::function<TriangleCorners(std::size_t)>& corners);

// Points whose box has all of the piece: at most five.
struct PieceOutline {
  std::array<Vec3d, 5> points;
  std::size_t count = 0;
};
PieceOutline outline_of(const TriangleCorners& corners, const TrianglePiece& piece);

}  // namespace crease
