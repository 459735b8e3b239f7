// Moves a linear mesh to another level within a time a frame, so that a window stays live: from the
// base to the full level a model of a million triangles takes most of a second.
//
//   LevelWalk walk;
//   every frame: is_there = walk.go(mesh, {error, max_triangles}, 0.012, [&] {
//   upload(mesh.changes()); });
#pragma once

#include "crease/progressive_mesh.h"

#include <cstddef>
#include <functional>
#include <limits>

namespace crease {

struct LevelGoal {
  float error = 0;                // surface and line, model units; negative: all of it
  std::size_t max_triangles = 0;  // the finest level with so many, if that is coarser

  bool operator==(const LevelGoal&) const = default;
};

class LevelWalk {
 public:
  static constexpr std::size_t kStep = 8192;  // contractions: some milliseconds

  // True when the mesh is where it shall be. Goes on for `seconds`, one step at least, or until a
  // geomorph has begun: a coarser level is reached when that is over, and asked for again.
  // `after_step` is called after each change of the mesh.
  bool go(ProgressiveMesh& mesh, const LevelGoal& goal, double seconds,
          const std::function<void()>& after_step);

 private:
  bool step(ProgressiveMesh& mesh, const LevelGoal& goal, const std::function<void()>& after_step);

  LevelGoal goal_{std::numeric_limits<float>::quiet_NaN(), 0};
  bool is_there_ = false;
  bool is_limited_ = false;  // by the goal's triangles: no finer level has so few
};

}  // namespace crease
