// The shading of flat triangles: which input normals each stands for, what showing another costs,
// and when it is better to show the geometric normal than the stored one (DESIGN 10).
//
// A flat triangle keeps its stored normal (DB03 rule b). When a triangle vanishes, the input that
// it stood for is stood for by a neighbour: the heir, whose shown normal is nearest to it. So the
// error of every level is known beside the input, whatever bands came before.
#include "simplify/patch_simplifier.h"

#include <cmath>

namespace crease::simplification {

namespace {

// A flat triangle shows its geometric normal from where that is nearer to the input by this much
// (squared chord of about two degrees).
constexpr double kDeriveMargin = 1.2e-3;

// A wrong normal counts in proportion to its chord up to this one, and to the chord's square
// beyond. Squares alone make small errors all but free, so that they spread over whole facades.
constexpr double kLinearChord = 0.8;

// Rounding to the grid turns triangles by about this chord.
constexpr double kRoundingChord = 1.5e-4;

// How much a normal that nothing shows any more counts. In full it would make the last contractions
// of a small feature dearer than the ruin of a large one.
constexpr double kVanishShare = 0.1;

double squared(double x) {
  return x * x;
}

double squared(const Vec3d& v) {
  return dot(v, v);
}

Vec3d to_double(const Vec3f& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

// Area times squared chord between the input normals and `shown`.
double error_of(const Represented& input, const Vec3d& shown) {
  return std::max(0.0, 2 * (double(input.area) - dot(to_double(input.sum), shown)));
}

// What showing a normal off by this squared chord counts, by area.
double weighed(double chord2) {
  return chord2 * std::max(1.0, kLinearChord / (std::sqrt(chord2) + kRoundingChord));
}
double weighed_error_of(const Represented& input, double error) {
  return error > 0 ? double(input.area) * weighed(error / double(input.area)) : 0;
}

// Whether the geometric normal is to be shown instead of the stored one.
bool is_better_derived(const Represented& input, double derived, double stored) {
  return derived + kDeriveMargin * double(input.area) < stored;
}

}  // namespace

void PatchSimplifier::load_represented() {
  represented_.clear();
  if (work_->represented.empty()) {
    for (Vertex& vertex : vertices_) vertex.flat_around = false;
    return;
  }
  normal_layer_ = 0;
  while (!work_->layers[normal_layer_].is_normal) ++normal_layer_;
  represented_.resize(global_triangle_.size());
  flat_error_.assign(global_triangle_.size(), 0);
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    represented_[t] = work_->represented[global_triangle_[t]];
    if (flat_[t] || derived_[t]) {
      flat_error_[t] = flat_error(t, facing_[t].normal, facing_[t].area);
    } else {
      for (Index c = 0; c < 3; ++c) vertices_[vertex_of_corner_[3 * t + c]].flat_around = false;
    }
  }
}

// A corner at height h over its triangle's opposite side, moved by d off the plane, turns the
// triangle by about d / h: area * (d / h)^2 is a plane quadric, with which a pair's cost and place
// know about what turning costs; legality.cpp knows it exactly, but only for one place at a time.
// Thin triangles turn at a touch, and there is no more to lose than their area: where d is four
// times what the band allows it costs that.
void PatchSimplifier::load_turns() {
  turn_.clear();
  if (represented_.empty()) return;
  turn_.assign(vertices_.size(), Quadric{});
  const double normal_scale2 = squared(steering_.normal_scale);
  const double turn_distance2 = squared(steering_.turn_distance);
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    if (!(flat_[t] || derived_[t]) || !(facing_[t].area > 0)) continue;
    const Index* v = &vertex_of_corner_[3 * t];
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
Vec3d PatchSimplifier::shown_normal(Index t) const {
  if (!flat_[t]) return facing_[t].normal;
  const Wedge& wedge = wedges_[normal_layer_][wedge_of_corner_[normal_layer_][3 * t]];
  return {double(wedge.value[0]), double(wedge.value[1]), double(wedge.value[2])};
}

// What the normal counts that will be shown with the geometric unit normal `normal`. A triangle
// that turns away from the normal it goes on showing is as wrong as one that shows a wrong normal,
// as far as it stands for input; one that faces away is wrong all over, so that a sliver with a
// normal of its own does not swell.
double PatchSimplifier::flat_error(Index t, const Vec3d& normal, double area) const {
  const Represented& input = represented_[t];
  const double derived = error_of(input, normal);
  if (derived_[t]) return weighed_error_of(input, derived);
  const Vec3d shown = shown_normal(t);
  const double stored = error_of(input, shown);
  if (is_better_derived(input, derived, stored)) return weighed_error_of(input, derived);
  const double turn2 = squared(normal - shown);
  const double turned = turn2 > 2 ? area : std::min(area, double(input.area));
  return weighed_error_of(input, stored) + turned * weighed(turn2);
}

// Among the surviving triangles that touch the vanishing one's third vertex; see find_ring(). Of
// the vanishing triangle's other vertices, the ring's triangles have the contracted pair alone.
PatchSimplifier::Index PatchSimplifier::heir_of(Index vanishing) const {
  const Vec3d share = to_double(represented_[vanishing].sum);
  const Index* ends = &vertex_of_corner_[3 * vanishing];
  Index best = kNone;
  double best_agreement = 0;
  for (Index corner : ring_corners_) {
    const Index u = corner / 3;
    const Index* v = &vertex_of_corner_[3 * u];
    const Index moved = corner - 3 * u;
    const Index w1 = v[moved == 2 ? 0 : moved + 1], w2 = v[moved == 0 ? 2 : moved - 1];
    const bool touches = w1 == ends[0] || w1 == ends[1] || w1 == ends[2] || w2 == ends[0] ||
                         w2 == ends[1] || w2 == ends[2];
    if (!touches) continue;
    const double agreement = dot(shown_normal(u), share);
    if (best != kNone && agreement <= best_agreement) continue;
    best = u;
    best_agreement = agreement;
  }
  return best;
}

// What it costs that a flat triangle vanishes.
double PatchSimplifier::vanishing_error(Index t) const {
  if (!flat_[t] && !derived_[t]) return 0;
  const Index heir = heir_of(t);
  const Vec3d shown = heir == kNone ? Vec3d{} : shown_normal(heir);
  return kVanishShare * std::max(0.0, error_of(represented_[t], shown) - flat_error_[t]);
}

void PatchSimplifier::hand_over_represented() {
  for (Index t : vanishing_) {
    const Index heir = heir_of(t);
    if (heir == kNone) continue;
    Represented& to = represented_[heir];
    to.sum += represented_[t].sum;
    to.area += represented_[t].area;
  }
}

void PatchSimplifier::derive_where_better(Index kept, LevelError& error) {
  double worst_square = 0;  // of the chords between what is shown and the input
  for (Index t : triangles_of(kept)) {
    if (!flat_[t] && !derived_[t]) continue;
    if (!(facing_[t].area > 0)) continue;
    const Vec3d geometric = facing_[t].normal;
    const Represented& input = represented_[t];
    if (flat_[t] &&
        is_better_derived(input, error_of(input, geometric), error_of(input, shown_normal(t)))) {
      flat_[t] = 0;
      derived_[t] = 1;
      result_.derived.push_back(TriangleId{global_triangle_[t]});
    }
    flat_error_[t] = flat_error(t, geometric, facing_[t].area);
    const double shown = error_of(input, derived_[t] ? geometric : shown_normal(t));
    if (input.area > 0) worst_square = std::max(worst_square, shown / double(input.area));
  }
  const double half_chord = std::min(1.0, 0.5 * std::sqrt(worst_square));
  error.degrees = std::max(error.degrees, static_cast<float>(degrees(2 * std::asin(half_chord))));
}

}  // namespace crease::simplification
