// Small parts stay whole or go: a house without a wall is worse to look at than none.
//
// A connected part that is down to few triangles has none to spare. A contraction that costs a good
// share of what is lost if the part vanishes breaks it, so that one waits until the part's
// triangles are worth more elsewhere; then all the rest goes as well, one after the other. The
// simplifier decides so, and so does who puts the contractions of a file in order.
#pragma once

#include "crease/vec.h"

#include <algorithm>
#include <cstddef>

namespace crease {

// A box has 12 triangles, a prism 8. With more of them, up to three times as many, only what costs
// more breaks a part, by the third power.
inline constexpr double kSmallPart = 12, kLargePart = 36;
inline constexpr double kBreakingShare = 0.15;  // of the price of one of its contractions

// What is lost if a part vanishes, as quadrics would tell it, which count an area at each of its
// three corners, in area * squared length.
class PartDamage {
 public:
  // A triangle of it.
  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d twice = cross(b - a, c - a);
    const double share = length(twice) / 6;
    area_ += 3 * share;
    sum_ = sum_ + (a + b + c) * share;
    squares_ += (dot(a, a) + dot(b, b) + dot(c, c)) * share;
    turned_ = turned_ + twice * 0.5;
  }

  // Its squared distances from its own middle, by area, as if all that is left were about so far
  // away.
  double distances() const {
    return area_ > 0 ? kCorners * std::max(0.0, squares_ - dot(sum_, sum_) / area_) : 0;
  }

  // And its shading, as if it were that of its mean normal. `radian`: what one that a normal is off
  // is worth beside a distance. Where all else is larger, so that shading is dear, a part would
  // cost less than to make it simpler if it were not counted here.
  double all(double radian) const {
    if (!(area_ > 0)) return 0;
    const double normals = std::max(0.0, area_ - dot(turned_, turned_) / area_);
    return distances() + kCorners * normals * radian * radian;
  }

 private:
  // Three, and three times as much for what stood there alone: nothing around makes up for it.
  static constexpr double kCorners = 9;
  double area_ = 0, squares_ = 0;
  Vec3d sum_, turned_;
};

// What each contraction of a part should cost of which so many triangles are left: two go with it.
// `damage`: of all that is lost.
inline double price_of_part(double damage, std::size_t triangles) {
  return damage / (0.5 * double(triangles));
}

// What would float without a part goes before it: the part costs so many times as much as that.
inline constexpr double kAfter = 1.01;

// Whether a contraction inside it that costs so much breaks it. `damage`: of distances alone, since
// to make slivers of it takes nothing from its shading; 0 of a part that may not go as a whole.
inline bool breaks_part(double cost, double damage, std::size_t triangles) {
  if (!(damage > 0) || double(triangles) > kLargePart) return false;
  const double over = std::max(1.0, double(triangles) / kSmallPart);
  return cost >= kBreakingShare * over * over * over * price_of_part(damage, triangles);
}

}  // namespace crease
