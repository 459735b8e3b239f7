// The draw list of a cut: positions, normals, colours and texture coordinates of what is active,
// kept while it moves.
//
// The moves mark what they touch (ActiveCut). arrive() then sorts the touched triangles into the
// three parts by what their corners have now, closes the holes, computes each changed float once,
// and tells the ranges. What is on its way (Geomorphs) is shown where it is. Time O(what changed),
// however many moves led there.
#pragma once

#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "runtime/active_cut.h"
#include "runtime/geomorphs.h"

#include <vector>

namespace crease {

class CutDrawing {
 public:
  void arrive(ActiveCut& cut, const Geomorphs& geomorphs);
  DrawList draw_list(const ActiveCut& cut) const;
  const DrawChanges& changes() const { return changes_; }
  std::size_t bytes() const { return 12 * (positions_.capacity() + vertex_normals_.capacity()); }

 private:
  void take(ChangeSet& marked, std::size_t active);
  void decode_values(const ActiveCut& cut, std::size_t count);
  void sort_touched(ActiveCut& cut, const Geomorphs& geomorphs);
  void refresh_vertices(ActiveCut& cut, const Geomorphs& geomorphs);
  void refresh_part(ActiveCut& cut, const Geomorphs& geomorphs, Part p);
  template <std::size_t kPerTriangle>
  void refresh_normals(const ActiveCut& cut, const Geomorphs& geomorphs, ActiveTriangles& part);
  void show_normals(const ActiveCut& cut, const Geomorphs& geomorphs, const ActiveTriangles& part,
                    std::uint32_t triangle, std::span<Vec3f> shown) const;

  std::vector<Vec3f> positions_, vertex_normals_;
  DrawChanges changes_;
  // Scratch.
  std::vector<std::uint32_t> taken_, values_;
  std::vector<Vec3f> decoded_;
  std::vector<Range> ranges_;
};

// That of the corners as they are; the zero vector for a triangle without area.
Vec3f geometric_normal_of(const ActiveCut& cut, const ActiveTriangles& part,
                          std::uint32_t triangle);

}  // namespace crease
