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
    c.witnesses.all.push_back({point()});
    c.witnesses.put(std::uint32_t(i), std::uint32_t(count));  // of one that has vanished
  }
  return c;
}

float measure(const Case& c, float known, WitnessMover& mover) {
  mover.start();
  for (std::uint32_t i = 0; i < c.ring.size(); ++i) mover.add(i, c.ring[i][0], c.ring[i][1]);
  for (std::uint32_t i = 0; i < c.ring.size(); ++i) mover.take(i, i, c.witnesses);
  mover.take(std::uint32_t(c.ring.size()), kNone, c.witnesses);
  return mover.measure(c.witnesses, {}, known);
}

float settle(Case& c, float known = 0) {
  WitnessMover mover;
  const float farthest = measure(c, known, mover);
  mover.settle(c.witnesses);
  return farthest;
}

double nearest(const Case& c, std::uint32_t witness) {
  const Vec3i& place = c.witnesses.all[witness].place;
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
        CHECK(double(c.witnesses.all[w].told) == doctest::Approx(nearest(c, w)).epsilon(1e-4));
      }
      CHECK(double(far) == doctest::Approx(most).epsilon(1e-4));
      for (std::uint32_t t = 0; t < c.ring.size(); ++t) {
        for (std::uint32_t w = c.witnesses.first[t]; w != kNone; w = c.witnesses.all[w].next) {
          const Vec3i& p = c.witnesses.all[w].place;
          const double own =
              distance_from({double(p.x), double(p.y), double(p.z)}, c.ring[t][0], c.ring[t][1]);
          CHECK(own == doctest::Approx(nearest(c, w)).epsilon(1e-4));
        }
      }
    }
  }
}

TEST_CASE("of triangles that are as near a witness takes one that has an area") {
  for (const bool is_first : {false, true}) {
    Case c;
    c.ring = {{Vec3d{100, 0, 0}, Vec3d{0, 100, 0}}, {Vec3d{100, 0, 0}, Vec3d{100, 0, 0}}};
    if (is_first) std::swap(c.ring[0], c.ring[1]);
    const std::uint32_t with = is_first ? 1 : 0, without = 1 - with;
    c.witnesses.first = {kNone, kNone, kNone};
    c.witnesses.all = {{{100, 0, 0}}};
    c.witnesses.put(0, 2);
    CHECK(settle(c) < 1e-3);
    CHECK(c.witnesses.first[with] == 0);
    c.witnesses.first = {kNone, kNone, kNone};
    c.witnesses.put(0, without);
    CHECK(settle(c, 50) < 1e-3);  // it does not stay there, however near
    CHECK(c.witnesses.first[with] == 0);
  }
}

TEST_CASE("vertices of triangles without area are no witnesses") {
  constexpr std::int32_t kFar = 1 << 30;
  const std::vector<Vec3i> positions = {{0, 0, 0},       {0, 0, 0},          {5, 0, 0},
                                        {10, 0, 0},      {0, 1, 0},          {-kFar, -kFar, 0},
                                        {kFar, kFar, 0}, {kFar, kFar - 1, 0}};
  const auto at = [](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return Triangle{VertexId{a}, VertexId{b}, VertexId{c}};
  };
  Mesh mesh;
  mesh.triangles = {at(0, 1, 3), at(0, 2, 3), at(3, 2, 4), at(5, 0, 6), at(5, 0, 7)};
  const Witnesses witnesses = witnesses_of(mesh, positions);
  const auto of = [&](std::uint32_t t) {
    std::vector<std::uint32_t> own;
    for (std::uint32_t w = witnesses.first[t]; w != kNone; w = witnesses.all[w].next) {
      own.push_back(w);
    }
    std::sort(own.begin(), own.end());
    return own;
  };
  CHECK(of(0).empty());
  CHECK(of(1).empty());
  CHECK(of(2) == std::vector<std::uint32_t>{2, 3, 4});
  CHECK(of(3).empty());
  CHECK(of(4) == std::vector<std::uint32_t>{0, 5, 7});  // 6 and 1 have no other
}

