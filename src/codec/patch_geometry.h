// Where the vertices of a block stand and how its triangles lie, while its splits are undone.
#pragma once

#include "codec/patch_mesh.h"
#include "crease/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// Of a triangle: its normal, or zero, and twice its area.
struct ScaledNormal {
  Vec3d unit;
  double size = 0;
};

// Places are about the first vertex of the patch, so that little is lost in differences.
class PatchGeometry {
 public:
  explicit PatchGeometry(const PatchMesh& mesh) {
    if (!mesh.positions.empty()) origin_ = real(mesh.positions[0]);
    places_.reserve(mesh.positions.size());
    for (const Vec3i& p : mesh.positions) places_.push_back(from_origin(p));
    normals_.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < normals_.size(); ++t) find_normal(t, mesh.triangles[t]);
  }

  Vec3d from_origin(const Vec3i& p) const { return real(p) - origin_; }
  const Vec3d& place(std::uint32_t v) const { return places_[v]; }
  void move(std::uint32_t v, const Vec3d& to) { places_[v] = to; }
  // As it was when it was last asked to be found.
  const ScaledNormal& normal(std::uint32_t t) const { return normals_[t]; }
  void find_normal(std::uint32_t t, const Corners& corners) {
    const Vec3d& p = place(corners[0]);
    const Vec3d n = cross(place(corners[1]) - p, place(corners[2]) - p);
    const double size = length(n);
    normals_[t] = {size > 0 ? n * (1 / size) : Vec3d{}, size};
  }
  double longest_side2(const Corners& t) const {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d side = place(t[(c + 1) % 3]) - place(t[c]);
      longest = std::max(longest, dot(side, side));
    }
    return longest;
  }
  // The lengths of these triangles' sides.
  double edge_sum(std::span<const Corners> triangles) const {
    double sum = 0;
    for (const Corners& t : triangles) {
      for (std::size_t c = 0; c < 3; ++c) sum += length(place(t[(c + 1) % 3]) - place(t[c]));
    }
    return sum;
  }

 private:
  static Vec3d real(const Vec3i& p) { return {double(p.x), double(p.y), double(p.z)}; }

  Vec3d origin_;
  std::vector<Vec3d> places_;          // per vertex
  std::vector<ScaledNormal> normals_;  // per triangle
};

}  // namespace crease::codec
