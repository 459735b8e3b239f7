#include "simplify/pass_limits.h"

#include <doctest/doctest.h>

#include <initializer_list>

namespace crease::simplification {
namespace {

TEST_CASE("a limit grows as little as what the last pass left allows, and by 24 at most") {
  for (const double share : {0.05, 0.3, 0.5, 0.8, 0.96, 0.999}) {
    PassLimits limits(1);
    double before = limits.limit();
    for (int pass = 0; pass < 12; ++pass) {
      limits.advance(share, false);
      CHECK(limits.limit() >= 2 * before);
      CHECK(limits.limit() <= kMostGrowth * before * (1 + 1e-12));
      before = limits.limit();
    }
  }
}

TEST_CASE("a limit that nothing was below is raised, and never lowered") {
  PassLimits limits(3);
  limits.raise(2);
  CHECK(limits.limit() == 3);
  limits.raise(500);
  CHECK(limits.limit() == 500);
}

TEST_CASE("the first band has one pass, others two, what is cut short ends") {
  PassLimits limits(1);
  CHECK(limits.begins_band());
  CHECK(limits.advance(0.5, false));
  CHECK_FALSE(limits.advance(0.5, false));
  CHECK_FALSE(limits.begins_band());
  CHECK(limits.advance(0.5, false));
  CHECK(limits.advance(0.99, true));
  CHECK(limits.begins_band());
}

}  // namespace
}  // namespace crease::simplification
