// What is due.
#include "runtime/refiner.h"

#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crease {

namespace {

// Shares of the distance to a vertex by which the camera may move; the largest that holds is taken.
constexpr float kLeeways[] = {0.5f, 0.12f, 0.03f};

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
    // Even a camera that comes back lets the queues be filled anew.
    odometer_ += std::max(travelled, turned / radians_per_length_) + 1e-30;
  } else {
    odometer_ = 0;
    due_.assign(cut.vertices().size(), 0);
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
  const auto now = static_cast<float>(odometer_);
  if (due_.size() < cut.vertices().size()) due_.resize(cut.vertices().size(), 0);
  for (std::uint32_t slot = 0; slot < due_.size(); ++slot) {
    if (due_[slot] <= now && cut.vertices()[slot].node != kNoNode) evaluate(cut, slot);
  }
}

void Refiner::evaluate(const ActiveCut& cut, std::uint32_t slot) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const ActiveVertex& v = cut.vertices()[slot];
  float turn = std::numeric_limits<float>::infinity();
  if (v.split != kNoSplit) turn = evaluate_split(cut, v, slot);
  if (!h.is_root(v.node)) turn = std::min(turn, evaluate_merge(cut, v, h.split_above(v.node)));
  // Rounded down, so that it is not late.
  due_[slot] = std::nextafter(static_cast<float>(odometer_ + static_cast<double>(turn)), 0.0f);
}

// Each returns how far the odometer may turn before the answer can change.
float Refiner::evaluate_split(const ActiveCut& cut, const ActiveVertex& v, std::uint32_t slot) {
  ++report_.evaluated;
  const SplitBounds& bounds = cut.hierarchy().vertices.bounds[index_of(v.split)];
  const Vec3f position = error_.position(v.position);
  const float excess = error_.of(bounds, position);
  if (excess > 1) {
    splits_.push_back({excess, v.split, slot});
    std::push_heap(splits_.begin(), splits_.end(),
                   [](const Wish& a, const Wish& b) { return a.excess < b.excess; });
    return 0;
  }
  const float distance = error_.distance(position);
  for (const float share : kLeeways) {
    if (error_.of(bounds, position, share * distance) <= 1) return turn_for(share, distance);
  }
  return 0;
}

float Refiner::evaluate_merge(const ActiveCut& cut, const ActiveVertex& v, SplitId above) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const VertexHierarchy& h = cut.hierarchy().vertices;
  if (!cut.can_merge(above)) return kNever;  // it is looked at again when it can
  if (h.is_second(v.node) && cut.children(above).first != kNoSlot) return kNever;  // v_t's matter
  ++report_.evaluated;
  const SplitBounds& bounds = h.bounds[index_of(above)];
  const Vec3f position = error_.position(grid_difference(v.position, h.delta_of(v.node)));
  const float excess = error_.of(bounds, position);
  if (excess < merge_below_ || counts_all_merges_) {
    merges_.push_back({excess, above, kNoSlot});
    std::push_heap(merges_.begin(), merges_.end(),
                   [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
    return 0;
  }
  const float distance = error_.distance(position);
  for (const float share : kLeeways) {
    if (error_.of(bounds, position, -share * distance) >= merge_below_) {
      return turn_for(share, distance);
    }
  }
  return 0;
}

// A camera that travels x and turns by a moves a point at that distance by x + a * distance at
// most.
float Refiner::turn_for(float share, float distance) const {
  return share * distance / (1 + 1.01f * static_cast<float>(radians_per_length_) * distance);
}

}  // namespace crease
