// The shading of flat triangles: which input normals each stands for, what showing another costs,
// and when it is better to show the geometric normal than the stored one.
//
// A flat triangle keeps its stored normal (DB03 rule b). When a triangle vanishes, the input that
// it stood for is stood for by a neighbour: the heir, whose shown normal is nearest to it. So the
// error of every level is known beside the input, whatever bands came before.
#include "simplify/patch_simplifier.h"

#include <cmath>

namespace crease::simplification {

namespace {

// How much a normal that nothing shows any more counts. In full it would make the last contractions
// of a small feature dearer than the ruin of a large one.
constexpr double kVanishShare = 0.1;

double squared(double x) {
  return x * x;
}

double squared(const Vec3d& v) {
  return dot(v, v);
}

}  // namespace

void PatchSimplifier::load_shading() {
  shading_.clear();
  if (work_->represented.empty()) {
    for (Vertex& vertex : vertices_) vertex.flat_around = false;
    return;
  }
  std::size_t normal_layer = 0;
  while (!work_->layers[normal_layer].is_normal) ++normal_layer;
  clear_for(shading_, global_triangle_.size());
  shading_.resize(global_triangle_.size());
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    FlatShading& shading = shading_[t];
    shading.input = work_->represented[global_triangle_[t]];
    shading.derived = derived_[t];
    if (flat_[t] || derived_[t]) {
      const Wedge& wedge = wedges_[normal_layer][wedge_of_corner_[normal_layer][4 * t]];
      shading.stored = {wedge.value[0], wedge.value[1], wedge.value[2]};
      const bool inside_out =
          !work_->inside_out.empty() && work_->inside_out[global_triangle_[t]] != 0;
      shading.faced = inside_out ? shading.stored * -1.0f : shading.stored;
      shading.know_stored_error();
      shading.counts = shading.counts_with(facing_[t].normal, facing_[t].area);
    } else {
      for (Index c = 0; c < 3; ++c) vertices_[vertex_of_corner_[4 * t + c]].flat_around = false;
    }
  }
}

// A corner at height h over its triangle's opposite side, moved by d off the plane, turns the
// triangle by about d / h: area * (d / h)^2 is a plane quadric, with which a pair's cost and place
// know about what turning costs; legality.cpp knows it exactly, but only for one place at a time.
// Thin triangles turn at a touch, and there is no more to lose than their area: where d is four
// times what the band allows it costs that.
CREASE_WIDE void PatchSimplifier::load_turns() {
  turn_.clear();
  if (shading_.empty()) return;
  clear_for(turn_, vertices_.size());
  turn_.assign(vertices_.size(), Quadric{});
  const double normal_scale2 = squared(steering_.normal_scale);
  const double turn_distance2 = squared(steering_.turn_distance);
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    if (!(flat_[t] || derived_[t]) || !(facing_[t].area > 0)) continue;
    const Index* v = &vertex_of_corner_[4 * t];
    const double offset = -dot(facing_[t].normal, positions_[v[0]]);
    const double area = facing_[t].area;
    for (Index c = 0; c < 3; ++c) {
      const double side2 = squared(positions_[v[(c + 1) % 3]] - positions_[v[(c + 2) % 3]]);
      const double height2 = 4 * area * area / side2;
      turn_[v[c]].add_plane(facing_[t].normal, offset,
                            normal_scale2 * area / (height2 + turn_distance2));
    }
  }
}

// Smooth triangles are taken by their geometry.
inline Vec3d PatchSimplifier::shown_normal(Index t) const {
  return flat_[t] ? to_double(shading_[t].stored) : facing_[t].normal;
}

// Among the surviving triangles that touch the vanishing one's third vertex; see find_ring().
inline PatchSimplifier::Index PatchSimplifier::heir_of(const Vanishing& vanishing) {
  Index* touching = touching_.start(ring_.size() + 1);
  for (const RingTriangle& ring : ring_) {  // two of many: no branch could foretell which
    *touching = ring.triangle;
    touching += (ring.next == vanishing.third) | (ring.previous == vanishing.third);
  }
  touching_.finish(touching);
  const Vec3d share = to_double(shading_[vanishing.triangle].input.sum);
  Index best = kNone;
  double best_agreement = 0;
  for (Index t : touching_) {
    const double agreement = dot(shown_normal(t), share);
    if (best != kNone && agreement <= best_agreement) continue;
    best = t;
    best_agreement = agreement;
  }
  return best;
}

// What it costs that a flat triangle vanishes.
CREASE_WIDE double PatchSimplifier::vanishing_error(const Vanishing& vanishing) {
  const Index t = vanishing.triangle;
  if (!flat_[t] && !derived_[t]) return 0;
  const Index heir = heir_of(vanishing);
  const Vec3d shown = heir == kNone ? Vec3d{} : shown_normal(heir);
  return kVanishShare * std::max(0.0, error_of(shading_[t].input, shown) - shading_[t].counts);
}

CREASE_WIDE void PatchSimplifier::hand_over_represented() {
  for (const Vanishing& vanishing : vanishing_) {
    const Index heir = heir_of(vanishing);
    if (heir == kNone) continue;
    const Represented& from = shading_[vanishing.triangle].input;
    FlatShading& to = shading_[heir];
    to.input.sum += from.sum;
    to.input.area += from.area;
    if (flat_[heir]) to.know_stored_error();
  }
}

CREASE_WIDE void PatchSimplifier::derive_where_better(Index kept, LevelError& error) {
  double worst_square = 0;  // of the chords between what is shown and the input
  for (Index corner : corners_of(kept)) {
    const Index t = triangle_of(corner);
    if (!flat_[t] && !derived_[t]) continue;
    FlatShading& shading = shading_[t];
    if (!(facing_[t].area > 0)) continue;
    const double geometric_error = error_of(shading.input, facing_[t].normal);
    if (flat_[t] && is_better_derived(shading.input, geometric_error, shading.stored_error)) {
      flat_[t] = 0;
      derived_[t] = 1;
      shading.derived = true;
      result_.derived.push_back(TriangleId{global_triangle_[t]});
    }
    shading.counts = shading.counts_with(facing_[t].normal, facing_[t].area);
    const double shown = shading.derived ? geometric_error : shading.stored_error;
    const double area = double(shading.input.area);
    if (area > 0) worst_square = std::max(worst_square, shown / area);
  }
  const double half_chord = std::min(1.0, 0.5 * std::sqrt(worst_square));
  error.degrees = std::max(error.degrees, static_cast<float>(degrees(2 * std::asin(half_chord))));
}

}  // namespace crease::simplification
