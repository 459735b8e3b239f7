#include "render/gl_blocks.h"

#include "crease/block_view.h"

namespace crease {

namespace {

std::uint32_t key_of(BlockId id) {
  return static_cast<std::uint32_t>(index_of(id));
}

}  // namespace

const GlScene* GlBlocks::find(const ResidentBlock& block) const {
  const auto at = scenes_.find(key_of(block.id()));
  return at == scenes_.end() ? nullptr : at->second.get();
}

std::size_t GlBlocks::upload(std::span<const ShownRange> shown, const GlBlocks* other) {
  std::size_t uploaded = 0;
  for (const ShownRange& range : shown) {
    std::shared_ptr<const GlScene>& scene = scenes_[key_of(range.block->id())];
    if (scene) continue;
    if (other != nullptr) {
      const auto there = other->scenes_.find(key_of(range.block->id()));
      if (there != other->scenes_.end()) {
        scene = there->second;
        bytes_ += scene->bytes();
        continue;
      }
    }
    const DrawList list = range.block->draw_list();
    scene = std::make_shared<const GlScene>(list, std::span<const float>{}, materials_);
    uploaded += scene->bytes();
    bytes_ += scene->bytes();
  }
  return uploaded;
}

void GlBlocks::drop(std::span<const BlockId> blocks) {
  for (const BlockId id : blocks) {
    const auto at = scenes_.find(key_of(id));
    if (at == scenes_.end()) continue;
    bytes_ -= at->second->bytes();
    scenes_.erase(at);
  }
}

Box GlBlocks::box_of(std::span<const ShownRange> shown) const {
  Box box;
  for (const ShownRange& range : shown) {
    const GlScene* scene = find(*range.block);
    if (scene == nullptr || scene->box().empty) continue;
    box.add(scene->box().low);
    box.add(scene->box().high);
  }
  return box;
}

std::vector<Vec3f> GlBlocks::box_corners_of(std::span<const ShownRange> shown,
                                            const Vec3d& origin) const {
  std::vector<Vec3f> corners;
  for (const ShownRange& range : shown) {
    const GlScene* scene = find(*range.block);
    if (scene == nullptr || scene->box().empty) continue;
    for (int i = 0; i < 8; ++i) {
      const Vec3d corner = corner_of(scene->box(), i) - origin;
      corners.push_back({float(corner.x), float(corner.y), float(corner.z)});
    }
  }
  return corners;
}

Result<DrawCount> GlBlocks::draw(ProgramCache& programs, const DrawPass& pass,
                                 const DrawStyle& style, std::span<const ShownRange> shown,
                                 const ColorOfBlock& color_of_block) const {
  DrawCount count;
  DrawStyle of_block = style;
  const auto is_in_view = [&](const ShownRange& range) {
    const GlScene* scene = find(*range.block);
    return scene != nullptr && !scene->box().empty && !is_beside(pass.view, scene->box());
  };
  std::vector<ShownRange> in_view;
  for (const ShownRange& range : shown) {
    if (!is_in_view(range)) continue;
    const Vec3d origin = range.block->draw_list().origin;
    const std::vector<ShownRange> groups = shown_groups({&range, 1}, [&](const BlockGroup& group) {
      Box box;
      for (const Vec3f& p : {group.low, group.high}) box.add(origin + Vec3d{p.x, p.y, p.z});
      return !is_beside(pass.view, box);
    });
    in_view.insert(in_view.end(), groups.begin(), groups.end());
  }
  for (const ShownRange& range : in_view) {
    const GlScene* scene = find(*range.block);
    if (color_of_block) of_block.surface = color_of_block(*range.block);
    const DrawRanges ranges{range.sn, range.fn, range.nsn};
    const Status drawn = scene->draw(programs, pass, of_block, ranges);
    if (!drawn.ok()) return drawn.failure();
    count.calls += (range.sn.count > 0) + (range.fn.count > 0) + (range.nsn.count > 0);
    count.triangles += range.triangle_count();
  }
  return count;
}

}  // namespace crease
