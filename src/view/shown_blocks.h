// By block: what has streamed so far.
#pragma once

#include "crease/block_streamer.h"
#include "render/gl_creases.h"
#include "view/shown_mesh.h"

namespace crease {

class ShownBlocks final : public ShownMesh {
 public:
  explicit ShownBlocks(BlockStreamer streamer) : streamer_(std::move(streamer)) {}

  FrameFacts update(const ViewSettings& settings, const Camera& camera) override;
  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                         const ViewSettings& settings, const Camera& cut_camera) override;
  std::optional<Hit> pick(const Ray& ray) const override;
  std::vector<Vec3f> outline() const override;
  Vec3d origin() const override { return streamer_.mesh().facts().grid.origin; }
  Box box() const override { return blocks_.box_of(streamer_.mesh().shown()); }

  const BlockStreamer& streamer() const { return streamer_; }

 private:
  BlockStreamer streamer_;
  GlBlocks blocks_;
  GlBlockCreases creases_;
};

}  // namespace crease
