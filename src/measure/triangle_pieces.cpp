#include "measure/triangle_pieces.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// The box over the triangle's own area, each as its three shadows, from which on it is cut; the
// pieces' boxes together are to be this many times its area.
constexpr double kAskew = 64, kWanted = 4;

constexpr double kMostPieces = 256, kMeanPieces = 16;

// Beyond as many pieces in all, which take 130 bytes each, no more than two a triangle.
constexpr double kMany = 4e6;

double sum_of_shadows(const Vec3d& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

std::uint16_t piece_count(const TriangleCorners& c) {
  Vec3d low = c[0], high = c[0];
  for (const Vec3d& p : c) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const Vec3d size = high - low;
  const double of_box = size.x * size.y + size.y * size.z + size.z * size.x;
  const double of_triangle = sum_of_shadows(cross(c[1] - c[0], c[2] - c[0])) / 2;
  if (!(of_box > kAskew * of_triangle)) return 1;
  // Each of n pieces has a box n^2 times smaller.
  const double wanted = of_box / std::max(kWanted * of_triangle, 1e-300);
  return static_cast<std::uint16_t>(std::clamp(std::ceil(wanted), 1.0, kMostPieces));
}

}  // namespace

std::vector<TrianglePiece> pieces_of(std::size_t triangle_count,
                                     const std::function<TriangleCorners(std::size_t)>& corners) {
  std::vector<std::uint16_t> counts(triangle_count);
  double sum = 0;
  for (std::size_t t = 0; t < triangle_count; ++t) sum += counts[t] = piece_count(corners(t));
  std::vector<TrianglePiece> pieces;
  if (sum == double(triangle_count)) return pieces;
  const double n = double(triangle_count);
  const double share = std::min(1.0, std::max(2 * n, std::min(kMeanPieces * n, kMany)) / sum);
  for (std::size_t t = 0; t < triangle_count; ++t) {
    const auto count = static_cast<std::uint16_t>(std::max(1.0, std::floor(share * counts[t])));
    for (std::uint16_t part = 0; part < count; ++part) {
      pieces.push_back({static_cast<std::uint32_t>(t), part, count});
    }
  }
  return pieces;
}

PieceOutline outline_of(const TriangleCorners& corners, const TrianglePiece& piece) {
  PieceOutline outline;
  const auto add = [&outline](const Vec3d& p) { outline.points[outline.count++] = p; };
  if (piece.of <= 1) {
    for (const Vec3d& p : corners) add(p);
    return outline;
  }
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d side = corners[(k + 1) % 3] - corners[k];
    if (dot(side, side) > most) {
      most = dot(side, side);
      longest = k;
    }
  }
  const Vec3d& a = corners[longest];
  const Vec3d& b = corners[(longest + 1) % 3];
  const Vec3d& apex = corners[(longest + 2) % 3];
  const double top = most > 0 ? std::clamp(dot(apex - a, b - a) / most, 0.0, 1.0) : 0;
  const double from = double(piece.part) / piece.of, to = double(piece.part + 1) / piece.of;
  // On the other two sides, above the point of the longest one at that share of it.
  const auto above = [&](double share) {
    if (share <= top) return top > 0 ? a + (apex - a) * (share / top) : apex;
    return b + (apex - b) * ((1 - share) / (1 - top));
  };
  for (const double share : {from, to}) {
    add(a + (b - a) * share);
    add(above(share));
  }
  if (from <= top && top <= to) add(apex);
  return outline;
}

}  // namespace crease
