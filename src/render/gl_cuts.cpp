#include "render/gl_cuts.h"

#include "crease/block_view.h"

namespace crease {

namespace {

std::uint32_t number_of(const ShownCut& cut) {
  return static_cast<std::uint32_t>(index_of(cut.block->id()));
}

}  // namespace

const GlScene* GlCuts::find(const ShownCut& cut) const {
  const auto at = cuts_.find(number_of(cut));
  return at == cuts_.end() ? nullptr : at->second.scene.get();
}

std::size_t GlCuts::upload(std::span<const ShownCut> shown) {
  ++uploads_;
  std::size_t uploaded = 0;
  for (const ShownCut& cut : shown) {
    Cut& here = cuts_[number_of(cut)];
    here.shown_at = uploads_;
    if (here.scene && here.revision == cut.revision) continue;
    here.scene = std::make_unique<GlScene>(cut.list, std::span<const float>{}, materials_);
    here.revision = cut.revision;
    uploaded += here.scene->bytes();
  }
  std::erase_if(cuts_, [this](const auto& cut) { return cut.second.shown_at != uploads_; });
  return uploaded;
}

std::size_t GlCuts::set_scalars(const ShownCut& cut, std::span<const float> scalars) {
  return cuts_.at(number_of(cut)).scene->set_scalars(scalars);
}

std::size_t GlCuts::bytes() const {
  std::size_t sum = 0;
  for (const auto& [block, cut] : cuts_) sum += cut.scene->bytes();
  return sum;
}

Box GlCuts::box_of(std::span<const ShownCut> shown) const {
  Box box;
  for (const ShownCut& cut : shown) {
    const GlScene* const scene = find(cut);
    if (scene == nullptr || scene->box().empty) continue;
    box.add(scene->box().low);
    box.add(scene->box().high);
  }
  return box;
}

std::vector<Vec3f> GlCuts::box_corners_of(std::span<const ShownCut> shown,
                                          const Vec3d& origin) const {
  std::vector<Vec3f> corners;
  for (const ShownCut& cut : shown) {
    const GlScene* const scene = find(cut);
    if (scene == nullptr || scene->box().empty) continue;
    for (int i = 0; i < 8; ++i) {
      const Vec3d corner = corner_of(scene->box(), i) - origin;
      corners.push_back({float(corner.x), float(corner.y), float(corner.z)});
    }
  }
  return corners;
}

Result<DrawCount> GlCuts::draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style,
                               std::span<const ShownCut> shown,
                               const GlBlocks::ColorOfBlock& color_of_block) const {
  DrawCount count;
  DrawStyle of_block = style;
  for (const ShownCut& cut : shown) {
    const GlScene* const scene = find(cut);
    if (scene == nullptr || scene->box().empty || is_beside(pass.view, scene->box())) continue;
    if (color_of_block) of_block.surface = color_of_block(*cut.block);
    const std::vector<ShownRange> in_view = shown_groups(cut, [&](const BlockGroup& group) {
      Box box;
      for (const Vec3f& p : {group.low, group.high}) {
        box.add(cut.list.origin + Vec3d{p.x, p.y, p.z});
      }
      return !is_beside(pass.view, box);
    });
    for (const ShownRange& range : in_view) {
      const DrawRanges ranges{range.sn, range.fn, range.nsn};
      if (const Status drawn = scene->draw(programs, pass, of_block, ranges); !drawn.ok()) {
        return drawn.failure();
      }
      count.calls += (range.sn.count > 0) + (range.fn.count > 0) + (range.nsn.count > 0);
      count.triangles += range.triangle_count();
    }
  }
  return count;
}

}  // namespace crease
