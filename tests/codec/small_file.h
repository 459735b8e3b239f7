// Files for the tests of the codec.
#pragma once

#include "crease/build.h"
#include "crease/file.h"
#include "support/random_contractions.h"

#include <vector>

namespace crease {

inline const std::vector<FileInfo::Band> kBands{{3, 40, 20, 0.25f}, {1, 5, 0, 1.5f}};

// Every kind of section, few bytes.
inline ProgressiveArraysPtr small_arrays(std::uint64_t seed = 4,
                                         Placement placement = Placement::Optimal) {
  Mesh mesh = random_complex(seed, 9, 14);
  const Grid grid = make_grid(mesh, {.bits = 8});
  snap(mesh, grid);
  return build_progressive_arrays(
      mesh, random_contractions(mesh, grid, {.seed = seed, .placement = placement}));
}

}  // namespace crease
