#include "pipeline/fit_lattice.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace crease {

namespace {

// What bytes and 16-bit numbers are divided by, unsigned and signed.
constexpr std::array<float, 4> kDivisors{255, 127, 65535, 32767};

// Steps of a lattice are powers of two within these, whatever the values, and codes are exact as
// floats.
constexpr int kMinExponent = -120, kMaxExponent = 120;
constexpr int kMaxCodeBits = 24;

// A table is worth its bytes when every entry is used often; a few cost nothing.
constexpr std::size_t kAlwaysFew = 16, kMostEntries = 256, kUsesOfEntry = 8;

bool is_exact(const NumberLattice& lattice, std::span<const float> values) {
  return std::all_of(values.begin(), values.end(),
                     [&](float x) { return lattice.value(lattice.nearest(x)) == x; });
}

NumberLattice lattice_over(float divisor, float low, float high) {
  NumberLattice lattice{
      .divisor = divisor, .low = -(1 << kMaxCodeBits), .high = 1 << kMaxCodeBits, .palette = {}};
  const std::int32_t first = lattice.nearest(low), last = lattice.nearest(high);
  lattice.low = first;
  lattice.high = last;
  return lattice;
}

float power_of_two(int exponent) {
  return std::ldexp(1.0f, exponent);
}

// The distinct values, ascending; empty if they are too many for a table.
std::vector<float> few_values(std::span<const float> values) {
  std::vector<float> distinct(values.begin(), values.end());
  for (float& x : distinct) x += 0.0f;  // -0 becomes +0
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  const std::size_t most =
      std::max(kAlwaysFew, std::min(kMostEntries, values.size() / kUsesOfEntry));
  if (distinct.size() > most) distinct.clear();
  return distinct;
}

// The coarsest that has all values exactly, if there is one in about 2^bits steps, or as said above
// (3).
NumberLattice fit_input(std::span<const float> values, int bits) {
  if (values.empty()) return {};
  const auto [low_at, high_at] = std::minmax_element(values.begin(), values.end());
  const float low = *low_at, high = *high_at;
  if (low == high) return {.divisor = 1, .low = 0, .high = 0, .palette = {low + 0.0f}};

  // The step: range / 2^bits, rounded down to a power of two, but no finer than the floats.
  int range_exponent = 0, size_exponent = 0;
  std::frexp(double(high) - double(low), &range_exponent);  // range in [2^(e - 1), 2^e)
  std::frexp(std::max(std::abs(low), std::abs(high)), &size_exponent);
  int exponent = std::max(range_exponent - 1 - bits, size_exponent - kMaxCodeBits);
  exponent = std::clamp(exponent, kMinExponent, kMaxExponent);
  NumberLattice fine = lattice_over(power_of_two(-exponent), low, high);
  if (is_exact(fine, values)) {
    while (exponent < kMaxExponent) {  // coarser, as long as nothing is lost: smaller codes
      NumberLattice coarse = lattice_over(power_of_two(-exponent - 1), low, high);
      if (!is_exact(coarse, values)) break;
      fine = std::move(coarse);
      ++exponent;
    }
    return fine;
  }
  for (float divisor : kDivisors) {
    if ((double(high) - double(low)) * double(divisor) > double(1 << bits)) continue;
    const NumberLattice lattice = lattice_over(divisor, low, high);
    if (is_exact(lattice, values)) return lattice;
  }
  std::vector<float> few = few_values(values);
  if (!few.empty()) {
    const auto last = static_cast<std::int32_t>(few.size() - 1);
    return {.divisor = 1, .low = 0, .high = last, .palette = std::move(few)};
  }
  return fine;
}

// The same values in grains, until blends have about 2^bits steps.
void add_grain(NumberLattice& lattice, int bits) {
  constexpr std::int32_t kMost = 1 << (kMaxCodeBits - 1);
  const float most_divisor = power_of_two(kMaxExponent);
  while (lattice.low < lattice.high && lattice.high - lattice.low < (1 << bits) - 1 &&
         lattice.grain < kMostGrain) {
    if (lattice.low < -kMost || lattice.high > kMost || lattice.divisor >= most_divisor) break;
    lattice.low *= 2;
    lattice.high *= 2;
    lattice.grain *= 2;
    if (lattice.palette.empty()) lattice.divisor *= 2;
  }
}

}  // namespace

NumberLattice fit_lattice(std::span<const float> values, int bits, int blend_bits) {
  CREASE_ASSERT(bits >= 1 && bits <= kMaxLatticeBits && blend_bits <= bits);
  NumberLattice lattice = fit_input(values, bits);
  add_grain(lattice, blend_bits);
  return lattice;
}

}  // namespace crease
