// The state of a linear progressive mesh between full resolution and base, moved one contraction at
// a time in either direction.
//
//   LinearState state(arrays);           // full resolution
//   while (state.applied() < n) state.apply(marks);
//   while (state.applied() > n) state.undo(marks);
//
// `marks` hears what is written: position(slot), own_normal(slot), corner(c) when corner c changes
// its slot, index(layer, c) when it changes its value, derived(triangle), touched(c).
//
// Every step is its own inverse or keeps what it overwrites implicit: corner changes write the one
// slot or the other, swaps and xors undo themselves, deltas are taken back. So n contractions forth
// and back restore all bits. The arrays must pass check_progressive_arrays().
#pragma once

#include "crease/progressive_arrays.h"
#include "hierarchy/packed_contraction.h"

#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease {

struct NoMarks {
  void position(std::uint32_t) {}
  void own_normal(std::uint32_t) {}
  void corner(std::uint32_t) {}
  void index(std::uint32_t, std::uint32_t) {}
  void derived(std::uint32_t) {}
  void touched(std::uint32_t) {}
};

class LinearState {
 public:
  struct Layer {
    std::vector<float> own;              // Storage::Vertex: dimension a slot
    std::vector<std::uint32_t> indices;  // as in ProgressiveLayer
  };

  explicit LinearState(const ProgressiveArrays& arrays);

  std::size_t applied() const { return applied_; }
  const SectionCounts& active() const { return active_; }

  // How the active triangles change with the next contraction, and with undoing the previous one.
  std::size_t triangles_lost_next() const { return header(applied_, wide_).lost.triangles(); }
  std::size_t triangles_won_previous() const {
    return header(applied_ - 1, wide_ - 1).lost.triangles();
  }

  template <typename Marks>
  void apply(Marks& marks);
  template <typename Marks>
  void undo(Marks& marks);

  // Where corner c (3 * triangle + corner) finds its value of a layer: in its indices, or owned by
  // its slot when kNone.
  std::uint32_t index_of_corner(std::size_t layer, std::uint32_t c) const;
  std::span<const float> value_of_corner(std::size_t layer, std::uint32_t c) const;

  bool is_explicit_normal(std::uint32_t triangle) const {
    return triangle >= arrays_->full.sn_triangles;
  }
  bool is_derived(std::uint32_t triangle) const {
    return triangle >= arrays_->full.sn_triangles && !is_derived_.empty() &&
           is_derived_[triangle - arrays_->full.sn_triangles] != 0;
  }
  // The stored normal of a corner; what a derived triangle shows is another thing.
  Vec3f stored_normal(std::uint32_t c) const;
  // The index into arrays.normals, or kNone: the slot's own.
  std::uint32_t normal_index(std::uint32_t c) const;

  std::vector<Vec3i> positions;
  std::vector<std::uint32_t> indices;
  std::vector<Vec3f> own_normals;  // of the SN slots
  std::vector<std::uint32_t> nsn_normals;
  std::vector<Layer> layers;

 private:
  PackedHeader header(std::size_t contraction, std::size_t wide) const {
    PackedHeader h = unpack_header(arrays_->contractions.headers[contraction]);
    if (h.is_wide) {
      h.lost = arrays_->contractions.wide[wide].lost;
      h.corner_changes = arrays_->contractions.wide[wide].corner_changes;
    }
    return h;
  }
  std::uint32_t last_active(bool nsn) const {
    return nsn ? arrays_->full.sn_vertices + active_.nsn_vertices - 1 : active_.sn_vertices - 1;
  }
  template <typename Marks>
  void move_block(std::size_t block, bool forwards, Marks& marks);
  template <typename Marks>
  void change_own(std::uint32_t slot, const PackedHeader& h, std::size_t word, Marks& marks);
  std::uint32_t& stored_index(std::uint32_t layer, std::uint32_t c);

  const ProgressiveArrays* arrays_;
  std::vector<std::uint8_t> is_derived_;  // of the FN and NSN triangles, once there are any
  std::size_t own_words_ = 0;
  SectionCounts active_;
  std::size_t applied_ = 0;
  std::size_t wide_ = 0, corner_ = 0, own_ = 0, block_ = 0;  // cursors: the next contraction's
};

