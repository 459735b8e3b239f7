// What a frame leaves, beside the criteria evaluated afresh: every active vertex, in doubles and by
// angles, without dates, squares or lanes.
#include "runtime/refiner.h"

#include "hierarchy/grid_sum.h"
#include "pipeline/hierarchy_case.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

namespace crease {
namespace {

constexpr double kRounding = 1e-4;  // of lengths of the model, and of angles

double weight_of(const ViewParameters& view, const SplitBounds& bounds, const Vec3d& to,
                 double leeway) {
  if (bounds.cone_angle >= 128) return view.silhouette_weight;
  const double distance = length(to);
  const NormalCone cone = bounds.cone();
  const double radius = double(bounds.radius.value());
  if (radius >= distance) return view.silhouette_weight;
  const double spread = double(cone.half_angle_rad) + std::asin(radius / distance) + leeway;
  if (spread >= kPi / 2) return view.silhouette_weight;
  const Vec3d axis{double(cone.axis.x), double(cone.axis.y), double(cone.axis.z)};
  const double facing = dot(axis, to) / distance;
  if (facing > std::sin(spread)) return view.coarse_backfaces ? 0 : 1;
  return facing < -std::sin(spread) ? 1 : view.silhouette_weight;
}

// 1: just what is allowed. With a positive `leeway` at least what it is, with a negative one at
// most.
double excess(const ViewParameters& view, const Grid& grid, const SplitBounds& bounds,
              const Vec3i& at, double leeway) {
  const Camera& camera = view.camera;
  const Vec3d position = Vec3d{double(at.x), double(at.y), double(at.z)} * grid.step + grid.origin;
  const Vec3d to = position - camera.position;
  const double radius = double(bounds.radius.value());
  if (view.coarse_outside) {
    const double half = std::tan(radians(camera.vertical_fov_deg) / 2);
    const double wide = half * camera.width_px / camera.height_px;
    const Vec3d forward = normalized(camera.target - camera.position);
    const Vec3d right = normalized(cross(forward, camera.up));
    const Vec3d up = cross(right, forward);
    for (const Vec3d& inwards : {forward, forward * wide + right, forward * wide - right,
                                 forward * half + up, forward * half - up}) {
      if (dot(normalized(inwards), to) + radius + leeway < 0) return 0;
    }
  }
  const double half = std::tan(radians(camera.vertical_fov_deg) / 2);
  const double pixels_per_radian = camera.height_px / (2 * half);
  const double nearest = std::max(length(to) - radius - leeway, 1e-20);
  const LevelError error = bounds.error();
  double most = double(std::max(error.surface, error.line)) * pixels_per_radian / camera.pixels;
  most = std::min(most / nearest, 1e30);
  if (view.degrees > 0) {
    const double pixels = 2 * radius * pixels_per_radian / nearest;
    most = std::max(most, double(error.degrees) / view.degrees * std::min(1.0, pixels / 16));
  }
  if (!view.coarse_backfaces && view.silhouette_weight == 1) return most;
  const double one = weight_of(view, bounds, to, kRounding);
  const double other = weight_of(view, bounds, to, -kRounding);
  const double third = weight_of(view, bounds, to, 0);
  return most * (leeway > 0 ? std::max({one, other, third}) : std::min({one, other, third}));
}

// Nothing is wrong that could be split, and nothing is right that could be merged.
void check_settled(const ActiveCut& cut, const ViewParameters& view, double size) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const double leeway = kRounding * size;
  for (const ActiveVertex& v : cut.vertices()) {
    if (v.node == kNoNode) continue;
    if (v.split != kNoSplit) {
      const SplitBounds& bounds = h.bounds[index_of(v.split)];
      REQUIRE(excess(view, h.grid, bounds, v.position, -leeway) <= 1 + kRounding);
    }
    if (h.is_root(v.node) || !cut.can_merge(h.split_above(v.node))) continue;
    const SplitBounds& bounds = h.bounds[index_of(h.split_above(v.node))];
    const Vec3i position = grid_difference(v.position, h.delta_of(v.node));
    REQUIRE(excess(view, h.grid, bounds, position, leeway) >= (1 - kRounding) / view.hysteresis);
  }
}

// Along a curve whose speed changes from frame to frame by powers of ten, with stops.
void check_flight(const HierarchyCase& c, ViewParameters view, int frames, std::uint64_t seed) {
  ActiveCut cut(c.hierarchy);
  Refiner refiner;
  const Grid& grid = c.hierarchy.vertices.grid;
  double size = 2000 * grid.step;
  for (const SplitBounds& b : c.hierarchy.vertices.bounds) {
    size = std::max(size, double(b.radius.value()));
  }
  std::mt19937_64 random(seed);
  double a = double(seed);
  for (int f = 0; f < frames; ++f) {
    CAPTURE(f);
    const Vec3d around{std::cos(a), std::sin(1.3 * a), 0.6 * std::sin(0.7 * a)};
    view.camera.position = grid.origin + around * (size * (1.2 + 0.9 * std::sin(2.1 * a)));
    view.camera.target =
        grid.origin + Vec3d{std::sin(3 * a), std::cos(2 * a), std::sin(a)} * (0.6 * size);
    view.camera.up = {0.2 * std::sin(a), 0.1, 1};
    if (f % 40 == 39) view.camera.pixels *= f % 80 == 39 ? 0.5 : 2;
    refiner.update(cut, view);
    check_settled(cut, view, size);
    a += random() % 8 == 0 ? 0 : std::pow(10.0, -double(random() % 5)) * 0.5;
  }
}

TEST_CASE("a frame leaves no vertex that is to be split, and no pair that is to be merged") {
  std::uint64_t seed = 0;
  for (const Mesh& mesh : {torus(16, 24), city_blocks(3, 2), smooth_sphere(16, 24)}) {
    const HierarchyCase c = simplified_case(mesh);
    for (const double hysteresis : {1.0, 1.25}) {
      for (int kind = 0; kind < 6; ++kind) {
        CAPTURE(kind);
        ViewParameters view;
        view.camera.width_px = 640, view.camera.height_px = 480;
        view.camera.pixels = 2;
        view.hysteresis = hysteresis;
        view.coarse_outside = kind != 1;
        view.degrees = kind == 2 || kind == 5 ? 4 : 0;
        view.coarse_backfaces = kind == 3 || kind == 5;
        view.silhouette_weight = kind == 4 || kind == 5 ? 3 : 1;
        check_flight(c, view, kSanitized ? 40 : 200, ++seed);
      }
    }
  }
}

}  // namespace
}  // namespace crease
