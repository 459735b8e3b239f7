// What corners carry between the two ends of a block, as the attribute changes of its contractions.
//
// A block has values at both ends. Attributes at the two children that a collapsed triangle links
// become one (G03 3.3), unless the coarse end has them apart; while the vertex will be contracted
// further in the same block, that is what is best for the triangles that they stand for
// (codec/wedge_quadrics.h), or where that is not known, what they are at where the parent stands
// between the children; with its last contraction every corner gets what it has at the coarse end.
// Triangles that show their geometric normal at the coarse end do so from the first contraction
// that touches them; so do those that show it at the fine end already, where that is not the
// model's.
#pragma once

#include "codec/contracting_patch.h"
#include "codec/order_contractions.h"
#include "codec/unfold_blocks.h"
#include "codec/value_pool.h"
#include "crease/block_file.h"
#include "crease/contraction.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// Of the contractions of a block, one after the other.
struct CornerChanges {
  struct Range {  // of one contraction
    std::uint32_t first = 0, count = 0;
  };
  std::vector<AttributeChange> changes;
  std::vector<TriangleId> derived;
  std::vector<Range> changes_of, derived_of;

  std::span<const AttributeChange> changed(std::size_t contraction) const {
    return std::span(changes).subspan(changes_of[contraction].first, changes_of[contraction].count);
  }
  std::span<const TriangleId> now_derived(std::size_t contraction) const {
    return std::span(derived).subspan(derived_of[contraction].first, derived_of[contraction].count);
  }
};

class AttributeRejoiner {
 public:
  // `of_corner`: per layer, the ids of all corners of the model at its finest. Moves on with every
  // block, for the triangles that its coarse end has; blocks come finest first.
  AttributeRejoiner(std::span<const LayerSchema> layers, std::vector<ValuePool>& pools,
                    std::vector<std::vector<std::uint32_t>> of_corner);

  // Of the contractions of `order`. `wedges`: per layer, from order_contractions().
  CornerChanges rejoin(const UnfoldedBlock& block, std::span<const OrderedContraction> order,
                       std::vector<WedgeValues> wedges);

 private:
  struct AtVertex {  // a value that corners at the present vertex have
    std::uint32_t id = 0;
    std::uint32_t to = 0;                    // what becomes of it, and of those corners
    std::array<std::uint32_t, 2> corners{};  // that came from the first child, from the second
    std::uint32_t wedge = kNone;             // of WedgeValues
    std::uint32_t joined = 0;                // the first one of those that it is joined with
    std::uint32_t wanted = kNone;            // corner of the block whose coarse value it gets
    bool is_flat = false;                    // and all corners of a triangle have that value there
  };

  // What a triangle of the present block has at its corners, in one layer: of the model's arrays
  // and of WedgeValues, side by side, since contractions come from all over the block.
  struct AtCorners {
    std::array<std::uint32_t, 3> ids{}, wedges{};  // kNone: of no wedge
  };
  enum class Normals : std::uint8_t {  // of a triangle of the present block
    Stored,
    NextDerived,  // geometric from the first contraction on that touches it
    Derived,
  };

  void load(const UnfoldedBlock& block, std::span<const WedgeValues> wedges);
  void store(const UnfoldedBlock& block);
  void derive(const UnfoldedBlock& block, const ContractingPatch& patch, std::uint32_t v,
              std::vector<TriangleId>& derived);
  void find_values(const UnfoldedBlock& block, const ContractingPatch& patch, std::uint32_t v,
                   std::size_t layer, const WedgeValues& wedges);
  void join(const UnfoldedBlock& block, const ContractingPatch& patch,
            std::span<const std::uint32_t> vanished, std::uint32_t first, std::uint32_t second,
            std::size_t layer);
  void go_to_coarse(const UnfoldedBlock& block, std::size_t layer);
  // `second_share`: where the parent stands on the way from the first child to the second.
  void blend(std::size_t layer, double second_share);
  bool are_known(const WedgeValues& wedges) const;                // all at the vertex
  void go_to_best(const WedgeValues& wedges, std::size_t layer);  // they must be known
  // What is flat at the fine end and has another value at the coarse end goes there under an id of
  // its own, not to be taken for what it meets on the way and stays flat.
  void part(const UnfoldedBlock& block, std::size_t layer);
  void record(std::size_t layer,
              std::vector<AttributeChange>& changes);  // what became of the values
  bool is_hidden(std::size_t layer, std::uint32_t triangle) const {
    return layers_[layer].role == AttributeRole::Normal && normals_[triangle] == Normals::Derived;
  }
  AtVertex* find(std::uint32_t id);
  AtVertex& add(std::uint32_t id, std::uint32_t wedge);

  struct Shown {  // by a corner at the present vertex
    std::uint32_t* id = nullptr;
    std::size_t value = 0;  // in at_vertex_
  };

  std::span<const LayerSchema> layers_;
  std::vector<ValuePool>& pools_;
  std::vector<std::vector<std::uint32_t>> of_corner_;  // per layer, 3 a triangle
  std::vector<char> is_derived_;                       // per triangle
  bool has_normals_ = false;
  // Of the present block.
  std::vector<std::vector<AtCorners>> at_corners_;  // per layer and triangle
  std::vector<std::vector<char>> coarse_is_flat_;   // per layer and triangle of the coarse end
  std::vector<Normals> normals_;                    // per triangle
  bool any_next_derived_ = false;
  static constexpr std::size_t kMostKnown = 1024;  // values at a vertex
  std::vector<AtVertex> at_vertex_;                // scratch
  std::vector<std::uint32_t> place_of_id_;         // in it, of those that are there
  std::vector<Shown> shown_;
  std::vector<std::uint32_t> scratch_;
};

}  // namespace crease::codec
