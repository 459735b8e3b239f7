// A trunk of short pieces amid wide hills: all else is larger than they are.
#pragma once

#include "crease/mesh.h"
#include "support/mesh_builder.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>

namespace crease {

inline constexpr std::size_t kPieces = 15;
inline constexpr double kPieceHeight = 0.2;

// A trunk of short pieces, each with faces of its own, amid wide hills.
inline Mesh trunk_amid_hills() {
  constexpr int kSides = 8;
  MeshBuilder b;
  constexpr int kAcross = 64;
  constexpr double kWide = 80;
  const auto height = [](double x, double y) {
    return std::sin(x * 20 / kWide) * std::cos(y * 17 / kWide) - 2;
  };
  const auto vertex = [&](int i, int j) {
    const double x = (double(i) / kAcross - 0.5) * kWide, y = (double(j) / kAcross - 0.5) * kWide;
    return b.at({x, y, height(x, y)});
  };
  const auto normal = [&](VertexId v) {
    const Vec3d p = b.position(v);
    return b.normal_at(
        {-(height(p.x + 0.01, p.y) - p.z) / 0.01, -(height(p.x, p.y + 0.01) - p.z) / 0.01, 1});
  };
  for (int j = 0; j < kAcross; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      const VertexId v[4] = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1),
                             vertex(i, j + 1)};
      b.quad({v[0], v[1], v[2], v[3]}, {normal(v[0]), normal(v[1]), normal(v[2]), normal(v[3])});
    }
  }
  for (int k = 0; k < int(kPieces); ++k) {
    VertexId ring[2][kSides];
    for (int end = 0; end < 2; ++end) {
      const double radius = end == 0 ? 0.13 : 0.16;
      for (int i = 0; i < kSides; ++i) {
        const double angle = i * 2 * std::numbers::pi / kSides;
        ring[end][i] = b.vertex(
            {radius * std::cos(angle), radius * std::sin(angle), kPieceHeight * (k + 0.95 * end)});
      }
    }
    for (int i = 0; i < kSides; ++i) {
      const int next = (i + 1) % kSides;
      b.flat_triangle({ring[0][i], ring[0][next], ring[1][next]});
      b.flat_triangle({ring[0][i], ring[1][next], ring[1][i]});
      if (i == 0 || next == 0) continue;
      b.flat_triangle({ring[0][0], ring[0][next], ring[0][i]});
      b.flat_triangle({ring[1][0], ring[1][i], ring[1][next]});
    }
  }
  return b.take();
}

// Of which a level has anything.
inline std::size_t count_pieces(const Mesh& level) {
  std::set<int> pieces;
  for (const Triangle& t : level.triangles) {
    const Vec3d p = level.positions[index_of(t[0])];
    if (p.z > -0.01) pieces.insert(int(p.z / kPieceHeight + 0.01));
  }
  return pieces.size();
}

}  // namespace crease
