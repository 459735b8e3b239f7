// The build: import, normals, snap, simplify, pack, write. What `crease build` does.
//
//   Result<Built> built = build_model(std::move(mesh), {});
//   write_crease("model.crease", built->file_bytes);
#pragma once

#include "crease/file.h"
#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/simplify.h"

#include <cstddef>
#include <vector>

namespace crease {

struct BuildOptions {
  Precision precision;
  SimplifyOptions simplify;
};

struct Built {
  ProgressiveArraysPtr arrays;
  SimplifyStatistics statistics;
  std::vector<std::byte> file_bytes;
};

// DB03 phases I and III: partitions `snapped` and packs the contractions.
ProgressiveArraysPtr build_progressive_arrays(const Mesh& snapped,
                                              const ContractionSequence& sequence);

// `mesh` must hold check_mesh() and have normals. Fails only when interrupted.
Result<Built> build_model(Mesh mesh, const BuildOptions& options);

}  // namespace crease
