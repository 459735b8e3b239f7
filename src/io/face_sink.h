// Faces into a RawMesh: triangles as they are, polygons cut, the face of each triangle remembered
// from the first polygon on.
//
//   FaceSink sink(raw);
//   sink.add_face(corners);                    // corners: stored vertices
//   for (auto [a, b, c] : sink.cut()) ...      // the ranks of the corners of each triangle added
#pragma once

#include "io/raw_mesh.h"
#include "io/triangulate_polygon.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace crease {

class FaceSink {
 public:
  explicit FaceSink(RawMesh& raw) : raw_(raw) {}

  // `corners` has at least three indices in range. Cuts and counts polygons.
  void add_face(std::span<const std::uint32_t> corners) {
    cut_.clear();
    if (corners.size() == 3) {
      cut_.push_back({0, 1, 2});
    } else {
      cut_polygon(corners);
    }
    for (const auto& [a, b, c] : cut_) {
      raw_.triangles.push_back({corners[a], corners[b], corners[c]});
      if (keeps_faces_) raw_.face_of_triangle.push_back(face_count_);
    }
    ++face_count_;
  }
  // Ranks into the corners given last.
  std::span<const std::array<std::uint32_t, 3>> cut() const { return cut_; }
  std::uint32_t face_count() const { return face_count_; }

  // Remembers faces from the start, for layers with values per face.
  void keep_faces() {
    if (keeps_faces_) return;
    keeps_faces_ = true;
    raw_.face_of_triangle.resize(raw_.triangles.size());  // all were triangles so far
    std::iota(raw_.face_of_triangle.begin(), raw_.face_of_triangle.end(), 0u);
  }
  // What to tell about polygons, for the end.
  void report() {
    if (fanned_ > 0) {
      raw_.report.notes.push_back(std::to_string(fanned_) +
                                  " polygons that cross themselves or have no area, cut as fans");
    }
  }

 private:
  void cut_polygon(std::span<const std::uint32_t> corners) {
    keep_faces();
    ++raw_.report.polygons;
    points_.clear();
    for (std::uint32_t v : corners) points_.push_back(raw_.positions[v]);
    PolygonTriangles triangles = triangulate_polygon(points_);
    cut_ = std::move(triangles.triangles);
    fanned_ += triangles.fanned;
    raw_.report.degenerate_triangles +=
        corners.size() - 2 - std::min(cut_.size(), corners.size() - 2);
  }

  RawMesh& raw_;
  std::vector<std::array<std::uint32_t, 3>> cut_;
  std::vector<Vec3d> points_;
  std::uint32_t face_count_ = 0;
  bool keeps_faces_ = false;
  std::size_t fanned_ = 0;
};

}  // namespace crease
