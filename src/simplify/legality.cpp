// What a contraction does to the triangles around it: folds, coincidences, and flat triangles that
// turn away from the normal they show. Each is a cost, not a ban: at detail scale it keeps such a
// contraction from being chosen while there is another, and as the bands grow nothing gets stuck.
#include "simplify/patch_simplifier.h"

#include <cmath>
#include <limits>

namespace crease::simplification {

namespace {

// A triangle that turns by more than this has folded over.
constexpr double kFoldCosine = 0.2;

// How much a geometric normal that leaves the shown one counts beside a shown one that leaves the
// input's.
constexpr double kTurnShare = 0.25;

double squared(const Vec3d& v) {
  return dot(v, v);
}

}  // namespace

// The shading error of a flat triangle with the geometric unit normal `normal` (DESIGN 10): against
// the mean normal of the input that it stands for, with the better of stored and derived.
double PatchSimplifier::flat_cost(Index t, const Vec3d& normal, double area) const {
  const Vec3d input = normalized(represented_[t]);
  const double derived_error = squared(normal - input);
  if (derived_[t]) return area * derived_error;
  std::size_t l = 0;
  while (!work_->layers[l].is_normal) ++l;
  const Wedge& wedge = wedges_[l][wedge_of_corner_[l][3 * t]];
  const Vec3d stored{wedge.value[0], wedge.value[1], wedge.value[2]};
  const double stored_error = squared(stored - input) + kTurnShare * squared(normal - stored);
  return area * std::min(stored_error, derived_error);
}

double PatchSimplifier::fold_cost(Index moved, Index other, const Vec3d& target,
                                  double& vanished_area, std::size_t& survivors) {
  double cost = 0;
  const double step2 = squared(vertices_[other].position - vertices_[moved].position);
  for (Index t : triangles_of(moved)) {
    const Vec3d before = normal_of(t);
    const double twice_before = length(before);
    if (corner_of(t, other) >= 0) {
      vanished_area += 0.25 * twice_before;  // seen from both ends
      continue;
    }
    ++survivors;
    const Vec3d after = normal_if_moved(t, moved, target);
    const double twice_after = length(after);
    if (dot(before, after) < kFoldCosine * twice_before * twice_after) {
      cost += step2 * 0.5 * (twice_before + twice_after);
    }
    if (!represented_.empty() && (flat_[t] || derived_[t]) && twice_after > 0) {
      const double now = flat_cost(t, after * (1 / twice_after), 0.5 * twice_after);
      const double was =
          twice_before > 0 ? flat_cost(t, before * (1 / twice_before), 0.5 * twice_before) : 0;
      const double scale = steering_.normal_scale * steering_.normal_scale;
      cost += scale * std::max(0.0, now - was);
    }
  }
  return cost;
}

// Vertices joined to both ends without a triangle over the pair: afterwards two sheets share an
// edge there, or two triangles coincide.
double PatchSimplifier::coincidence_cost(Index a, Index b) {
  const Index beside_a = ++mark_now_, told = ++mark_now_;
  std::size_t shared = 0;
  for (Index t : triangles_of(a)) {
    for (Index c = 0; c < 3; ++c) mark_[vertex_of_corner_[3 * t + c]] = beside_a;
  }
  for (Index t : triangles_of(a)) {
    if (corner_of(t, b) < 0) continue;
    for (Index c = 0; c < 3; ++c) mark_[vertex_of_corner_[3 * t + c]] = told;
  }
  for (Index t : triangles_of(b)) {
    for (Index c = 0; c < 3; ++c) {
      const Index v = vertex_of_corner_[3 * t + c];
      if (v == a || v == b || mark_[v] != beside_a) continue;
      mark_[v] = told;
      ++shared;
    }
  }
  if (shared == 0) return 0;
  const double step2 = squared(vertices_[b].position - vertices_[a].position);
  return static_cast<double>(shared) * step2 * (surface_[a].weight + surface_[b].weight) / 3;
}

double PatchSimplifier::ring_cost(Index a, Index b, const Vec3d& target) {
  double vanished_area = 0;
  std::size_t survivors = 0;
  double cost = fold_cost(a, b, target, vanished_area, survivors);
  cost += fold_cost(b, a, target, vanished_area, survivors);
  if (survivors == 0) {
    // A part disappears. Its own planes may not mind; whoever looks at it does.
    std::size_t vanishing = 0;
    for (Index t : triangles_of(a)) vanishing += corner_of(t, b) >= 0;
    if (steering_.keep_one_triangle && vanishing >= live_triangles_) {
      return std::numeric_limits<double>::infinity();
    }
    cost += vanished_area * squared(vertices_[b].position - vertices_[a].position);
  }
  return cost + coincidence_cost(a, b);
}

}  // namespace crease::simplification
