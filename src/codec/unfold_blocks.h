// Blocks in terms of the whole model: vertices get slots and triangles numbers that hold from block
// to block. The first child of a split keeps its parent's slot.
//
//   BlockUnfolder unfolder;
//   unfolder.add(entry, decoded, starts);      // for every block, in the file's order
//   for (const UnfoldedBlock& block : unfolder.blocks()) ...
#pragma once

#include "codec/decode_block.h"
#include "crease/block_file.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease::codec {

struct UnfoldedBlock {
  std::uint16_t band = 0;
  LevelError coarse, fine;
  PatchMesh end;                         // the fine one
  std::vector<Split> splits;             // parents first
  std::vector<std::uint32_t> vertices;   // per vertex of the fine end: slot
  std::vector<std::uint32_t> triangles;  // per triangle of the fine end: number
  std::uint32_t coarse_vertex_count = 0;
  // Of the triangles that the coarse end has, which are the first ones: what they are there.
  std::vector<char> coarse_derived;                    // per triangle
  std::vector<std::vector<CodedValue>> coarse_values;  // per layer, 3 a triangle

  std::size_t coarse_triangle_count() const { return coarse_derived.size(); }
  // The second child of split i. They are the last vertices, in order.
  std::uint32_t second_child(std::size_t i) const {
    return static_cast<std::uint32_t>(vertices.size() - splits.size() + i);
  }
};

class BlockUnfolder {
 public:
  // What a block started from: `names` of its vertices, and of its triangles in which block added
  // before (not: of the file) they are.
  struct Start {
    std::vector<VertexName> names;
    std::vector<TriangleSource> sources;
  };
  void add(const BlockEntry& entry, DecodedBlock decoded, const Start& start);
  // What coarser blocks do inside of the one that add_alone() will add, by its slots and numbers.
  void add_part(UnfoldedBlock part) { blocks_.push_back(std::move(part)); }
  // One block and no other: slots and numbers are those of its fine end. `start`: what it started
  // from, with all values.
  void add_alone(const BlockFacts& facts, PatchMesh end, std::vector<Split> splits,
                 const CoarseEnd& start);

  std::span<const UnfoldedBlock> blocks() const { return blocks_; }
  // Whether a block that was added has such a vertex.
  bool has(const VertexName& name) const;
  std::uint32_t slot_count() const { return slot_count_; }
  std::uint32_t triangle_count() const { return triangle_count_; }

 private:
  std::uint32_t slot_of(const VertexName& name) const;

  std::vector<UnfoldedBlock> blocks_;
  std::vector<std::uint32_t> block_of_id_;  // in blocks_, by the number in the file
  std::uint32_t slot_count_ = 0, triangle_count_ = 0;
};

}  // namespace crease::codec
