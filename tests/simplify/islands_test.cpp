// Windows in a wall stay whole or go.
#include "simplify/reduce.h"
#include "support/facade.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <vector>

namespace crease {

// 2 triangles a window and 8 around it; 8 more where it is set back. Those near the wall's ends may
// have grown up to these.
TEST_CASE("windows of a facade are whole or gone at every level") {
  const Mesh input = facade();
  REQUIRE(input.triangle_count() == 14 * kWindows + 32 * kWindows);
  bool any_partly = false;
  const std::vector<double> levels =
      kSanitized ? std::vector<double>{14, 6} : std::vector<double>{30, 20, 14, 10, 8, 6, 4, 2, 1};
  for (const double per_window : levels) {
    const Reached reached = reduce(input, std::size_t(per_window * kWindows));
    const WindowCount windows = count_windows(input, reached.mesh);
    CAPTURE(per_window);
    CHECK(windows.broken <= kWindows / 20);
    any_partly |= windows.whole > kWindows / 10 && windows.gone > kWindows / 10;
  }
  CHECK(any_partly);
}

}  // namespace crease
