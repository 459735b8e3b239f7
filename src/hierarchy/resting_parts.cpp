#include "hierarchy/resting_parts.h"

#include "crease/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace crease {

std::vector<std::uint32_t> only_contacts(const std::vector<PartBox>& boxes) {
  constexpr std::size_t kMostPairs = 200'000;
  constexpr double kNear = 0.01;
  std::vector<std::uint32_t> only(boxes.size(), kNone);
  std::vector<int> contacts(boxes.size(), 0);
  std::vector<double> reach(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    reach[i] = boxes[i].low.x <= boxes[i].high.x ? length(boxes[i].half()) : 0;
  }
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].low.x < boxes[b].low.x;
  });
  const auto touch = [&](std::uint32_t a, std::uint32_t b) {
    const double near = kNear * std::min(reach[a], reach[b]);
    for (int i = 0; i < 3; ++i) {
      if (boxes[a].low[i] > boxes[b].high[i] + near || boxes[b].low[i] > boxes[a].high[i] + near) {
        return false;
      }
    }
    return true;
  };
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t a = order[i];
    const double end = boxes[a].high.x + kNear * reach[a];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].low.x <= end; ++j) {
      const std::uint32_t b = order[j];
      if (++pairs > kMostPairs) return std::vector<std::uint32_t>(boxes.size(), kNone);
      if ((contacts[a] > 1 && contacts[b] > 1) || !touch(a, b)) continue;
      only[a] = ++contacts[a] == 1 ? b : kNone;
      only[b] = ++contacts[b] == 1 ? a : kNone;
    }
  }
  return only;
}

}  // namespace crease
