#include "hierarchy/witnesses.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace crease {
namespace {

double squared(const Vec3d& v) {
  return dot(v, v);
}

double to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d side = b - a;
  const double t = squared(side) > 0 ? dot(p - a, side) / squared(side) : 0;
  return length(p - a - side * std::min(1.0, std::max(0.0, t)));
}

// From the triangle 0, a, b, as one would write it down.
double distance_from(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d n = cross(a, b);
  if (squared(n) > 0) {
    const double u = dot(cross(a, p), n), v = dot(cross(p, b), n), w = squared(n) - u - v;
    if (u >= 0 && v >= 0 && w >= 0) return std::abs(dot(p, n)) / length(n);
  }
  return std::min({to_segment(p, {}, a), to_segment(p, {}, b), to_segment(p, a, b)});
}

struct Case {
  std::vector<std::array<Vec3d, 2>> ring;
  Witnesses witnesses;
};

// `count` triangles around the origin, and as many witnesses at the first of them.
Case random_case(std::mt19937& random, int count, int witness_count) {
  std::uniform_int_distribution<int> place(-1000, 1000);
  const auto point = [&] { return Vec3i{place(random), place(random), place(random)}; };
  const auto real = [](const Vec3i& p) { return Vec3d{double(p.x), double(p.y), double(p.z)}; };
  Case c;
  for (int i = 0; i < count; ++i) {
    const Vec3d a = real(point()), b = real(point());
    c.ring.push_back({a, i % 7 == 3 ? a : b});  // some have no area
  }
  c.witnesses.first.assign(std::size_t(count) + 1, kNone);
  for (int i = 0; i < witness_count; ++i) {
    c.witnesses.places.push_back(point());
    c.witnesses.next.push_back(kNone);
    c.witnesses.told.push_back(0);
    c.witnesses.put(std::uint32_t(i), std::uint32_t(count));  // of one that has vanished
  }
  return c;
}

float settle(Case& c) {
  WitnessMover mover;
  mover.start();
  for (std::uint32_t i = 0; i < c.ring.size(); ++i) mover.add(i, c.ring[i][0], c.ring[i][1]);
  for (std::uint32_t i = 0; i < c.ring.size(); ++i) mover.take(i, i, c.witnesses);
  mover.take(std::uint32_t(c.ring.size()), kNone, c.witnesses);
  const float farthest = mover.measure(c.witnesses, {});
  mover.settle(c.witnesses);
  return farthest;
}

double nearest(const Case& c, std::uint32_t witness) {
  const Vec3i& place = c.witnesses.places[witness];
  const Vec3d p{double(place.x), double(place.y), double(place.z)};
  double best = length(p);
  for (const auto& [a, b] : c.ring) best = std::min(best, distance_from(p, a, b));
  return best;
}

TEST_CASE("witnesses go to the nearest triangle around the vertex") {
  std::mt19937 random(3);
  for (const int count : {0, 1, 3, 6, 8, 9, 30}) {
    for (int round = 0; round < 20; ++round) {
      Case c = random_case(random, count, 5);
      const float far = settle(c);
      double most = 0;
      for (std::uint32_t w = 0; w < 5; ++w) {
        most = std::max(most, nearest(c, w));
        CHECK(double(c.witnesses.told[w]) == doctest::Approx(nearest(c, w)).epsilon(1e-4));
      }
      CHECK(double(far) == doctest::Approx(most).epsilon(1e-4));
      for (std::uint32_t t = 0; t < c.ring.size(); ++t) {
        for (std::uint32_t w = c.witnesses.first[t]; w != kNone; w = c.witnesses.next[w]) {
          const Vec3i& p = c.witnesses.places[w];
          const double own =
              distance_from({double(p.x), double(p.y), double(p.z)}, c.ring[t][0], c.ring[t][1]);
          CHECK(own == doctest::Approx(nearest(c, w)).epsilon(1e-4));
        }
      }
    }
  }
}

TEST_CASE("a triangle keeps the farthest of many witnesses, whatever their order") {
  std::mt19937 random(4);
  Case c = random_case(random, 1, 60), d = c;
  d.witnesses.first[1] = kNone;
  for (std::uint32_t w = 60; w-- > 0;) d.witnesses.put(w, 1);
  CHECK(settle(c) == settle(d));
  std::vector<std::uint32_t> kept;
  for (std::uint32_t w = c.witnesses.first[0]; w != kNone; w = c.witnesses.next[w]) {
    kept.push_back(w);
  }
  CHECK(kept.size() == kMostWitnesses);
  std::uint32_t farthest = 0;
  for (std::uint32_t w = 0; w < 60; ++w) {
    if (nearest(c, w) > nearest(c, farthest)) farthest = w;
  }
  CHECK(std::find(kept.begin(), kept.end(), farthest) != kept.end());
  CHECK(c.witnesses.first == d.witnesses.first);
  CHECK(c.witnesses.next[kept[0]] == d.witnesses.next[kept[0]]);
}

TEST_CASE("a witness that is no farther away than before does not count") {
  Case c;
  c.ring = {{Vec3d{100, 0, 0}, Vec3d{0, 100, 0}}};
  c.witnesses.first = {kNone, kNone};
  c.witnesses.places = {{10, 10, 50}};
  c.witnesses.next = {kNone};
  c.witnesses.told = {0};
  c.witnesses.put(0, 1);
  CHECK(settle(c) == 50);
  CHECK(settle(c) == 0);
  c.witnesses.places = {{10, 10, 54}};
  CHECK(settle(c) == 0);
  c.witnesses.places = {{10, 10, 60}};
  CHECK(settle(c) == 60);
}

}  // namespace
}  // namespace crease
