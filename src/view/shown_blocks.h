// By block: what has streamed so far, whole or by vertex inside blocks. Several show views of one
// stream, and share on the GPU what another one has there.
#pragma once

#include "crease/block_streamer.h"
#include "render/gl_creases.h"
#include "render/gl_cuts.h"
#include "view/shown_mesh.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace crease {

class ShownBlocks final : public ShownMesh {
 public:
  // Of that view of the stream, which is there while this lives. `beside`: null, or outlives this.
  // `materials`: the model's, which all that show it share.
  ShownBlocks(std::shared_ptr<BlockStreamer> streamer, std::size_t view, const ShownBlocks* beside,
              GlMaterialsPtr materials)
      : streamer_(std::move(streamer)),
        view_(view),
        beside_(beside),
        materials_(std::move(materials)),
        blocks_(materials_),
        cuts_(materials_) {}

  FrameFacts update(const ViewSettings& settings, const Camera& camera) override;
  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                         const ViewSettings& settings, const Camera& cut_camera) override;
  std::optional<Hit> pick(const Ray& ray) const override;
  HitFacts facts_of(const Hit& hit) const override;
  std::vector<Vec3f> outline() const override;
  Vec3d origin() const override { return mesh().facts().grid.origin; }
  Box box() const override;

  const BlockMesh& mesh() const { return streamer_->mesh(view_); }

 private:
  std::vector<float> pixels_of_position(const ShownCut& cut, const Camera& camera) const;
  double pixels_of(const ResidentBlock& block, const BlockGroup& group, const Camera& camera) const;
  Result<DrawCount> draw_by_error(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                                  double full_pixels, const Camera& camera);

  const std::shared_ptr<BlockStreamer> streamer_;
  const std::size_t view_;
  const ShownBlocks* const beside_;
  const GlMaterialsPtr materials_;
  GlBlocks blocks_;
  GlCuts cuts_;
  GlBlockCreases creases_;
  std::optional<Camera> painted_;  // whose errors the cuts' scalars are
};

}  // namespace crease
