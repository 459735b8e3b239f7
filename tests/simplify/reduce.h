// A mesh simplified to a number of triangles, and how far that is from it.
#pragma once

#include "crease/compare.h"
#include "crease/simplify.h"
#include "support/random_contractions.h"

#include <algorithm>

namespace crease {

struct Reached {
  std::size_t triangles = 0;
  Comparison apart;
  Mesh mesh;
};

// The finest level with at most `target` triangles, beside the input.
inline Reached reduce(Mesh mesh, std::size_t target) {
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);
  const ContractionSequence sequence = *simplify(mesh, grid, {});
  // Triangles that each contraction takes away tell which prefix it is.
  std::size_t low = 0, high = sequence.contractions.size();
  const auto count_at = [&](std::size_t n) {
    const Level level = apply_contractions(mesh, sequence, n);
    return static_cast<std::size_t>(std::count(level.alive.begin(), level.alive.end(), true));
  };
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (count_at(middle) <= target) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  Reached reached;
  reached.mesh = mesh_of_level(mesh, sequence, apply_contractions(mesh, sequence, low));
  reached.triangles = reached.mesh.triangle_count();
  CompareOptions options;
  options.samples = 20'000;
  reached.apart = *compare_meshes(mesh, reached.mesh, options);
  return reached;
}

}  // namespace crease
