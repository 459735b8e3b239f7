#include "codec/sextant.h"
#include "mesh/octahedral.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace crease {
namespace {

// Exact for small angles too.
double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// Uniform over the sphere.
class Directions {
 public:
  Vec3d next() {
    const double z = 2 * unit_(random_) - 1, turn = 2 * kPi * unit_(random_);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(turn), r * std::sin(turn), z};
  }
  // Within about `angle` of `d`.
  Vec3d near(const Vec3d& d, double angle) { return normalized(d + next() * angle); }

 private:
  std::mt19937 random_{20031};
  std::uniform_real_distribution<double> unit_{0, 1};
};

// Every code that encode() can give but that of zero, in a fixed order.
std::vector<OctahedralCode> all_codes(const OctahedralCoding& coding) {
  std::vector<OctahedralCode> codes;
  for (std::uint32_t v = 0; v <= coding.max_component(); ++v) {
    for (std::uint32_t u = 0; u <= coding.max_component(); ++u) {
      const OctahedralCode code{u, v};
      if (coding.is_canonical(code) && code != OctahedralCoding::kZero) codes.push_back(code);
    }
  }
  return codes;
}

std::vector<SextantCode> all_codes(const SextantCoding& coding) {
  std::vector<SextantCode> codes;
  for (std::uint8_t octant = 0; octant < 8; ++octant) {
    for (std::uint8_t sextant = 0; sextant < 6; ++sextant) {
      for (std::uint16_t theta = 0; theta <= coding.angle_count(); ++theta) {
        for (std::uint16_t phi = 0; phi + theta <= int(coding.angle_count()); ++phi) {
          const SextantCode code{octant, sextant, theta, phi};
          if (coding.is_canonical(code)) codes.push_back(code);
        }
      }
    }
  }
  return codes;
}

// FNV-1a over the bits of every decoded direction.
template <typename Coding>
std::uint64_t hash_of_directions(const Coding& coding) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const auto& code : all_codes(coding)) {
    const Vec3f n = coding.decode(code);
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(n[k])) * 0x100000001b3u;
    }
  }
  return hash;
}

template <typename Coding>
void check_that_codes_stay(const Coding& coding) {
  const auto codes = all_codes(coding);
  CHECK(codes.size() == coding.direction_count());
  std::size_t moved = 0, not_unit = 0;
  for (const auto& code : codes) {
    const Vec3f n = coding.decode(code);
    moved += coding.encode(n) != code;
    not_unit += !(std::abs(length(to_double(n)) - 1) < 1e-7);
  }
  CHECK(moved == 0);
  CHECK(not_unit == 0);
}

template <typename Coding>
void check_that_the_nearest_is_found(const Coding& coding, int samples) {
  std::vector<Vec3d> decoded;
  for (const auto& code : all_codes(coding)) decoded.push_back(to_double(coding.decode(code)));
  Directions directions;
  for (int i = 0; i < samples; ++i) {
    const Vec3d d = directions.next();
    double best = 10;
    for (const Vec3d& n : decoded) best = std::min(best, length(n - d));
    CHECK(length(to_double(coding.decode(coding.encode(d))) - d) <= best + 1e-7);  // float rounding
  }
}

// The largest angle between samples and their codes' directions. Half of the samples crowd around
// `around`, where the codes are widest apart.
template <typename Coding>
double worst_angle(const Coding& coding, const Vec3d& around, int samples) {
  Directions directions;
  double worst = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3d d = i % 2 == 0 ? directions.near(around, 0.02) : directions.next();
    worst = std::max(worst, angle_between(to_double(coding.decode(coding.encode(d))), d));
  }
  return worst;
}

// The 26 directions to a cube's sides, edges and corners.
std::vector<Vec3d> symmetric_directions() {
  std::vector<Vec3d> all;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x != 0 || y != 0 || z != 0) all.push_back({double(x), double(y), double(z)});
      }
    }
  }
  return all;
}

template <typename Coding>
void check_symmetric_directions(const Coding& coding) {
  for (const Vec3d& d : symmetric_directions()) {
    const double size = std::sqrt(dot(d, d));
    const Vec3f expected{static_cast<float>(d.x / size), static_cast<float>(d.y / size),
                         static_cast<float>(d.z / size)};
    const Vec3f got = coding.decode(coding.encode(d));
    CAPTURE(d.x);
    CAPTURE(d.y);
    CAPTURE(d.z);
    CHECK(got == expected);
    for (int k = 0; k < 3; ++k) CHECK(!(got[k] == 0 && std::signbit(got[k])));
  }
}

template <typename Coding>
void check_mirrored_directions(const Coding& coding) {
  Directions directions;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d d = directions.next();
    const Vec3f n = coding.decode(coding.encode(d));
    CHECK(coding.decode(coding.encode(-d)) == -n);
    CHECK(coding.decode(coding.encode(Vec3d{-d.x, d.y, d.z})) == Vec3f{-n.x, n.y, n.z});
    CHECK(coding.decode(coding.encode(Vec3d{d.y, d.x, d.z})) == Vec3f{n.y, n.x, n.z});
    CHECK(coding.decode(coding.encode(d * 3e-300)) == n);
    CHECK(coding.decode(coding.encode(d * 3e300)) == n);
  }
}

