// Small parts stay whole or go.
#include "hierarchy/resting_parts.h"
#include "hierarchy/whole_part.h"
#include "simplify/reduce.h"
#include "support/sanitized.h"
#include "support/steeples.h"
#include "support/village.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace crease {

TEST_CASE("what is lost with a cube is nine times its squared distances and its shading, by area") {
  constexpr double kSide = 2;
  MeshBuilder builder;
  builder.box({5, 5, 5}, {5 + kSide, 5 + kSide, 5 + kSide}, 24);
  const Mesh cube = builder.take();
  PartDamage damage;
  for (const Triangle& t : cube.triangles) {
    const auto at = [&](std::size_t c) { return cube.positions[index_of(t[c])]; };
    damage.add(at(0), at(1), at(2));
  }
  // Of a point of a face from the middle: half a side, and two uniform coordinates.
  const double mean_square = kSide * kSide * (1.0 / 4 + 2.0 / 12);
  const double by_distance = 9 * 6 * kSide * kSide * mean_square;
  CHECK(damage.distances() == doctest::Approx(by_distance).epsilon(0.01));
  CHECK(damage.all(0) == damage.distances());
  CHECK(damage.all(3) == doctest::Approx(by_distance + 9 * 6 * kSide * kSide * 9).epsilon(0.01));
  CHECK(PartDamage().all(1) == 0);

  PartDamage flat;  // as what lies behind it
  flat.add({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  flat.add({0, 0, 0}, {1, 1, 0}, {0, 1, 0});
  CHECK(flat.all(100) == doctest::Approx(flat.distances()));
}

TEST_CASE("what breaks a part is dearer the more triangles it has, and nothing breaks large ones") {
  CHECK(price_of_part(60, 12) == 10);
  CHECK(breaks_part(1.6, 60, 12));
  CHECK_FALSE(breaks_part(1.4, 60, 12));
  CHECK(breaks_part(6.1, 60, 24));
  CHECK_FALSE(breaks_part(5.9, 60, 24));
  CHECK_FALSE(breaks_part(1e9, 60, 37));
  CHECK_FALSE(breaks_part(1e9, 0, 8));
}

// 36 flat triangles at the side of a box are two. When the level has fewer than twelve a box, some
// boxes are gone; of one patch one may be on its way.
TEST_CASE("boxes of a village are whole or gone at every level") {
  const Mesh input = village();
  std::size_t last = kBoxes;
  const std::vector<double> levels =
      kSanitized ? std::vector<double>{14, 1} : std::vector<double>{40, 14, 10, 6, 3, 1};
  for (const double per_box : levels) {
    const Reached reached = reduce(input, std::size_t(per_box * kBoxes));
    const BoxCount boxes = count_boxes(input, reached.mesh);
    CAPTURE(per_box);
    CHECK(boxes.broken <= 1);
    CHECK(boxes.whole <= last);
    last = boxes.whole;
    if (per_box == 14) CHECK(boxes.whole > kBoxes / 2);
    if (per_box == 1) CHECK(boxes.gone > kBoxes / 2);
  }
}

TEST_CASE("no spire floats over a drum that is gone") {
  const Mesh input = steeples();
  bool any_gone = false;
  const std::vector<double> levels =
      kSanitized ? std::vector<double>{30, 14} : std::vector<double>{60, 40, 30, 20, 14, 8, 4};
  for (const double per_steeple : levels) {
    const Reached reached = reduce(input, std::size_t(per_steeple * kSteeples));
    const SteepleCount steeples = count_steeples(reached.mesh);
    CAPTURE(per_steeple);
    CHECK(steeples.floating <= kSteeples / 10);  // 88 if each went by its own price
    any_gone |= steeples.whole > kSteeples / 10 && steeples.whole < kSteeples * 9 / 10;
  }
  CHECK(any_gone);
}

TEST_CASE("a part rests on the only one that its box touches") {
  const auto box = [](const Vec3d& low, const Vec3d& high) {
    PartBox result;
    result.add(low);
    result.add(high);
    return result;
  };
  const std::vector<PartBox> boxes{
      box({0, 0, 0}, {4, 4, 1}),        // a floor,
      box({1, 1, 1}, {2, 2, 2}),        // a body on it,
      box({1, 1, 2.001}, {2, 2, 3}),    // a roof on that,
      box({1.4, 1.4, 3}, {1.5, 2, 4}),  // a mast on the roof
      box({8, 8, 8}, {9, 9, 9}),        // and something elsewhere
  };
  CHECK(only_contacts(boxes) == std::vector<std::uint32_t>{1, kNone, kNone, 2, kNone});
  CHECK(only_contacts({}).empty());
}

}  // namespace crease
