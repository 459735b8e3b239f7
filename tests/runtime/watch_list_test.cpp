// What a WatchList finds beside asking each of its watches.
#include "runtime/watch_list.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace crease {
namespace {

struct Flight {
  ViewParameters view;
  ViewError error;
  Odometer odometer;
  bool has_begun = false;

  void move_to(const Vec3d& position, const Vec3d& target) {
    view.camera.position = position;
    view.camera.target = target;
    const ViewError before = error;
    error = ViewError(view, Grid{});
    odometer.slop = 1e-6f * error.eye_length();
    if (!std::exchange(has_begun, true)) return;
    const ViewError::Motion motion = error.motion_from(before);
    odometer.travel += motion.travel;
    odometer.turn += motion.turn;
    odometer.turn_per_travel = Odometer::ratio(motion.turn, motion.travel);
  }
};

// Of a street of `count` houses along x, one unit apart; each is near within `reach`.
Watch house(std::size_t i, float reach, float radius) {
  Watch watch;
  watch.center = {static_cast<float>(i), static_cast<float>(i % 3), 0};
  watch.reach = reach;
  watch.radius = radius;
  return watch;
}

template <bool kWrong>
std::vector<std::uint32_t> those_to_find(const WatchList& watches, const ViewError& error) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < watches.size(); ++i) {
    if (error.is_wrong(watches.get(i)) == kWrong) found.push_back(i);
  }
  return found;
}

template <bool kWrong>
void check_flight(bool coarse_outside, bool all_move, std::uint64_t seed) {
  constexpr std::size_t kCount = 1500;
  std::mt19937_64 random(seed);
  const auto share = [&random] { return float(random() % 1000) / 1000; };
  WatchList watches;
  watches.resize(kCount, false);
  for (std::size_t i = 0; i < kCount; ++i) {
    if (random() % 8 != 0) watches.set(i, house(i, 30 * share(), 3 * share()));
  }
  Flight flight;
  flight.view.coarse_outside = coarse_outside;
  double a = double(seed);
  for (int f = 0; f < 300; ++f) {
    CAPTURE(f);
    const Vec3d eye{kCount * (0.5 + 0.6 * std::sin(a)), 8 * std::sin(3 * a), 5};
    flight.move_to(eye, eye + Vec3d{std::cos(7 * a), std::sin(7 * a), -0.3});
    std::vector<std::uint32_t> found;
    watches.find<kWrong>(
        flight.error, flight.odometer, [&found](std::uint32_t i) { found.push_back(i); }, all_move);
    REQUIRE(found == those_to_find<kWrong>(watches, flight.error));
    const auto set = [&](std::size_t i, const Watch& watch) {
      if (random() % 2 == 0) return watches.set(i, watch);
      watches.set<kWrong>(i, watch, flight.error, flight.odometer);
    };
    for (const std::uint32_t i : found) {  // as after a split
      if (all_move || random() % 2 == 0) set(i, house(i, 10 * share(), 3 * share()));
    }
    for (std::uint64_t left = random() % 4; left > 0; --left) {
      const std::size_t i = random() % kCount;
      set(i, house(i, 200 * share(), 3 * share()));
      if (kWrong && random() % 4 == 0) watches.turn_off(i);
      watches.set_as(random() % kCount, random() % kCount);
    }
    a += random() % 8 == 0 ? 0 : std::pow(10.0, -double(random() % 5)) * 0.1;
  }
}

TEST_CASE(
    "what is found is what is wrong, or what is not, wherever the camera goes and whatever is "
    "set") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    for (const bool coarse_outside : {true, false}) {
      for (const bool all_move : {true, false}) {
        check_flight<true>(coarse_outside, all_move, seed);
        check_flight<false>(coarse_outside, all_move, seed);
      }
    }
  }
}

TEST_CASE("of many watches that are far away few are looked at") {
  constexpr std::size_t kCount = 64000;
  WatchList watches;
  watches.resize(kCount, false);
  for (std::size_t i = 0; i < kCount; ++i) watches.set(i, house(i, 20, 1));
  Flight flight;
  for (int f = 0; f < 6; ++f) {  // so far that every date has passed
    flight.move_to({kCount / 2, f % 2 == 0 ? 1e6 : -1e6, 10}, {kCount / 2, 0, 10});
    const std::size_t looked_at =
        watches.find<true>(flight.error, flight.odometer, [](std::uint32_t) {});
    if (f >= 2) CHECK(looked_at <= kCount / 64);
  }
}

TEST_CASE("the slack is until something may be found") {
  WatchList watches;
  watches.resize(200, false);
  for (std::size_t i = 0; i < 200; ++i) watches.set(i, house(i, 20, 1));
  Flight flight;
  flight.view.coarse_outside = false;
  for (int f = 0; f < 3; ++f) {
    flight.move_to({-100 + double(f), 0, 0}, {1000, 0, 0});
    watches.find<true>(flight.error, flight.odometer, [](std::uint32_t) {});
  }
  const double slack = watches.slack(flight.odometer).travel;
  CHECK(slack > 60);
  CHECK(slack < 78);  // from -98 to 20 before the first house
  watches.set(150, house(150, 20, 1));
  CHECK(watches.slack(flight.odometer).travel < 0);
}

}  // namespace
}  // namespace crease
