// Contraction sequences that no simplifier would make: valid, random, down to one vertex.
//
//   ContractionSequence s = random_contractions(mesh, grid, {.seed = 7});
//   CHECK(check_contractions(mesh, s).ok());
//
// Edges and virtual pairs, in any order. At each contraction the attributes that a vanishing
// triangle has at p and at q become one (G03 3.4), an existing one or a new value; now and then
// another attribute changes as well, a new value has the bits of an old one, or a triangle starts
// to derive its normal.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstdint>

namespace crease {

struct RandomContractionOptions {
  std::uint64_t seed = 1;
  Placement placement = Placement::Optimal;
  double virtual_share = 0.2;  // of the pairs
  double change_share = 0.2;   // of the attributes at v_s that change though nothing joins them
  double derive_share = 0.2;   // of the contractions that derive a triangle
  bool smooth_only = false;    // attributes at p and q always join, so a smooth mesh stays smooth
};

// `snapped` must lie on `grid`.
ContractionSequence random_contractions(const Mesh& snapped, const Grid& grid,
                                        const RandomContractionOptions& options);

// Triangles between random vertices with random corner attributes: non-manifold, with normals, a
// layer of texture coordinates, colours, a categorical layer, materials and parts.
Mesh random_complex(std::uint64_t seed, std::size_t vertex_count, std::size_t triangle_count);

}  // namespace crease
