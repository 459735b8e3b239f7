// Parts that would float without another one: a spire on its tower, which touches nothing else.
#pragma once

#include "crease/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace crease {

struct PartBox {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Vec3d& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  Vec3d half() const { return (high - low) * 0.5; }
};

// Per part the only other one whose box touches its own, or kNone. Boxes that are a hundredth of
// the smaller one's size apart touch. kNone of all where they are too many to look at, as
// the leaves of a tree are.
std::vector<std::uint32_t> only_contacts(const std::vector<PartBox>& boxes);

}  // namespace crease