template <typename Marks>
void LinearState::apply(Marks& marks) {
  const PackedContractions& packed = arrays_->contractions;
  const PackedHeader h = header(applied_, wide_);
  const std::uint32_t removed = last_active(h.removed_is_nsn);
  const std::uint32_t kept = packed.kept[applied_];
  if (!packed.deltas.empty()) {
    const Vec3i& d = packed.deltas[applied_];
    if (d != Vec3i{}) marks.position(kept);
    for (int i = 0; i < 3; ++i) {  // unsigned: wraps instead of overflowing
      positions[kept][i] = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(positions[kept][i]) + static_cast<std::uint32_t>(d[i]));
    }
  } else if (h.swaps_positions) {
    std::swap(positions[kept], positions[removed]);
    marks.position(kept);
    marks.position(removed);
  }
  for (std::uint32_t i = 0; i < h.corner_changes; ++i) {
    const std::uint32_t c = packed.corners[corner_ + i];
    indices[c] = kept;
    marks.corner(c);
  }
  corner_ += h.corner_changes;
  change_own(kept, h, own_, marks);
  own_ += (h.own_normal_changes ? 3 : 0) + (h.own_values_change ? own_words_ : 0);
  if (h.has_block) move_block(block_++, true, marks);
  if (h.is_wide) ++wide_;
  active_.sn_vertices -= h.lost.sn_vertices;
  active_.nsn_vertices -= h.lost.nsn_vertices;
  active_.sn_triangles -= h.lost.sn_triangles;
  active_.fn_triangles -= h.lost.fn_triangles;
  active_.nsn_triangles -= h.lost.nsn_triangles;
  ++applied_;
}

template <typename Marks>
void LinearState::undo(Marks& marks) {
  const PackedContractions& packed = arrays_->contractions;
  --applied_;
  const PackedHeader h = header(applied_, wide_ - 1);
  if (h.is_wide) --wide_;
  active_.sn_vertices += h.lost.sn_vertices;
  active_.nsn_vertices += h.lost.nsn_vertices;
  active_.sn_triangles += h.lost.sn_triangles;
  active_.fn_triangles += h.lost.fn_triangles;
  active_.nsn_triangles += h.lost.nsn_triangles;
  const std::uint32_t removed = last_active(h.removed_is_nsn);
  const std::uint32_t kept = packed.kept[applied_];
  if (!packed.deltas.empty()) {
    const Vec3i& d = packed.deltas[applied_];
    if (d != Vec3i{}) marks.position(kept);
    for (int i = 0; i < 3; ++i) {
      positions[kept][i] = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(positions[kept][i]) - static_cast<std::uint32_t>(d[i]));
    }
  } else if (h.swaps_positions) {
    std::swap(positions[kept], positions[removed]);
    marks.position(kept);
    marks.position(removed);
  }
  corner_ -= h.corner_changes;
  for (std::uint32_t i = 0; i < h.corner_changes; ++i) {
    const std::uint32_t c = packed.corners[corner_ + i];
    indices[c] = removed;
    marks.corner(c);
  }
  own_ -= (h.own_normal_changes ? 3 : 0) + (h.own_values_change ? own_words_ : 0);
  change_own(kept, h, own_, marks);
  if (h.has_block) move_block(--block_, false, marks);
}

template <typename Marks>
void LinearState::change_own(std::uint32_t slot, const PackedHeader& h, std::size_t word,
                             Marks& marks) {
  const std::vector<std::uint32_t>& own = arrays_->contractions.own;
  const auto flip = [&own, &word](float& f) {
    f = std::bit_cast<float>(std::bit_cast<std::uint32_t>(f) ^ own[word++]);
  };
  if (h.own_normal_changes) {
    Vec3f& n = own_normals[slot];
    flip(n.x);
    flip(n.y);
    flip(n.z);
    marks.own_normal(slot);
  }
  if (!h.own_values_change) return;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    if (arrays_->layers[l].storage != ProgressiveLayer::Storage::Vertex) continue;
    const std::size_t d = arrays_->layers[l].dimension;
    for (std::size_t i = 0; i < d; ++i) flip(layers[l].own[slot * d + i]);
  }
}

inline std::uint32_t& LinearState::stored_index(std::uint32_t layer, std::uint32_t c) {
  if (layer == 0) {
    return nsn_normals[c - 3 * (arrays_->full.sn_triangles + arrays_->full.fn_triangles)];
  }
  const ProgressiveLayer& source = arrays_->layers[layer - 1];
  std::vector<std::uint32_t>& stored = layers[layer - 1].indices;
  if (source.storage == ProgressiveLayer::Storage::Corner) return stored[c];
  return stored[3 * source.row_of_triangle[c / 3] + c % 3];
}

template <typename Marks>
void LinearState::move_block(std::size_t block, bool forwards, Marks& marks) {
  const PackedContractions& packed = arrays_->contractions;
  std::size_t word = block == 0 ? 0 : packed.block_ends[block - 1];
  while (word < packed.block_ends[block]) {
    const PackedGroup group = unpack_group(packed.blocks[word++]);
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const std::uint32_t item = packed.blocks[word++];
      switch (group.kind) {
        case BlockKind::Indices:
          stored_index(group.layer, item) ^= packed.blocks[word++];
          marks.index(group.layer, item);
          break;
        case BlockKind::Derived:
          is_derived_[item - arrays_->full.sn_triangles] = forwards ? 1 : 0;
          marks.derived(item);
          break;
        case BlockKind::Touched:
          marks.touched(item);
          break;
      }
    }
  }
}

}  // namespace crease
