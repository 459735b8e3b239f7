// Crease lines over what is drawn: dark where the shading breaks, in another tint at borders.
//
//   GlCreases creases;                                   // of a list that stands alone
//   creases.set(crease_lines(list), list.origin);
//   creases.draw(programs, pass, style);
//
//   GlBlockCreases creases;                              // of blocks
//   every frame:
//     creases.drop(report.cut.dropped);
//     creases.update(streamer.mesh().shown());
//     creases.draw(programs, pass, style);
//
// Lines are as wide on the screen everywhere, and fade where they are short there, so that what is
// far away and full of edges does not turn black.
#pragma once

#include "crease/block_mesh.h"
#include "render/block_creases.h"
#include "render/gl_objects.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace crease {

class GlCreases {
 public:
  // Returns the bytes uploaded.
  std::size_t set(const CreaseLines& lines, const Vec3d& origin);
  // Into the bound framebuffer and its viewport, with its depths.
  Status draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const;
  std::size_t bytes() const { return hard_.bytes + borders_.bytes; }  // on the GPU

 private:
  Vec3d origin_;
  GlArray hard_, borders_;  // two texels a line
  GlVertexArray no_attributes_ = GlVertexArray::make();
};

// Lines within the groups of a block are found and uploaded once, when it is first shown; those
// between groups each time that something else is shown.
class GlBlockCreases {
 public:
  // Cuts by vertex are gone through again whenever they show another thing. The same.
  std::size_t update(std::span<const ShownRange> shown, std::span<const ShownCut> cuts = {});
  void drop(std::span<const BlockId> blocks);
  Status draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const;
  std::size_t bytes() const;

 private:
  struct BlockLines {
    Box box;
    GlArray hard;
    BlockCreases creases;  // without the lines that are on the GPU
  };
  struct ShownLines {
    const BlockLines* block = nullptr;
    Range hard;
  };
  struct CutLines {
    std::uint64_t revision = 0;
    GroupLines lines;
  };
  const GroupLines& lines_of_cut(const ShownCut& cut);
  const BlockLines& lines_of_block(const ResidentBlock& block, std::size_t& uploaded);

  std::unordered_map<std::uint32_t, BlockLines> blocks_;  // by block; what is in it stays in place
  std::unordered_map<std::uint32_t, CutLines> cuts_;      // by block, of what is shown
  std::vector<ShownRange> of_;                            // what the rest is of
  std::vector<std::uint64_t> of_revisions_;               // and of these cuts
  std::vector<ShownLines> shown_;
  Vec3d origin_;  // of all blocks
  GlCreases between_;
  GlVertexArray no_attributes_ = GlVertexArray::make();
};

}  // namespace crease
