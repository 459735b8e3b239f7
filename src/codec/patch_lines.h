// Borders of a block, and edges with other values on the other side, hold their vertices by planes
// that stand upright on the triangles.
//
//   PatchLines lines(block, coding, patch, geometry, is_contracted, is_face, wedges);
//   if (const Quadric* q = lines.join(first, second)) use(q->at(place));
#pragma once

#include "codec/contracting_patch.h"
#include "codec/patch_geometry.h"
#include "codec/unfold_blocks.h"
#include "codec/wedge_quadrics.h"
#include "hierarchy/quadric.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

class PatchLines {
 public:
  // `is_contracted`: per vertex; others get no planes. `is_face`: per triangle, whether it shows
  // one normal. Time linear, times the triangles around a vertex where there are lines.
  PatchLines(const UnfoldedBlock& block, const BlockCoding& coding, const ContractingPatch& patch,
             const PatchGeometry& geometry, std::span<const char> is_contracted,
             std::span<const char> is_face, const WedgeQuadrics& wedges);

  // Those of `second` go to `first`. What `first` has then, about the geometry's origin, its
  // `weight` the sum of squared lengths; null if nothing. Good until the next call.
  const simplification::Quadric* join(std::uint32_t first, std::uint32_t second);

 private:
  std::vector<std::uint32_t> line_of_vertex_;  // in lines_, or kNone
  std::vector<simplification::Quadric> lines_;
};

}  // namespace crease::codec
