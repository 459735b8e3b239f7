#include "crease/block_view.h"

#include "runtime/block_bounds.h"
#include "runtime/view_error.h"
#include "runtime/view_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease {

namespace {

// Within the block's part, a group lies in the range iff all its triangles do.
bool is_within(const Range& group, const Range& range) {
  return group.first >= range.first && group.first + group.count <= range.first + range.count;
}

void take_group(const BlockGroup& group, const ResidentBlock* block, bool goes_on,
                std::vector<ShownRange>& ranges) {
  if (!goes_on) {
    ranges.push_back({block, group.sn, group.fn, group.nsn});
    return;
  }
  ranges.back().sn.count += group.sn.count;
  ranges.back().fn.count += group.fn.count;
  ranges.back().nsn.count += group.nsn.count;
}

// Five planes through the eye: four sides, and what is behind it.
class ViewPlanes {
 public:
  explicit ViewPlanes(const Camera& camera) : eye_(camera.position) {
    const double high = std::tan(radians(camera.vertical_fov_deg) / 2);
    const double wide = high * camera.width_px / camera.height_px;
    const auto [forward, right, up] = view_frame(camera);
    inward_ = {forward, forward * wide - right, forward * wide + right, forward * high - up,
               forward * high + up};
  }
  // Not all of the box is outside of one of them.
  bool sees(const Vec3d& low, const Vec3d& high) const {
    return std::all_of(inward_.begin(), inward_.end(), [&](const Vec3d& n) {
      const Vec3d farthest{n.x > 0 ? high.x : low.x, n.y > 0 ? high.y : low.y,
                           n.z > 0 ? high.z : low.z};
      return dot(n, farthest - eye_) >= 0;
    });
  }

 private:
  Vec3d eye_;
  std::array<Vec3d, 5> inward_;
};

}  // namespace

std::vector<ShownRange> shown_groups(std::span<const ShownRange> shown,
                                     const std::function<bool(const BlockGroup&)>& is_in) {
  std::vector<ShownRange> result;
  for (const ShownRange& range : shown) {
    bool goes_on = false;
    for (const BlockGroup& group : range.block->groups()) {
      const bool takes = is_within(group.sn, range.sn) && is_within(group.fn, range.fn) &&
                         is_within(group.nsn, range.nsn) && is_in(group);
      if (takes) take_group(group, range.block, goes_on, result);
      goes_on = takes;
    }
  }
  return result;
}

std::vector<ShownRange> shown_groups(const ShownCut& cut,
                                     const std::function<bool(const BlockGroup&)>& is_in) {
  const auto all = [](const DrawPart& part) {
    return Range{0, static_cast<std::uint32_t>(part.triangle_count())};
  };
  if (cut.groups.empty())
    return {{cut.block, all(cut.list.sn), all(cut.list.fn), all(cut.list.nsn)}};
  std::vector<ShownRange> result;
  bool goes_on = false;
  for (const BlockGroup& group : cut.groups) {
    const bool takes = is_in(group);
    if (takes) take_group(group, cut.block, goes_on, result);
    goes_on = takes;
  }
  return result;
}

std::vector<ShownRange> shown_in_view(std::span<const ShownRange> shown, const Vec3d& origin,
                                      const Camera& camera) {
  const ViewPlanes planes(camera);
  const auto place = [&origin](const Vec3f& p) { return origin + Vec3d{p.x, p.y, p.z}; };
  return shown_groups(shown, [&](const BlockGroup& group) {
    return planes.sees(place(group.low), place(group.high));
  });
}

std::vector<ShownRange> shown_in_view(const ShownCut& cut, const Camera& camera) {
  const ViewPlanes planes(camera);
  const auto place = [&cut](const Vec3f& p) { return cut.list.origin + Vec3d{p.x, p.y, p.z}; };
  return shown_groups(cut, [&](const BlockGroup& group) {
    return planes.sees(place(group.low), place(group.high));
  });
}

bool needs_block(const BlockFacts& block, const Grid& grid, const ViewParameters& view) {
  const BlockBounds own = bounds_of(block, grid);
  return ViewError(view, grid).of(own.bounds, own.center) > 1;
}

}  // namespace crease
