// A mesh that is fine where the camera looks and coarse elsewhere: a cut through a MeshHierarchy
// that moves by splits and merges, vertex by vertex (G03).
//
//   AdaptiveMesh mesh(hierarchy);                  // starts at the coarsest cut
//   mesh.update({.camera = camera});               // every frame; camera.pixels: error on screen
//   for (Range r : mesh.changes().positions) upload(r);
//   draw(mesh.draw_list());
//
// A vertex is split if what it stands for is seen to be wrong: its surface or its lines, those of
// textures and shading among them, are off by more than camera.pixels on the screen, or its shading
// by more than `degrees`. Errors grow upwards, and those of surfaces are nearly bounds of levels
// (crease/contraction.h), so what is left unsplit is about that wrong at most; where neighbours
// stop at different levels it is up to three times as wrong, in few pixels. Pixels are those in the
// picture's middle, at the eye's distance: what is seen at an angle to where the camera looks is up
// to one over the cosine's square as wide, 1.3 at the upper edge of 60 degrees. No split needs
// another one: the mesh has no crack, whatever is split.
//
// Cost: that of the splits and merges done, of asking some 20 bytes per active vertex whether it is
// seen to be wrong, four at a time, where the camera has moved far enough to change the answer, and
// of comparing two numbers per four of them. A camera that has not moved costs nothing.
//
// Threads: one at a time calls a mesh; meshes on several threads may share a hierarchy.
#pragma once

#include "crease/camera.h"
#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"
#include "crease/shading.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <span>

namespace crease {

struct ViewParameters {
  Camera camera;       // camera.pixels: error of surfaces and lines allowed on the screen
  double degrees = 0;  // of shading allowed where it covers 16 pixels and more; 0: any
  // The most visible errors first, until so many triangles.
  std::size_t max_triangles = std::numeric_limits<std::size_t>::max();
  // Per update(), by the caller's clock in seconds; what is left is done by the next ones. Null:
  // all at once. The run time has no clock of its own.
  double max_seconds = std::numeric_limits<double>::infinity();
  double (*clock)(void* context) = nullptr;
  void* clock_context = nullptr;
  // A merge needs an error this much smaller than a split, so that no vertex flickers. Less than 1
  // is 1.
  double hysteresis = 1.25;
  bool coarse_outside = true;  // what is outside the view frustum need not be right
  // Nor what faces away: for closed surfaces, since others show their back.
  bool coarse_backfaces = false;
  double silhouette_weight = 1;  // errors count so much more where the surface turns away. >= 1
  // Before a vertex is split, so are the third vertices of the triangles that appear, if their
  // error is larger; and it is merged after them. So neighbourhoods are those the simplifier saw,
  // but on flat surfaces, where all errors are 0.
  bool consistent = false;

  bool operator==(const ViewParameters&) const = default;
};

struct UpdateReport {
  std::size_t splits = 0, merges = 0;
  std::size_t moving = 0;     // vertices that are on their way
  std::size_t evaluated = 0;  // vertices and pairs of which it was asked whether they are wrong
  // Else time ran out, or merges whose vertices are on their way have to make room first.
  bool complete = true;
};

class AdaptiveMesh {
 public:
  explicit AdaptiveMesh(std::shared_ptr<const MeshHierarchy> hierarchy);
  ~AdaptiveMesh();
  AdaptiveMesh(AdaptiveMesh&&) noexcept;

  // Geomorphs: how long a vertex is on its way from where its parent stood, and back before it is
  // merged. 0, the default: moves are seen at once. While report.moving says that some are on their
  // way, draw_list() and changes() show them there and merges wait, each for this long;
  // max_triangles may be exceeded meanwhile if it was lowered. What is out of view does not wait.
  void set_geomorph_seconds(double seconds);

  // `seconds`: that have passed since the last time, for geomorphs.
  UpdateReport update(const ViewParameters& view, double seconds = 0);

  // The same error everywhere: splits exactly the vertices with a larger surface or line error,
  // model units. Negative or no number: all, which restores the snapped input. Time O(active
  // vertices + moves).
  UpdateReport set_error(float error, double seconds = 0);

  // Splits independently of their neighbours leave flat surfaces folded over in places: triangles
  // that face away from the normals that they show, at no distance from the input. Splits at these
  // until none is left, or no more than `max_triangles` allow. For cuts that are exported, after
  // update(), of which the next one merges again what its view does not need. `faces_away`: per
  // triangle of the hierarchy, whether the input has it so; or empty: none. Returns how many folds
  // are left. Time O(active triangles) for each split that one of them takes, few on the whole.
  std::size_t unfold(std::size_t max_triangles, std::span<const char> faces_away = {});

  std::size_t triangle_count() const;
  std::size_t vertex_count() const;  // active ones that triangles of the input use
  // Largest error of the active vertices: what is on show differs by at most this from the input.
  LevelError error() const;  // time O(active vertices)

  // `positions` and `vertex_normals` may have elements in between that no triangle uses.
  DrawList draw_list() const;
  const DrawChanges& changes() const;  // of the last update() or set_error()
  // To which of the model's parts (hierarchy().parts) a triangle of that kind in draw_list()
  // belongs; the first where it has none.
  PartId part_of(TriangleKind kind, std::size_t triangle) const;

  // Per position of the draw list its surface or line error, whichever is larger: for pictures.
  std::vector<float> error_of_position() const;
  // And how coarse it is: 0 where the input's vertices stand, 1 where as many of them are one as in
  // the coarsest cut on average, even steps for even factors. Time O(splits of the hierarchy).
  std::vector<float> level_of_position() const;

  // What is active as a mesh of its own, all attribute layers, materials and parts; triangles in
  // the hierarchy's order. Time O(active).
  Mesh extract() const;

  const MeshHierarchy& hierarchy() const;
  // Of the cut and of the arrays for drawing, without the hierarchy (hierarchy_bytes()).
  std::size_t active_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crease
