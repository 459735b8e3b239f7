// The blocks of a BlockMesh on the GPU: each is uploaded when it is first shown, and freed when the
// mesh drops it.
//
//   every frame:
//     const StreamReport report = streamer.update(parameters);
//     blocks.drop(report.cut.dropped);
//     blocks.upload(streamer.mesh().shown());
//     blocks.draw(programs, pass, style, streamer.mesh().shown());
//
// Memory: ResidentBlock::bytes() of the blocks that were ever shown and are still resident, at
// most; arrays that only decoding needs are not among it.
#pragma once

#include "crease/block_mesh.h"
#include "render/gl_scene.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace crease {

struct DrawCount {
  std::size_t calls = 0, triangles = 0;

  DrawCount& operator+=(const DrawCount& other) {
    calls += other.calls;
    triangles += other.triangles;
    return *this;
  }
};

class GlBlocks {
 public:
  // What a block is drawn in, all of it; empty: as the style says.
  using ColorOfBlock = std::function<ColorSrgb(const ResidentBlock&)>;

  GlBlocks() : GlBlocks(std::make_shared<GlMaterials>()) {}
  explicit GlBlocks(GlMaterialsPtr materials) : materials_(std::move(materials)) {}

  // What is shown and not here yet: all of it, since there is nothing to draw in its place. What
  // `other` has of it is shared instead. Returns the bytes.
  std::size_t upload(std::span<const ShownRange> shown, const GlBlocks* other = nullptr);
  void drop(std::span<const BlockId> blocks);

  // Around all corners of the blocks of which something is shown.
  Box box_of(std::span<const ShownRange> shown) const;
  // Of each of their boxes, less `origin`.
  std::vector<Vec3f> box_corners_of(std::span<const ShownRange> shown, const Vec3d& origin) const;

  // Into the bound framebuffer, without what lies beside the view.
  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style,
                         std::span<const ShownRange> shown,
                         const ColorOfBlock& color_of_block = {}) const;

  std::size_t block_count() const { return scenes_.size(); }
  // On the GPU, what is shared among it, and without materials.
  std::size_t bytes() const { return bytes_; }

 private:
  const GlScene* find(const ResidentBlock& block) const;

  GlMaterialsPtr materials_;
  std::unordered_map<std::uint32_t, std::shared_ptr<const GlScene>> scenes_;  // by block
  std::size_t bytes_ = 0;
};

}  // namespace crease
