#include "codec/sextant.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease {

namespace {

using Order = std::array<std::uint8_t, 3>;  // the axes of the largest, middle, smallest component
constexpr std::array<Order, 6> kOrders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

std::uint8_t index_of_order(const Order& order) {
  const auto found = std::find(kOrders.begin(), kOrders.end(), order);
  return static_cast<std::uint8_t>(found - kOrders.begin());
}

// The entry of an ascending table that is nearest to x.
std::uint32_t nearest_entry(const std::vector<double>& table, double x) {
  const auto above = std::lower_bound(table.begin(), table.end(), x);
  if (above == table.begin()) return 0;
  if (above == table.end()) return static_cast<std::uint32_t>(table.size() - 1);
  const auto i = static_cast<std::uint32_t>(above - table.begin());
  return *above - x < x - table[i - 1] ? i : i - 1;
}

}  // namespace

// The unit vector half way between two at an angle of 2a is their sum over 2 cos a, and cos a
// follows from cos 2a by a root: no product is ever added to anything, so nothing can be fused.
SextantCoding::SextantCoding(int bits) : n_(1u << bits) {
  CREASE_ASSERT(bits >= kMinBits && bits <= kMaxBits);
  sine_.resize(n_ + 1);
  cosine_.resize(n_ + 1);
  sine_[0] = 0;
  cosine_[0] = 1;
  sine_[n_] = std::sqrt(1.0 / 3);  // f = atan(1 / sqrt 2)
  cosine_[n_] = std::sqrt(2.0 / 3);
  double cosine_of_span = cosine_[n_];
  for (std::uint32_t span = n_; span > 1; span /= 2) {
    cosine_of_span = std::sqrt((1 + cosine_of_span) / 2);
    for (std::uint32_t i = 0; i < n_; i += span) {
      const std::uint32_t middle = i + span / 2;
      sine_[middle] = (sine_[i] + sine_[i + span]) / (2 * cosine_of_span);
      cosine_[middle] = (cosine_[i] + cosine_[i + span]) / (2 * cosine_of_span);
    }
  }
  tangent_.resize(n_ + 1);
  for (std::uint32_t i = 0; i <= n_; ++i) tangent_[i] = sine_[i] / cosine_[i];
}

// (largest, middle, smallest). Equal where the direction says so, to the bit.
Vec3d SextantCoding::in_triangle(std::uint32_t theta, std::uint32_t phi) const {
  const double sine = tangent_[n_ - theta];  // of theta
  const double cosine = std::sqrt((1 - sine) * (1 + sine));
  Vec3d d{cosine * cosine_[phi], sine * cosine_[phi], sine_[phi]};
  if (theta == 0) d.y = d.x;
  if (phi == n_ - theta) d.z = d.y;
  return d;
}

bool SextantCoding::has_direction(SextantCode code) const {
  return code.octant < 8 && code.sextant < kOrders.size() && code.theta <= n_ &&
         code.phi <= n_ - code.theta;
}

SextantCode SextantCoding::canonical(SextantCode code) const {
  Order order = kOrders[code.sextant];
  const bool first_equal = code.theta == 0, last_equal = code.phi == n_ - code.theta;
  if (first_equal && last_equal) {
    std::sort(order.begin(), order.end());
  } else if (first_equal) {
    std::sort(order.begin(), order.begin() + 2);
  } else if (last_equal) {
    std::sort(order.begin() + 1, order.end());
  }
  unsigned octant = code.octant;
  if (code.phi == 0) octant &= ~(1u << order[2]);
  if (code.theta == n_) octant &= ~(1u << order[1]);
  return {static_cast<std::uint8_t>(octant), index_of_order(order), code.theta, code.phi};
}

bool SextantCoding::is_canonical(SextantCode code) const {
  return code == zero() || (has_direction(code) && canonical(code) == code);
}

// Of a direction in the triangle no mirrored code is nearer than the one it mirrors, so it is
// enough to look there.
SextantCode SextantCoding::encode(const Vec3d& direction) const {
  const double largest =
      std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (largest == 0) return zero();
  int exponent = 0;
  std::frexp(largest, &exponent);
  std::array<double, 3> size{};
  Order order = kOrders[0];
  unsigned octant = 0;
  for (int k = 0; k < 3; ++k) {
    size[k] = std::abs(std::ldexp(direction[k], -exponent));
    if (direction[k] < 0) octant |= 1u << k;
  }
  std::sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) {
    return size[a] != size[b] ? size[a] > size[b] : a < b;
  });
  const Vec3d d = normalized(Vec3d{size[order[0]], size[order[1]], size[order[2]]});

  const double sine_of_theta = d.y / std::sqrt(d.x * d.x + d.y * d.y);
  const auto theta = static_cast<int>(n_ - nearest_entry(tangent_, sine_of_theta));
  const auto phi = static_cast<int>(nearest_entry(sine_, d.z));
  const int n = static_cast<int>(n_);
  SextantCode best{static_cast<std::uint8_t>(octant), index_of_order(order), 0, 0};
  double best_cosine = -2;
  for (int t = std::max(0, theta - 1); t <= std::min(n, theta + 1); ++t) {
    for (int p = std::max(0, std::min(phi, n - t) - 1); p <= std::min(n - t, phi + 1); ++p) {
      const auto t_code = static_cast<std::uint16_t>(t), p_code = static_cast<std::uint16_t>(p);
      const double cosine = dot(d, in_triangle(t_code, p_code));
      if (!(cosine > best_cosine)) continue;
      best.theta = t_code;
      best.phi = p_code;
      best_cosine = cosine;
    }
  }
  return canonical(best);
}

Vec3f SextantCoding::decode(SextantCode code) const {
  if (code == zero()) return {};
  CREASE_ASSERT(has_direction(code));
  const Vec3d d = in_triangle(code.theta, code.phi);
  Vec3f direction;
  for (int k = 0; k < 3; ++k) {
    const int axis = kOrders[code.sextant][static_cast<std::size_t>(k)];
    const auto size = static_cast<float>(d[k]);
    direction[axis] = (code.octant >> axis & 1) && size > 0 ? -size : size;
  }
  return direction;
}

SextantResidual SextantCoding::residual(SextantCode code, SextantCode predicted) const {
  const Order& order = kOrders[code.sextant];
  const Order& expected = kOrders[predicted.sextant];
  Order relative{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = std::find(expected.begin(), expected.end(), order[k]);
    relative[k] = static_cast<std::uint8_t>(at - expected.begin());
  }
  return {static_cast<std::uint8_t>(code.octant ^ predicted.octant), index_of_order(relative),
          std::int32_t(code.theta) - predicted.theta, std::int32_t(code.phi) - predicted.phi};
}

SextantCode SextantCoding::restore(SextantResidual residual, SextantCode predicted) const {
  const Order& expected = kOrders[predicted.sextant];
  const Order& relative = kOrders[residual.sextant % kOrders.size()];
  Order order{};
  for (std::size_t k = 0; k < 3; ++k) order[k] = expected[relative[k]];
  const auto sum = [](std::int32_t a, std::uint16_t b) {
    return static_cast<std::uint16_t>(static_cast<std::uint32_t>(a) + b);
  };
  return {static_cast<std::uint8_t>((residual.octant ^ predicted.octant) & 7),
          index_of_order(order), sum(residual.theta, predicted.theta),
          sum(residual.phi, predicted.phi)};
}

}  // namespace crease
