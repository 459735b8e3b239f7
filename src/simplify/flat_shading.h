// What showing a normal costs where the input had others: see flat_shading.cpp.
#pragma once

#include "simplify/work_mesh.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

// A flat triangle shows its geometric normal from where that is nearer to the input by this much
// (squared chord of about two degrees).
inline constexpr double kDeriveMargin = 1.2e-3;

// A wrong normal counts in proportion to its chord up to this one, and to the chord's square
// beyond. Squares alone make small errors all but free, so that they spread over whole facades.
inline constexpr double kLinearChord = 0.8;

// Rounding to the grid turns triangles by about this chord.
inline constexpr double kRoundingChord = 1.5e-4;

// Area times squared chord between the input normals and `shown`.
inline double error_of(const Represented& input, const Vec3d& shown) {
  return std::max(0.0, 2 * (double(input.area) - dot(to_double(input.sum), shown)));
}

// What showing a normal off by this squared chord counts, by area.
inline double weighed(double chord2) {
  return chord2 * std::max(1.0, kLinearChord / (std::sqrt(chord2) + kRoundingChord));
}
inline double weighed_error_of(const Represented& input, double error) {
  return error > 0 ? double(input.area) * weighed(error / double(input.area)) : 0;
}

// Whether the geometric normal is to be shown instead of the stored one.
inline bool is_better_derived(const Represented& input, double derived, double stored) {
  return derived + kDeriveMargin * double(input.area) < stored;
}

// Of a flat or derived triangle.
struct FlatShading {
  Represented input;
  Vec3f stored;              // the stored normal, which it shows unless it is derived
  Vec3f faced;               // where it faces while it is right: its opposite, if it is inside out
  bool derived = false;      // shows its geometric normal
  double stored_error = 0;   // of showing the stored normal
  double stored_counts = 0;  // what that counts
  double counts = 0;         // what it counts as it is: counts_with() its own normal and area

  // After `input` or `stored` has changed.
  void know_stored_error() {
    stored_error = error_of(input, to_double(stored));
    stored_counts = weighed_error_of(input, stored_error);
  }

  // What the normal counts that will be shown with the geometric unit normal `normal`. A triangle
  // that turns away from the normal it goes on showing is as wrong as one that shows a wrong
  // normal, as far as it stands for input; one that faces away is wrong all over, so that a sliver
  // with a normal of its own does not swell.
  double counts_with(const Vec3d& normal, double area) const {
    const double geometric_error = error_of(input, normal);
    if (derived || is_better_derived(input, geometric_error, stored_error)) {
      return weighed_error_of(input, geometric_error);
    }
    const Vec3d turn = normal - to_double(faced);
    const double turn2 = dot(turn, turn);
    const double turned = turn2 > 2 ? area : std::min(area, double(input.area));
    return stored_counts + turned * weighed(turn2);
  }
};

}  // namespace crease::simplification
