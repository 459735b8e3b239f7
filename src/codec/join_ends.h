// Triangles of fine ends -> one mesh.
#pragma once

#include "codec/layer_values.h"
#include "codec/model_schema.h"
#include "codec/patch_mesh.h"
#include "codec/value_pool.h"
#include "crease/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

struct EndPiece {
  const PatchMesh* end = nullptr;
  std::span<const std::uint32_t> vertices;  // per vertex of it: of the mesh
};

struct PlacedTriangle {
  std::uint32_t piece = 0, triangle = 0;
};

// The values of all layers, and their ids.
class LayerPools {
 public:
  explicit LayerPools(const ModelSchema& schema);
  LayerPools(const LayerPools&) = delete;
  LayerPools& operator=(const LayerPools&) = delete;

  std::span<const LayerValues> values() const { return values_; }  // per layer
  std::vector<ValuePool>& pools() { return pools_; }               // per layer; read values()

 private:
  std::vector<LayerValues> values_;
  std::vector<ValuePool> pools_;
};

// The mesh that has these triangles, in this order. `positions`: per vertex of the mesh. Values
// that triangles share become one attribute as ValuePool says, and get their ids in `pools`, which
// are empty before. Time linear.
Mesh join_ends(const ModelSchema& schema, std::span<const EndPiece> pieces,
               std::span<const PlacedTriangle> triangles, std::span<const Vec3i> positions,
               std::vector<ValuePool>& pools);

}  // namespace crease::codec
