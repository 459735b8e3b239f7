// Mesh -> contractions: quadric pair contraction in error bands and patches.
//
//   ContractionSequence sequence = *simplify(snapped, grid, {});
//
// Goes all the way down; any prefix of the result is a level of detail.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"

#include <cstdint>
#include <vector>

namespace crease {

struct SimplifyOptions {
  Placement placement = Placement::Optimal;
  std::uint32_t patch_triangles = 10'000;  // at least 1; hundreds make sense
  int threads = 0;                         // 0: all. The result does not depend on it
  // How much a wrong normal costs beside a wrong distance: a normal that is off by one radian over
  // an area costs as much as a distance of normal_weight mean edge lengths there; less the coarser
  // the level, a quarter of it where 1 of 1,000 triangles is left, and less, to the half, the more
  // uneven the triangles are. 0 and more.
  double normal_weight = 1.1;
  // The input's vertices are followed: LevelError::surface is nearly a bound, thin parts stay long.
  // Else it is an estimate, often several times too small, and it takes a third of the time less.
  bool measures_errors = true;
  bool record_bands = false;  // ContractionSequence::bands, which a file needs: 14 bytes a triangle
  ProgressCallback progress;
};

struct BandStatistics {
  std::uint32_t patches = 0;
  std::uint32_t contractions = 0;
  std::uint32_t triangles_after = 0;
  float surface_error = 0;  // the largest so far, model units
};

struct SimplifyStatistics {
  std::vector<BandStatistics> bands;
};

// `snapped` must lie on `grid` and hold check_mesh(). The result is the same to the bit for any
// number of threads. Memory beside the input: about 165 bytes a triangle and 6 MB a thread. Fails
// when interrupted, and for options out of their ranges. `statistics` may be null.
Result<ContractionSequence> simplify(const Mesh& snapped, const Grid& grid,
                                     const SimplifyOptions& options,
                                     SimplifyStatistics* statistics = nullptr);

}  // namespace crease
