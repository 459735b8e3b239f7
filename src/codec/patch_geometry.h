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

// Where vertices stand, about the first one of the patch, so that little is lost in differences.
class PatchPlaces {
 public:
  explicit PatchPlaces(const PatchMesh& mesh) {
    if (!mesh.positions.empty()) origin_ = real(mesh.positions[0]);
    places_.reserve(mesh.positions.size());
    for (const Vec3i& p : mesh.positions) places_.push_back(from_origin(p));
  }

  Vec3d from_origin(const Vec3i& p) const { return real(p) - origin_; }
  const Vec3d& place(std::uint32_t v) const { return places_[v]; }
  void move(std::uint32_t v, const Vec3d& to) { places_[v] = to; }
  // As long as twice the triangle's area, along its normal.
  Vec3d twice_area(const Corners& t) const {
    return cross(place(t[1]) - place(t[0]), place(t[2]) - place(t[0]));
  }

 private:
  static Vec3d real(const Vec3i& p) { return {double(p.x), double(p.y), double(p.z)}; }

  Vec3d origin_;
  std::vector<Vec3d> places_;  // per vertex
};

class PatchGeometry : public PatchPlaces {
 public:
  explicit PatchGeometry(const PatchMesh& mesh) : PatchPlaces(mesh) {
    normals_.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < normals_.size(); ++t) find_normal(t, mesh.triangles[t]);
  }

  // As it was when it was last asked to be found.
  const ScaledNormal& normal(std::uint32_t t) const { return normals_[t]; }
  void find_normal(std::uint32_t t, const Corners& corners) {
    const Vec3d n = twice_area(corners);
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
  std::vector<ScaledNormal> normals_;  // per triangle
};

}  // namespace crease::codec
