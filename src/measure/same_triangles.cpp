#include "measure/same_triangles.h"

#include "parallel/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace crease {

namespace {

constexpr std::size_t kGrain = 1024;

// In an order that does not depend on which corner is the first.
std::array<Vec3d, 3> corners_in_order(const Mesh& mesh, std::size_t triangle) {
  std::array<Vec3d, 3> corner;
  for (std::size_t c = 0; c < 3; ++c) {
    corner[c] = mesh.positions[index_of(mesh.triangles[triangle][c])];
  }
  std::sort(corner.begin(), corner.end(), [](const Vec3d& a, const Vec3d& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return corner;
}

std::uint64_t hash_of(const std::array<Vec3d, 3>& corner) {
  std::uint64_t hash = 0;
  for (const Vec3d& p : corner) {
    for (int i = 0; i < 3; ++i) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[i] + 0.0)) * 0x9e3779b97f4a7c15u;  // -0 is 0
      hash ^= hash >> 29;
    }
  }
  return hash;
}

}  // namespace

SameTriangles::SameTriangles(const Mesh& mesh) : mesh_(mesh), by_hash_(mesh.triangle_count()) {
  parallel_ranges(by_hash_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      by_hash_[t] = {hash_of(corners_in_order(mesh, t)), std::uint32_t(t)};
    }
  });
  parallel_sort(by_hash_, [](const Entry& a, const Entry& b) { return a.hash < b.hash; });
}

bool SameTriangles::has(const Mesh& other, std::size_t triangle) const {
  const std::array<Vec3d, 3> corner = corners_in_order(other, triangle);
  const std::uint64_t hash = hash_of(corner);
  auto found = std::lower_bound(by_hash_.begin(), by_hash_.end(), hash,
                                [](const Entry& e, std::uint64_t h) { return e.hash < h; });
  for (; found != by_hash_.end() && found->hash == hash; ++found) {
    if (corners_in_order(mesh_, found->triangle) == corner) return true;
  }
  return false;
}

}  // namespace crease
