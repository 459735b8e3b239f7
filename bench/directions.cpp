// Direction codings beside each other: how far off, at how many bits (docs/attributes.md).
//
//   bench_directions            two Markdown tables on standard output
//
// The worst error is the largest of a million directions all over the sphere and of a million
// around the place where the coding's cells are largest; the mean is that of the first million.
#include "codec/sextant.h"
#include "mesh/octahedral.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

using namespace crease;

namespace {

constexpr int kSamples = 1'000'000;

struct Row {
  int bits;            // the coding's own parameter
  double code_bits;    // log2 of the number of directions
  double worst, mean;  // degrees
};

class Directions {
 public:
  Vec3d next() {
    const double z = 2 * unit_(random_) - 1, turn = 2 * kPi * unit_(random_);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(turn), r * std::sin(turn), z};
  }

 private:
  std::mt19937_64 random_{1995};
  std::uniform_real_distribution<double> unit_{0, 1};
};

template <typename Coding>
double error_of(const Coding& coding, const Vec3d& d) {
  const Vec3d n = to_double(coding.decode(coding.encode(d)));
  return degrees(std::atan2(length(cross(n, d)), dot(n, d)));
}

template <typename Coding>
Row measure(const Coding& coding, int bits, const Vec3d& widest) {
  Directions directions;
  Row row{bits, std::log2(static_cast<double>(coding.direction_count())), 0, 0};
  for (int i = 0; i < kSamples; ++i) {
    const double error = error_of(coding, directions.next());
    row.worst = std::max(row.worst, error);
    row.mean += error / kSamples;
  }
  for (int i = 0; i < kSamples; ++i) {
    const Vec3d near = normalized(normalized(widest) + directions.next() * 0.02);
    row.worst = std::max(row.worst, error_of(coding, near));
  }
  return row;
}

// Errors fall with the square root of the number of directions, within a percent of it: the bits at
// which `row`'s coding is off by `error`, and the error at `code_bits`.
double bits_at(double code_bits, double own_error, double error) {
  return code_bits + 2 * std::log2(own_error / error);
}
double error_at(double own_bits, double own_error, double code_bits) {
  return own_error * std::exp2((own_bits - code_bits) / 2);
}

}  // namespace

int main() {
  std::vector<Row> octahedral, sextant;
  for (int bits = 8; bits <= 16; ++bits) {
    octahedral.push_back(measure(OctahedralCoding(bits), bits, {1, 1, 1}));
  }
  for (int bits = 4; bits <= 12; ++bits) {
    sextant.push_back(measure(SextantCoding(bits), bits, {1, 0, 1}));
  }
  std::printf("| coding | bits | directions, log2 | worst, degrees | mean, degrees |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Row& r : octahedral) {
    std::printf("| octahedral | %d a component | %.2f | %.4f | %.4f |\n", r.bits, r.code_bits,
                r.worst, r.mean);
  }
  for (const Row& r : sextant) {
    std::printf("| Deering | %d an angle | %.2f | %.4f | %.4f |\n", r.bits, r.code_bits, r.worst,
                r.mean);
  }

  std::printf(
      "\n| Deering | bits | worst, degrees | octahedral at equal bits | octahedral's bits at "
      "equal worst error | mean, degrees | octahedral at equal bits | octahedral's bits at "
      "equal mean error |\n|---|---|---|---|---|---|---|---|\n");
  for (const Row& d : sextant) {
    const Row& o =
        *std::min_element(octahedral.begin(), octahedral.end(), [&](const Row& a, const Row& b) {
          return std::abs(a.code_bits - d.code_bits) < std::abs(b.code_bits - d.code_bits);
        });
    std::printf("| %d an angle | %.2f | %.4f | %.4f | %.2f | %.4f | %.4f | %.2f |\n", d.bits,
                d.code_bits, d.worst, error_at(o.code_bits, o.worst, d.code_bits),
                bits_at(o.code_bits, o.worst, d.worst), d.mean,
                error_at(o.code_bits, o.mean, d.code_bits), bits_at(o.code_bits, o.mean, d.mean));
  }
  return 0;
}
