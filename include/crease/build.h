// The build: snap, simplify, encode. What `crease build` does.
//
//   Result<Built> built = build_model(std::move(mesh), {});
//   write_crease("model.crease", built->file_bytes);
#pragma once

#include "crease/attribute_precision.h"
#include "crease/file.h"
#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/simplify.h"

#include <cstddef>
#include <string>
#include <vector>

namespace crease {

struct BuildOptions {
  Precision precision;
  AttributePrecision attributes;
  SimplifyOptions simplify;
};

// What snapping did to the values of one attribute layer.
struct SnappedLayer {
  std::string layer;      // its name
  std::string precision;  // in words: "octahedral, 10 bits a component", "exact"
  double error_max = 0;   // by how much values were off, degrees for normals, else units
  double error_mean = 0;
  std::size_t joined = 0;  // values that became equal to another at a vertex, and one with it
};

// Snaps the values of every attribute layer in place, as build_model() does before simplification.
// Corners that share a value go on sharing it; values that meet at a vertex and became equal to the
// bit become one. `precision` must pass check_attribute_precision(). One report a layer.
std::vector<SnappedLayer> snap_attributes(Mesh& mesh, const AttributePrecision& precision);

struct Built {
  SimplifyStatistics statistics;
  double grid_step = 0, position_error_max = 0;  // how far snapping moved a vertex; model units
  std::vector<SnappedLayer> snapped;             // one a layer
  std::uint32_t blocks = 0;
  std::vector<std::byte> file_bytes;
};

// `mesh` must hold check_mesh(). Fails with Invalid where it has no normals, when check_precision()
// or check_attribute_precision() does, and when interrupted. The file was opened and all its
// checksums were looked at; its blocks were not decoded (crease validate does).
Result<Built> build_model(Mesh mesh, const BuildOptions& options);

}  // namespace crease
