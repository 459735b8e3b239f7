#include "mesh/weld.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <map>
#include <vector>

namespace crease {
namespace {

TEST_CASE("bit-equal positions become one, in order of first appearance") {
  const std::vector<Vec3d> positions{{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {0, 0, 0}, {5, 5, 5}};
  const Weld weld = weld_positions(positions);
  CHECK(weld.new_of_old == std::vector<std::uint32_t>{0, 1, 0, 1, 2});
  CHECK(weld.first_old == std::vector<std::uint32_t>{0, 1, 4});
  CHECK_FALSE(weld.changes_nothing());
}

TEST_CASE("minus zero is zero, and a last bit is a difference") {
  const double one_up = std::nextafter(1.0, 2.0);
  const std::vector<Vec3d> positions{{0.0, 1, 0}, {-0.0, 1, -0.0}, {0.0, one_up, 0}};
  CHECK(weld_positions(positions).new_of_old == std::vector<std::uint32_t>{0, 0, 1});
}

TEST_CASE("welding agrees with a sorted map on random values full of repeats") {
  rc::check([](const std::vector<std::uint8_t>& bytes) {
    std::vector<float> values;
    for (std::uint8_t b : bytes) values.push_back(static_cast<float>(b % 3) - 1);
    values.resize(values.size() / 2 * 2);
    std::map<std::pair<float, float>, std::uint32_t> seen;
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < values.size(); i += 2) {
      const auto fresh = static_cast<std::uint32_t>(seen.size());
      expected.push_back(seen.emplace(std::pair(values[i], values[i + 1]), fresh).first->second);
    }
    const Weld weld = weld_values(values, 2);
    RC_ASSERT(weld.new_of_old == expected);
    RC_ASSERT(weld.first_old.size() == seen.size());
  });
}

TEST_CASE("nothing welds to nothing") {
  CHECK(weld_positions({}).new_of_old.empty());
  CHECK(weld_values({}, 3).first_old.empty());
}

}  // namespace
}  // namespace crease
