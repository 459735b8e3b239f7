// How much area changes hands between categories in a contraction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease::simplification {

class AreaChanges {
 public:
  void clear() { changes_.clear(); }
  void add(std::uint32_t category, double area) {
    for (auto& [other, sum] : changes_) {
      if (other != category) continue;
      sum += area;
      return;
    }
    changes_.emplace_back(category, area);
  }
  // What some gained is what others lost; area that only appears or vanishes is neither.
  double exchanged() const {
    double gained = 0, lost = 0;
    for (const auto& [category, area] : changes_) (area > 0 ? gained : lost) += area;
    return std::min(gained, -lost);
  }

 private:
  std::vector<std::pair<std::uint32_t, double>> changes_;  // a few
};

}  // namespace crease::simplification