TEST_CASE("a triangle keeps the farthest of many witnesses, whatever their order") {
  std::mt19937 random(4);
  Case c = random_case(random, 1, 60), d = c;
  d.witnesses.first[1] = kNone;
  for (std::uint32_t w = 60; w-- > 0;) d.witnesses.put(w, 1);
  CHECK(settle(c) == settle(d));
  std::vector<std::uint32_t> kept;
  for (std::uint32_t w = c.witnesses.first[0]; w != kNone; w = c.witnesses.all[w].next) {
    kept.push_back(w);
  }
  CHECK(kept.size() == kMostWitnesses);
  std::uint32_t farthest = 0;
  for (std::uint32_t w = 0; w < 60; ++w) {
    if (nearest(c, w) > nearest(c, farthest)) farthest = w;
  }
  CHECK(std::find(kept.begin(), kept.end(), farthest) != kept.end());
  CHECK(c.witnesses.first == d.witnesses.first);
  CHECK(c.witnesses.all[kept[0]].next == d.witnesses.all[kept[0]].next);
}

TEST_CASE("a witness that is no farther away than before does not count") {
  Case c;
  c.ring = {{Vec3d{100, 0, 0}, Vec3d{0, 100, 0}}};
  c.witnesses.first = {kNone, kNone};
  c.witnesses.all = {{{10, 10, 50}}};
  c.witnesses.put(0, 1);
  CHECK(settle(c) == 50);
  CHECK(settle(c) == 0);
  c.witnesses.all[0].place.z = 54;
  CHECK(settle(c) == 0);
  c.witnesses.all[0].place.z = 60;
  CHECK(settle(c) == 60);
}

// It is 10 above the triangle that it is with, and 1 away from another one, which stands upright.
TEST_CASE("a witness stays where it is while it is no farther away than is known") {
  for (const float known : {0.0f, 9.0f, 11.0f}) {
    Case c;
    c.ring = {{Vec3d{100, 0, 0}, Vec3d{0, 100, 0}}, {Vec3d{0, 0, 100}, Vec3d{100, 0, 100}}};
    c.witnesses.first = {kNone, kNone, kNone};
    c.witnesses.all = {{{10, 1, 10}}};
    c.witnesses.put(0, 0);
    const bool stays = known > 10;
    CHECK(settle(c, known) == (stays ? 10 : doctest::Approx(1)));
    CHECK(c.witnesses.first[stays ? 0 : 1] == 0);
    CHECK(c.witnesses.all[0].told == (stays ? 10 : doctest::Approx(1)));
  }
}

TEST_CASE("what was measured and not settled is forgotten") {
  std::mt19937 random(6);
  Case c = random_case(random, 9, 30), d = c;
  WitnessMover mover;
  measure(random_case(random, 20, 30), 0, mover);
  const float farthest = measure(c, 0, mover);
  mover.settle(c.witnesses);
  CHECK(farthest == settle(d));
  CHECK(c.witnesses.first == d.witnesses.first);
  for (std::uint32_t w = 0; w < 30; ++w) {
    CHECK(c.witnesses.all[w].next == d.witnesses.all[w].next);
    CHECK(c.witnesses.all[w].told == d.witnesses.all[w].told);
  }
}

TEST_CASE("witnesses of a part come back with what was done to them") {
  std::mt19937 random(5);
  Case c = random_case(random, 3, 20);
  settle(c);
  const std::vector<std::uint32_t> part{2, 0};
  const auto told_at = [](const Witnesses& witnesses, std::uint32_t triangle) {
    std::vector<float> told;
    for (std::uint32_t w = witnesses.first[triangle]; w != kNone; w = witnesses.all[w].next) {
      told.push_back(witnesses.all[w].told);
    }
    std::sort(told.begin(), told.end());
    return told;
  };
  const std::vector<float> first = told_at(c.witnesses, 0), second = told_at(c.witnesses, 1);
  const std::vector<float> third = told_at(c.witnesses, 2);
  REQUIRE(!third.empty());
  WitnessesOfPart of_part(c.witnesses, part);
  CHECK(told_at(of_part.here(), 0) == third);
  CHECK(told_at(of_part.here(), 1) == first);
  of_part.here().all[of_part.here().first[0]].told = 1e9f;
  of_part.give_back(part, 1, c.witnesses);
  CHECK(c.witnesses.first[0] == kNone);
  CHECK(told_at(c.witnesses, 1) == second);
  CHECK(told_at(c.witnesses, 2).back() == 1e9f);
  CHECK(told_at(c.witnesses, 2).size() == third.size());
}

}  // namespace
}  // namespace crease
