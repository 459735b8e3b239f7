#include "plain_decoder/values.h"

#include <bit>
#include <cmath>

namespace plain {

namespace {

std::vector<float> octahedral_value(const Code& code, int bits) {
  const Octahedral coding(bits);
  const auto in_range = [&](std::int32_t component) {
    const std::uint32_t most = static_cast<std::uint32_t>(coding.most());
    return static_cast<std::int32_t>(std::min(static_cast<std::uint32_t>(component), most));
  };
  const FloatVector d = coding.direction({in_range(code[0]), in_range(code[1]), 0, 0});
  return {float(d.x), float(d.y), float(d.z)};
}

// A lattice code out of range is the nearest in range.
float lattice_value(std::int32_t code, const Lattice& lattice) {
  const std::int32_t c = std::clamp(code, lattice.least, lattice.greatest);
  if (lattice.entries.empty()) return float(c) / lattice.divisor;
  const auto i = static_cast<std::size_t>((c - lattice.least) / lattice.grain);
  const std::int32_t j = (c - lattice.least) % lattice.grain;
  if (j == 0) return lattice.entries[i];
  const double before = lattice.entries[i], after = lattice.entries[i + 1];
  return float((before * (lattice.grain - j) + after * j) / lattice.grain);
}

// "Sextants".

using Order = std::array<std::size_t, 3>;  // the largest, the middle, the smallest component
constexpr std::array<Order, 6> kOrders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

struct Angles {
  std::vector<double> sine, cosine;  // at 0 to K
};

Angles angles(std::size_t K) {
  Angles a{std::vector<double>(K + 1), std::vector<double>(K + 1)};
  a.sine[0] = 0;
  a.cosine[0] = 1;
  a.sine[K] = std::sqrt(1.0 / 3);
  a.cosine[K] = std::sqrt(2.0 / 3);
  double C = a.cosine[K];
  for (std::size_t span = K; span > 1; span /= 2) {
    C = std::sqrt((1 + C) / 2);
    for (std::size_t i = 0; i < K; i += span) {
      a.sine[i + span / 2] = (a.sine[i] + a.sine[i + span]) / (2 * C);
      a.cosine[i + span / 2] = (a.cosine[i] + a.cosine[i + span]) / (2 * C);
    }
  }
  return a;
}

std::vector<float> sextant_value(const Code& code, int bits) {
  const std::size_t K = std::size_t(1) << bits;
  const std::uint32_t all = static_cast<std::uint32_t>(code[0]);
  const std::size_t phi = all & 8191, theta = all >> 13 & 8191;
  const std::size_t octant = (all >> 26) / 6;
  const Order& order = kOrders[(all >> 26) % 6];
  const std::vector<float> zero(3, 0.0f);
  if (octant >= 8 || theta > K || phi > K - theta) return zero;
  // Canonical: of equal components the first comes first, and no 0 is negative.
  const bool first_two_equal = theta == 0, last_two_equal = phi == K - theta;
  if (first_two_equal && order[0] > order[1]) return zero;
  if (last_two_equal && order[1] > order[2]) return zero;
  if (phi == 0 && (octant >> order[2] & 1) != 0) return zero;
  if (theta == K && (octant >> order[1] & 1) != 0) return zero;

  const Angles a = angles(K);
  const double S = a.sine[K - theta] / a.cosine[K - theta];
  const double R = std::sqrt((1 - S) * (1 + S));
  std::array<double, 3> size{R * a.cosine[phi], S * a.cosine[phi], a.sine[phi]};
  if (theta == 0) size[1] = size[0];
  if (phi == K - theta) size[2] = size[1];
  std::vector<float> value(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const float f = float(size[k]);
    value[order[k]] = (octant >> order[k] & 1) != 0 && f > 0 ? -f : f;
  }
  return value;
}

}  // namespace

std::vector<float> value_of(const Code& code, const BlockLayer& layer,
                            const std::vector<Lattice>& lattices) {
  switch (layer.kind) {
    case BlockLayer::Kind::Octahedral:
      return octahedral_value(code, layer.bits);
    case BlockLayer::Kind::Sextant:
      return sextant_value(code, layer.bits);
    case BlockLayer::Kind::Lattice:
    case BlockLayer::Kind::Floats:
      break;
  }
  std::vector<float> value;
  for (std::size_t k = 0; k < layer.dimension; ++k) {
    value.push_back(layer.kind == BlockLayer::Kind::Lattice ? lattice_value(code[k], lattices[k])
                                                            : std::bit_cast<float>(code[k]));
  }
  return value;
}

}  // namespace plain
