// What the attributes of a block's vertices are between its two ends. The simplifier gives a merged
// wedge the value that is best for the triangles it stands for (Hoppe 1999), as a function of where
// the vertex stands; from the block's fine end the same quadrics follow, but for what the bands
// before knew.
//
//   WedgeQuadrics quadrics(block, layers, values, geometry, is_contracted);
//   patch.contract(first, second);                     // children before parents
//   cost += quadrics.contract(patch, vanished, first, second, geometry.from_origin(parent));
//   const std::vector<WedgeValues> all = std::move(quadrics).take();
#pragma once

#include "codec/contracting_patch.h"
#include "codec/layer_values.h"
#include "codec/patch_geometry.h"
#include "codec/unfold_blocks.h"
#include "crease/block_file.h"
#include "hierarchy/quadric.h"
#include "hierarchy/same_value.h"
#include "hierarchy/triangle_sizes.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// Of one layer. A wedge is a value at a vertex: each contraction makes new ones out of all that
// stand at its two vertices. So at most kMostWedges at a vertex are kept, and four a corner of the
// block in all: a hub of thousands would take the cube of time and the square of memory.
struct WedgeValues {
  std::vector<std::uint32_t> of_corner;     // 3 a triangle, at the fine end; kNone: shows none, or
                                            // its vertex has too many. Empty: nothing of this layer
                                            // is known here
  std::vector<std::uint32_t> into;          // per wedge; kNone: no contraction touches its vertex,
                                            // or what it made has too many
  std::vector<std::array<float, 4>> value;  // per wedge
  std::vector<char> is_known;               // per wedge: whether it has a value
  SameValue same;
};

class WedgeQuadrics {
 public:
  // Points are about the geometry's origin. `values`: one a layer. `is_contracted`: per vertex,
  // whether it may be one of those of contract(). `block` must outlive it.
  WedgeQuadrics(const UnfoldedBlock& block, std::span<const LayerSchema> layers,
                std::span<const LayerValues> values, const PatchGeometry& geometry,
                std::span<const char> is_contracted);

  // After patch.contract(first, second), which returned `vanished`: what the attributes cost with
  // the vertex at `at`, grid units^4. May be infinite or no number, where the block is nonsense.
  double contract(const ContractingPatch& patch, std::span<const std::uint32_t> vanished,
                  std::uint32_t first, std::uint32_t second, const Vec3d& at);

  // How far, by the last contraction, smooth surfaces show other attributes than those that they
  // stand for: the worst wedge's mean.
  float degrees() const { return degrees_; }
  float texture() const { return texture_; }
  // How far textures and colours are displaced, grid units.
  double displacement() const { return displacement_; }

  // What one that a normal is off is worth beside a distance, grid units.
  double radian() const;

  // Whether wedges are kept of a layer; and, per vertex, whether it has several of some layer.
  bool has_wedges(std::size_t layer) const { return !layers_[layer].wedges.empty(); }
  std::span<const char> has_several() const { return has_several_; }

  // Per layer.
  std::vector<WedgeValues> take() &&;

 private:
  struct Wedge {
    std::uint32_t quadric = 0;     // in Layer::quadrics; kNone: of no vertex that is contracted
    bool is_pinned = false;        // a triangle has it at all three corners: it does not change
    std::uint32_t wanted = kNone;  // corner whose value at the coarse end it gets
    std::uint32_t place = 0;       // in members_, if it is there
  };
  static constexpr std::size_t kMostWedges = 256;

  struct Layer {
    int dimension = 1;
    bool is_direction = false;
    AttributeRole role = AttributeRole::Other;
    double scale = 0;                    // squared grid units that one unit of error is worth
    std::span<const CodedValue> coarse;  // of the block's coarse end
    WedgeValues values;
    std::vector<std::uint32_t> wedge_of_corner;  // as it is
    std::vector<Wedge> wedges;
    std::vector<simplification::AttributeQuadric> quadrics;
  };

  void load_wedges(const UnfoldedBlock& block, const LayerValues& values, std::size_t l,
                   std::span<const char> is_contracted, Layer& layer);
  static void load_quadrics(const PatchMesh& mesh, const LayerValues& values, std::size_t l,
                            const PatchGeometry& geometry, Layer& layer);
  void set_scale(const UnfoldedBlock& block, const LayerSchema& schema,
                 const PatchGeometry& geometry, Layer& layer) const;
  double contract(const ContractingPatch& patch, std::span<const std::uint32_t> vanished,
                  std::uint32_t first, std::uint32_t second, const Vec3d& at, Layer& layer);
  double join(std::span<const std::uint32_t> members, const Vec3d& at, Layer& layer);
  // Those of members_ are no more, nor is anything known at `first`.
  void forget(const ContractingPatch& patch, std::uint32_t first, Layer& layer) const;
  bool keep_apart(const Layer& layer, std::uint32_t a, std::uint32_t b) const;

  std::vector<Layer> layers_;
  std::vector<char> has_several_;  // per vertex
  TriangleSizes sizes_;
  double worst_square_ = 0;  // of one contraction and layer
  double displacement_ = 0;
  float degrees_ = 0, texture_ = 0;
  // Scratch of one contraction: the wedges at its vertices, and by which of them each is joined.
  std::vector<std::uint32_t> members_, root_, group_;
};

}  // namespace crease::codec
