#include "simplify/far_area.h"

#include <doctest/doctest.h>

namespace crease::simplification {
namespace {

TEST_CASE("counts know what is at a rank, to a quarter") {
  FarCounts low, high;
  for (int i = 0; i < 90; ++i) low.add(0.1 + 0.001 * i);
  for (int i = 0; i < 10; ++i) high.add(7);
  low.add(high);
  CHECK(low.total() == 100);
  CHECK(low.at_rank(50) <= 0.15);
  CHECK(low.at_rank(50) > 0.15 / 1.25);
  CHECK(low.at_rank(95) <= 7);
  CHECK(low.at_rank(95) > 7 / 1.25);
}

TEST_CASE("counts bear everything that a cost may be") {
  FarCounts counts;
  for (double ratio : {0.0, 1e-300, 1e-30, 1e30, 1e300}) counts.add(ratio);
  CHECK(counts.total() == 5);
  CHECK(counts.at_rank(0) > 0);
  CHECK(counts.at_rank(4) > counts.at_rank(0));
}

TEST_CASE("the far area is such that it tells in one case of twenty") {
  FarArea area;
  const double before = area.share();
  FarCounts few;
  few.add(100);
  area.learn(few);
  CHECK(area.share() == before);  // they say nothing

  FarCounts counts;
  for (int i = 0; i < 1000; ++i) counts.add(i < 930 ? 0.1 : 1.5);
  area.learn(counts);
  CHECK(area.share() == before / 1.5);
  FarCounts nothing;
  for (int i = 0; i < 1000; ++i) nothing.add(0);
  area.learn(nothing);
  const double most = area.share();
  area.learn(nothing);
  CHECK(area.share() == most);  // it has bounds
}

}  // namespace
}  // namespace crease::simplification