TEST_CASE("an octahedral direction tells its code") {
  for (const int bits : {4, 8, 9}) {
    const OctahedralCoding coding(bits);
    for (const OctahedralCode code : all_codes(coding)) {
      const Vec3f n = coding.decode(code);
      REQUIRE(coding.exact_code(n) == code);
      REQUIRE(coding.encode(to_double(n)) == code);
    }
    CHECK(coding.exact_code({}) == OctahedralCoding::kZero);
    CHECK(!coding.exact_code({0.36f, 0.48f, 0.8f}));
  }
}

TEST_CASE("every octahedral code is the code of its direction") {
  for (int bits : {4, 5, 8}) check_that_codes_stay(OctahedralCoding(bits));
  for (int bits : {10, 13, 16}) {
    const OctahedralCoding coding(bits);
    std::mt19937 random(7);
    std::uniform_int_distribution<std::uint32_t> component(0, coding.max_component());
    for (int i = 0; i < 20000; ++i) {
      OctahedralCode code{component(random), component(random)};
      if (i % 4 == 0) code.u = random() % 2 * coding.max_component();  // on the folded sides
      if (code == OctahedralCoding::kZero) continue;
      const Vec3f n = coding.decode(code);
      CHECK(coding.encode(n) == coding.canonical(code));
      CHECK(coding.decode(coding.canonical(code)) == n);
    }
  }
}

TEST_CASE("every sextant code is the code of its direction") {
  for (int bits : {2, 3, 6, 7}) check_that_codes_stay(SextantCoding(bits));
  const SextantCoding coding(12);
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto theta = static_cast<std::uint16_t>(random() % (coding.angle_count() + 1));
    const auto phi = static_cast<std::uint16_t>(random() % (coding.angle_count() - theta + 1));
    const SextantCode code{static_cast<std::uint8_t>(random() % 8),
                           static_cast<std::uint8_t>(random() % 6), theta, phi};
    const Vec3f n = coding.decode(code);
    CHECK(coding.encode(n) == coding.canonical(code));
    CHECK(coding.decode(coding.canonical(code)) == n);
  }
}

TEST_CASE("encoding finds the code whose direction is nearest") {
  for (int bits : {4, 5, 6, 8}) {
    check_that_the_nearest_is_found(OctahedralCoding(bits), bits < 8 ? 3000 : 200);
  }
  for (int bits : {2, 3, 4, 6}) {
    check_that_the_nearest_is_found(SextantCoding(bits), bits < 6 ? 3000 : 200);
  }
}

// Octahedral: at the middle of a face codes are sqrt 6 / m apart, in equilateral triangles, so the
// worst is sqrt 2 / m there and less everywhere else.
TEST_CASE("octahedral codes are off by no more than sqrt 2 / m") {
  for (int bits = 8; bits <= 16; ++bits) {
    CAPTURE(bits);
    const OctahedralCoding coding(bits);
    const double bound = std::sqrt(2.0) / (coding.max_component() / 2);
    const double worst = worst_angle(coding, {1, 1, 1}, 20000);
    CHECK(worst <= bound * (1 + 1e-4) + 1e-7);
    CHECK(worst > 0.9 * bound);
  }
}

// Sextants: with f = 0.6155, codes are f / N apart in phi, and in theta, at its end of 45 degrees,
// f / N * (1 + tan^2 f) / sqrt(1 - tan^2 f) = 2.121 f / N. The worst is half the diagonal.
TEST_CASE("sextant codes are off by no more than half a cell's diagonal") {
  for (int bits : {4, 6, 8, 10, 12}) {
    CAPTURE(bits);
    const SextantCoding coding(bits);
    const double bound = 0.5 * std::hypot(1.0, 1.5 * std::sqrt(2.0)) * std::atan(std::sqrt(0.5)) /
                         coding.angle_count();
    const double worst = worst_angle(coding, {1, 0, 1}, 20000);
    CHECK(worst <= bound * (1 + 1e-3) + 1e-7);
    CHECK(worst > 0.85 * bound);
  }
}

TEST_CASE("axes and diagonals are exact, so that flat walls stay as they are") {
  for (int bits = OctahedralCoding::kMinBits; bits <= OctahedralCoding::kMaxBits; ++bits) {
    CAPTURE(bits);
    check_symmetric_directions(OctahedralCoding(bits));
  }
  for (int bits = SextantCoding::kMinBits; bits <= SextantCoding::kMaxBits; ++bits) {
    CAPTURE(bits);
    check_symmetric_directions(SextantCoding(bits));
  }
}

