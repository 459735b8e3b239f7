// How far the triangles of a block that show one normal turn away from what they stand for, while
// its splits are undone: as the simplifier counts it (simplify/flat_shading.cpp), from the block's
// fine end on. When such a triangle vanishes, a neighbour stands for it: of those at its third
// vertex the one that shows the nearest normal.
//
//   FaceNormals faces(block, layers, values, is_face);
//   patch.contract(first, second);                                  // children before parents
//   float degrees = faces.contract(patch, vanished, first, positions);
#pragma once

#include "codec/contracting_patch.h"
#include "codec/layer_values.h"
#include "codec/unfold_blocks.h"
#include "crease/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

class FaceNormals {
 public:
  // `values`: one a layer. `is_face`: per triangle, whether it shows one normal; it must outlive
  // this, as the block must.
  FaceNormals(const UnfoldedBlock& block, const BlockCoding& coding,
              std::span<const LayerValues> values, std::span<const char> is_face);

  bool is_empty() const { return faces_.empty(); }  // there are no normals

  // After patch.contract(first, second), which returned `vanished`, with all vertices where they
  // stand now: the worst of those around `first`.
  float contract(const ContractingPatch& patch, std::span<const std::uint32_t> vanished,
                 std::uint32_t first, std::span<const Vec3i> positions);

 private:
  struct Face {
    Vec3d shown;              // unit normal
    Vec3d sum;                // of what it stands for, by area
    double area = 0;          // of that
    bool is_derived = false;  // it shows its geometric normal
  };

  void show(const ContractingPatch& patch, std::uint32_t t, std::span<const Vec3i> positions);
  Face* heir_of(const ContractingPatch& patch, std::uint32_t vanished, std::uint32_t first);

  const UnfoldedBlock& block_;
  std::span<const char> is_face_;
  std::vector<Face> faces_;  // per triangle, or empty: there are no normals
};

}  // namespace crease::codec
