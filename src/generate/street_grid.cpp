#include "generate/street_grid.h"

#include "generate/random.h"

#include <algorithm>

namespace crease {

namespace {

constexpr double kStreet = 9, kCentreStreet = 12, kAvenue = 18, kQuayRoad = 8, kRiver = 34;

// Even metres, so that middles are whole.
double even(Random& random, int low, int high) {
  return 2.0 * random.between(low / 2, high / 2);
}

// `centre`: the length of each of the three blocks in the middle. `outer`: for blocks beyond the
// inner ones.
StreetAxis make_axis(int last, Random random, Random outer, double centre, int least, int most,
                     bool river) {
  // Avenues are four blocks apart; the first ones bound the middle.
  const auto avenue_before = [](int k) { return k % 4 == 2; };
  StreetAxis axis;
  axis.last = last;
  std::vector<StreetAxis::Block> below;
  for (int direction : {-1, 1}) {
    double at = centre / 2;
    for (int k = 1; k <= last; ++k) {  // from the middle outwards
      const bool is_river = river && direction < 0 && k == -kRiverAfter;
      at += is_river           ? 2 * kQuayRoad + kRiver
            : avenue_before(k) ? kAvenue
            : k == 1           ? kCentreStreet
                               : kStreet;
      const double length =
          k == 1 ? centre : even(k <= kLastInnerBlock ? random : outer, least, most);
      if (direction < 0) {
        below.push_back({-at - length, -at, avenue_before(k)});
      } else {
        axis.blocks.push_back({at, at + length, avenue_before(k + 1)});
      }
      at += length;
    }
    if (direction > 0) continue;
    axis.blocks.assign(below.rbegin(), below.rend());
    axis.blocks.push_back({-centre / 2, centre / 2, false});
  }
  return axis;
}

}  // namespace

StreetGrid make_street_grid(std::uint64_t seed, int last) {
  StreetGrid grid{make_axis(last, Random(seed, 1), Random(seed, 3), 62, 56, 80, false),
                  make_axis(last, Random(seed, 2), Random(seed, 4), 52, 46, 60, true), 0, 0};
  grid.river_low = grid.y.at(kRiverAfter).high + kQuayRoad;
  grid.river_high = grid.y.at(kRiverAfter + 1).low - kQuayRoad;
  return grid;
}

}  // namespace crease
