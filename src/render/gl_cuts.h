// The cuts by vertex of a BlockMesh on the GPU: what a block shows is uploaded whenever it is
// another thing.
//
//   every frame:
//     cuts.upload(streamer.mesh().shown_cuts());
//     cuts.draw(programs, pass, style, streamer.mesh().shown_cuts());
#pragma once

#include "crease/block_mesh.h"
#include "render/gl_blocks.h"
#include "render/gl_scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace crease {

class GlCuts {
 public:
  explicit GlCuts(GlMaterialsPtr materials) : materials_(std::move(materials)) {}

  // What is not shown any more is freed. Returns the bytes uploaded.
  std::size_t upload(std::span<const ShownCut> shown);

  // What Coloring::Error shows of one, per position; until another thing of it is shown.
  std::size_t set_scalars(const ShownCut& cut, std::span<const float> scalars);

  // Around all corners of what is shown.
  Box box_of(std::span<const ShownCut> shown) const;
  // Of each one's box, less `origin`.
  std::vector<Vec3f> box_corners_of(std::span<const ShownCut> shown, const Vec3d& origin) const;

  // Into the bound framebuffer, without what lies beside the view.
  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style,
                         std::span<const ShownCut> shown,
                         const GlBlocks::ColorOfBlock& color_of_block = {}) const;

  std::size_t bytes() const;  // on the GPU

 private:
  struct Cut {
    std::unique_ptr<GlScene> scene;
    std::uint64_t revision = 0;
    std::uint64_t shown_at = 0;  // the last upload() that showed it
  };
  const GlScene* find(const ShownCut& cut) const;

  GlMaterialsPtr materials_;
  std::unordered_map<std::uint32_t, Cut> cuts_;  // by block
  std::uint64_t uploads_ = 0;
};

}  // namespace crease
