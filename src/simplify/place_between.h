// The best of the places between two ends that a file keeps for few bits: see hierarchy/between.h.
#pragma once

#include "crease/vec.h"
#include "hierarchy/quadric.h"

namespace crease::simplification {

struct PlaceBetween {
  Vec3d position;
  double cost = 0;  // by `sum`
};

// Ends on the grid. `cost_at_a`: sum.at(a). `pull`: see Quadric::minimum.
PlaceBetween place_between(const Quadric& sum, const Vec3d& a, const Vec3d& b, double cost_at_a,
                           double pull);

}  // namespace crease::simplification
