// What is due.
#include "runtime/refiner.h"

#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crease {

namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// How far all of what the camera sees turns at most: its direction, and the picture around it.
double turn_between(const Camera& a, const Camera& b) {
  const Vec3d forward_a = normalized(a.target - a.position);
  const Vec3d forward_b = normalized(b.target - b.position);
  const Vec3d right_a = normalized(cross(forward_a, a.up));
  const Vec3d right_b = normalized(cross(forward_b, b.up));
  return angle_between(forward_a, forward_b) + angle_between(right_a, right_b);
}

}  // namespace

void Refiner::look_from(const ActiveCut& cut, const ViewParameters& view) {
  ViewParameters moved = view_;
  moved.camera.position = view.camera.position;
  moved.camera.target = view.camera.target;
  moved.camera.up = view.camera.up;
  moved.clock = view.clock;
  moved.clock_context = view.clock_context;
  moved.max_seconds = view.max_seconds;
  const VertexHierarchy& h = cut.hierarchy().vertices;
  if (has_view_ && moved == view) {
    const double travelled = length(view.camera.position - view_.camera.position);
    const double turned = turn_between(view.camera, view_.camera);
    travelled_ += travelled;
    swung_ += std::max(travelled, turned / radians_per_length_);
  } else {
    travelled_ = swung_ = 0;
    due_.assign(cut.vertices().size(), {0, 0});
    double size = 0;
    for (const Vec3i& p : h.root_positions) {
      size = std::max(size, h.grid.step * length(Vec3d{double(p.x), double(p.y), double(p.z)}));
    }
    for (const SplitBounds& b :
         std::span(h.bounds).first(std::min<std::size_t>(1, h.bounds.size()))) {
      size = std::max(size, double(b.radius.value()));
    }
    radians_per_length_ = 4 / std::max(size, 1e-30);
  }
  has_view_ = true;
  view_ = view;
  error_ = ViewError(view, h.grid);
  merge_below_ = static_cast<float>(1 / std::max(view.hysteresis, 1.0));
  splits_.clear();
  merges_.clear();
  counts_all_merges_ = false;
}

void Refiner::evaluate_due(const ActiveCut& cut) {
  const auto travelled = static_cast<float>(travelled_), swung = static_cast<float>(swung_);
  if (due_.size() < cut.vertices().size()) due_.resize(cut.vertices().size(), {0, 0});
  for (std::uint32_t slot = 0; slot < due_.size(); ++slot) {
    if (due_[slot].travel > travelled && due_[slot].swing > swung) continue;
    if (cut.vertices()[slot].node == kNoNode) {
      due_[slot] = {kNever, kNever};
    } else {
      evaluate(cut, slot);
    }
  }
}

void Refiner::evaluate(const ActiveCut& cut, std::uint32_t slot) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const ActiveVertex& v = cut.vertices()[slot];
  Dates due{kNever, kNever};
  if (v.split != kNoSplit) due = evaluate_split(cut, v, slot);
  if (!h.is_root(v.node)) {
    const Dates merge = evaluate_merge(cut, v, h.split_above(v.node));
    due = {std::min(due.travel, merge.travel), std::min(due.swing, merge.swing)};
  }
  due_[slot] = due;
}

Refiner::Dates Refiner::evaluate_split(const ActiveCut& cut, const ActiveVertex& v,
                                       std::uint32_t slot) {
  ++report_.evaluated;
  const SplitBounds& bounds = cut.hierarchy().vertices.bounds[index_of(v.split)];
  const ViewError::Sight sight = error_.see(bounds, error_.position(v.position), 1);
  if (sight.excess > 1) {
    splits_.push_back({sight.excess, v.split, slot});
    std::push_heap(splits_.begin(), splits_.end(),
                   [](const Wish& a, const Wish& b) { return a.excess < b.excess; });
    return {0, 0};
  }
  return dates_of(sight);
}

Refiner::Dates Refiner::evaluate_merge(const ActiveCut& cut, const ActiveVertex& v, SplitId above) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  if (!cut.can_merge(above)) return {kNever, kNever};  // it is looked at again when it can
  // Of two that can merge it is v_t that watches.
  if (h.is_second(v.node) && cut.children(above).first != kNoSlot) return {kNever, kNever};
  ++report_.evaluated;
  const SplitBounds& bounds = h.bounds[index_of(above)];
  const Vec3f position = error_.position(grid_difference(v.position, h.delta_of(v.node)));
  const ViewError::Sight sight = error_.see(bounds, position, merge_below_);
  if (sight.excess <= merge_below_ || counts_all_merges_) {
    merges_.push_back({sight.excess, above, kNoSlot});
    std::push_heap(merges_.begin(), merges_.end(),
                   [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
    return {0, 0};
  }
  return dates_of(sight);
}

// A camera that travels x and turns by a moves a point at that distance by x + a * distance at
// most.
Refiner::Dates Refiner::dates_of(const ViewError::Sight& sight) const {
  constexpr float kSafe = 0.999f;  // for rounding
  const float per_swing = 1 + static_cast<float>(radians_per_length_) * sight.distance;
  const auto date = [](double now, float more) {
    return std::nextafter(static_cast<float>(now + static_cast<double>(more)), 0.0f);
  };
  return {date(travelled_, kSafe * sight.travel), date(swung_, kSafe * sight.swing / per_swing)};
}

}  // namespace crease
