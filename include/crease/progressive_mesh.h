// The linear progressive mesh of DB03: arrays partitioned by shading kind, ordered by the
// contraction sequence, so that a level is a prefix of every section.
//
//   ProgressiveMesh pm(arrays);      // from build_progressive_arrays() or a file
//   pm.set_triangle_count(50'000);   // O(change), forwards and backwards
//   for (Range r : pm.changes().positions) upload(r);
//   draw(pm.draw_list());
//
// Threads: one at a time calls a mesh; meshes on several threads may share their arrays.
#pragma once

#include "crease/contraction.h"
#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "crease/mesh.h"
#include "crease/progressive_arrays.h"
#include "crease/shading.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

class ProgressiveMesh {
 public:
  explicit ProgressiveMesh(ProgressiveArraysPtr arrays);  // starts at full resolution
  ~ProgressiveMesh();
  ProgressiveMesh(ProgressiveMesh&&) noexcept;

  std::size_t contraction_count() const;
  std::size_t applied() const;  // contractions in force, 0 = full resolution
  // The move itself. Time O(corners that change). count <= contraction_count().
  void set_applied(std::size_t count);

  // The finest level with at most `count` triangles (the coarsest one if there is none).
  void set_triangle_count(std::size_t count);
  // The coarsest level whose surface error is at most `surface_error`, model units. Negative or no
  // number: full resolution.
  void set_error(float surface_error);
  // How many contractions that level has in force. Negative: 0.
  std::size_t applied_for_error(float surface_error) const;
  // The same of surface and line errors, as views count them.
  std::size_t applied_for_view(float error) const;

  // Geomorphs: how long a vertex is on its way from where the one stood that it comes out of, and
  // back before it is contracted. 0, the default: levels are seen at once. While something is on
  // its way draw_list() shows it there; a coarser level waits for its contractions, all of them go
  // at once, and applied() and triangle_count() are still those of the finer one. A switch then
  // goes through the levels in between, there and back (docs/geomorphs.md): it takes about ten
  // times as long, so that far jumps of large models are better made without.
  void set_geomorph_seconds(double seconds);
  // So much time goes by; changes() has what moved. Time O(what is on its way).
  void advance(double seconds);
  bool is_moving() const;

  std::size_t triangle_count() const;
  std::size_t wanted_triangle_count() const;  // once nothing is on its way
  std::size_t vertex_count() const;           // active
  std::size_t full_triangle_count() const;
  std::size_t base_triangle_count() const;
  LevelError error() const;  // the largest of each along the prefix in force

  DrawList draw_list() const;
  const DrawChanges& changes() const;  // of the last set_ call, or advance()
  // To which of the model's parts (arrays().parts) a triangle of that kind in draw_list() belongs;
  // the first where it has none.
  PartId part_of(TriangleKind kind, std::size_t triangle) const;

  // The level as a mesh of its own, all attribute layers, materials and parts; vertices and
  // attribute values that are used only. Time O(mesh).
  Mesh extract() const;

  const ProgressiveArrays& arrays() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crease