TEST_CASE("mirrored and scaled directions have mirrored and equal codes") {
  for (int bits : {8, 11, 16}) check_mirrored_directions(OctahedralCoding(bits));
  for (int bits : {3, 6, 12}) check_mirrored_directions(SextantCoding(bits));
}

TEST_CASE("the zero vector survives") {
  for (int bits : {8, 16}) {
    const OctahedralCoding coding(bits);
    CHECK(coding.encode(Vec3d{}) == OctahedralCoding::kZero);
    CHECK(coding.decode(OctahedralCoding::kZero) == Vec3f{});
    CHECK(coding.is_canonical(OctahedralCoding::kZero));
  }
  const SextantCoding coding(6);
  CHECK(coding.encode(Vec3d{}) == coding.zero());
  CHECK(coding.decode(coding.zero()) == Vec3f{});
  CHECK(coding.is_canonical(coding.zero()));
}

TEST_CASE("decoding gives the same bits with every compiler") {
  CHECK(hash_of_directions(OctahedralCoding(8)) == 2989664387285316797u);
  CHECK(hash_of_directions(SextantCoding(6)) == 6863551996377918661u);
}

TEST_CASE("an octahedral residual leads back, from every code to every code") {
  const OctahedralCoding coding(4);
  std::vector<OctahedralCode> codes = all_codes(coding);
  codes.push_back(OctahedralCoding::kZero);
  const auto m = static_cast<std::int32_t>(coding.max_component() / 2);
  for (const OctahedralCode& predicted : codes) {
    for (const OctahedralCode& code : codes) {
      const OctahedralResidual r = coding.residual(code, predicted);
      CHECK(std::max(std::abs(r.x), std::abs(r.y)) <= m);
      CHECK(coding.restore(r, predicted) == code);
    }
    CHECK(
        coding.residual(predicted, predicted) ==
        (predicted == OctahedralCoding::kZero ? OctahedralResidual{-m, -m} : OctahedralResidual{}));
  }
}

// Also across the equator, where the square folds, and around -z, where its corners meet.
TEST_CASE("near directions have small octahedral residuals, wherever they are") {
  for (int bits : {8, 10, 16}) {
    const OctahedralCoding coding(bits);
    const double m = coding.max_component() / 2;
    Directions directions;
    for (int i = 0; i < 30000; ++i) {
      Vec3d expected = directions.next();
      if (i % 3 == 0) expected.z *= 0.01;
      if (i % 3 == 1) expected = directions.near(symmetric_directions()[i / 3 % 26], 0.05);
      const Vec3d d = directions.near(expected, i % 2 == 0 ? 0.3 : 0.02);
      const OctahedralCode code = coding.encode(d), predicted = coding.encode(expected);
      const OctahedralResidual r = coding.residual(code, predicted);
      CHECK(coding.restore(r, predicted) == code);
      const double angle =
          angle_between(to_double(coding.decode(code)), to_double(coding.decode(predicted)));
      CHECK(std::max(std::abs(r.x), std::abs(r.y)) <= 2 * angle * m + 1);
    }
  }
}

TEST_CASE("whatever residual a file holds leads to a code") {
  const OctahedralCoding coding(9);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::uint32_t> component(0, coding.max_component());
  for (int i = 0; i < 5000; ++i) {
    const OctahedralResidual r{static_cast<std::int32_t>(random()),
                               static_cast<std::int32_t>(random())};
    const OctahedralCode predicted = coding.canonical({component(random), component(random)});
    CHECK(coding.is_canonical(coding.restore(r, predicted)));
  }
  const SextantCoding sextants(6);
  const SextantResidual far{255, 255, INT32_MAX, INT32_MIN};
  CHECK(!sextants.is_canonical(sextants.restore(far, {7, 5, 0, 64})));
}

TEST_CASE(
    "a sextant residual leads back, from every code to every code, and is small across sides") {
  const SextantCoding coding(2);
  std::vector<SextantCode> codes = all_codes(coding);
  codes.push_back(coding.zero());
  for (const SextantCode& predicted : codes) {
    CHECK(coding.residual(predicted, predicted) == SextantResidual{});
    for (const SextantCode& code : codes) {
      CHECK(coding.restore(coding.residual(code, predicted), predicted) == code);
    }
  }
  const SextantCoding fine(8);
  const double step = std::atan(std::sqrt(0.5)) / fine.angle_count();  // the least between codes
  Directions directions;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d expected = directions.next(), d = directions.near(expected, 0.05);
    const SextantCode code = fine.encode(d), predicted = fine.encode(expected);
    const SextantResidual r = fine.residual(code, predicted);
    CHECK(fine.restore(r, predicted) == code);
    const double angle =
        angle_between(to_double(fine.decode(code)), to_double(fine.decode(predicted)));
    CHECK(std::max(std::abs(r.theta), std::abs(r.phi)) <= 1.5 * angle / step + 1);
  }
}

}  // namespace
}  // namespace crease
