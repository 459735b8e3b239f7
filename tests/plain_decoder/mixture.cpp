#include "plain_decoder/mixture.h"

#include "plain_decoder/arithmetic.h"

namespace plain {

namespace {

// H(d), and what each component has there.
struct Reading {
  double sum = 0;
  PerComponent g{};
};

std::size_t group_of(std::size_t component) {
  return component < 2 ? 0 : 1;
}

}  // namespace

std::int32_t read_axis(RangeDecoder& in, Axis& axis, std::int32_t start, double size) {
  double all = 0;
  for (const double w : axis.weight) all += w;
  std::array<bool, kComponents> counts{};
  double W = 0, I = 0;
  for (std::size_t k = 0; k < kComponents; ++k) {
    counts[k] = axis.weight[k] > all * (1.0 / 1024);
    if (!counts[k]) axis.weight[k] = 0;
    if (counts[k]) W += axis.weight[k];
    if (counts[k]) I = std::max(I, axis.inverse_scale[k]);
  }
  const auto H = [&](std::int64_t d) {
    const double y = double(d) + start - 0.5;
    Reading at;
    for (std::size_t k = 0; k < kComponents; ++k) {
      if (!counts[k]) continue;
      const double z = (y - axis.centre[k]) * axis.inverse_scale[k];
      at.g[k] = z / std::sqrt(1 + z * z);
      at.sum += axis.weight[k] * at.g[k];
    }
    return at;
  };

  const double whole_size = size > 0 ? std::floor(std::min(size, 1e8)) : 0;
  const int n = 2 + static_cast<int>(std::bit_width(static_cast<std::uint32_t>(whole_size)));
  std::int64_t low = -(std::int64_t(1) << n), high = std::int64_t(1) << n;
  Reading at_low = H(low), at_high = H(high);
  if (!in.known(at_high.sum - at_low.sum, 2 * W)) {
    const bool above = in.known(W - at_high.sum, (W - at_high.sum) + (at_low.sum + W));
    for (int i = n;; ++i) {
      low = above ? std::int64_t(1) << i : -(std::int64_t(2) << i);
      high = above ? std::int64_t(2) << i : -(std::int64_t(1) << i);
      at_low = H(low);
      at_high = H(high);
      if (i == 30) break;
      if (in.known(at_high.sum - at_low.sum, above ? W - at_low.sum : at_high.sum + W)) break;
    }
  }
  while (high - low > 1 && double(high - low) > 0.25 / I) {
    const std::int64_t middle = (low + high) / 2;
    const Reading at_middle = H(middle);
    if (in.known(at_high.sum - at_middle.sum, at_high.sum - at_low.sum)) {
      low = middle;
      at_low = at_middle;
    } else {
      high = middle;
      at_high = at_middle;
    }
  }
  for (std::size_t k = 0; k < kComponents; ++k) {
    if (counts[k]) axis.weight[k] = axis.weight[k] * (at_high.g[k] - at_low.g[k]);
  }
  low += in.index(static_cast<std::size_t>(high - low));
  return sum_of(start, static_cast<std::int32_t>(static_cast<std::uint32_t>(low)));
}

std::int32_t round_of(double x) {
  constexpr double kMost = 1 << 30;
  if (!(x > -kMost)) x = -kMost;
  if (x > kMost) x = kMost;
  return static_cast<std::int32_t>(std::floor(x + 0.5));
}

double excess(double q) {
  return 3 * q / (1 + q) - 1;
}

bool make_shares(PerComponent& weights) {
  double sum = 0;
  for (const double w : weights) sum += w;
  if (!(sum > 0)) return false;
  for (double& w : weights) w = w / sum;
  return true;
}

void ComponentWeights::learn(const PerComponent& shares) {
  const double r = 1.0 / (std::min(n, 100) + 15);
  ++n;
  for (std::size_t k = 0; k < kComponents; ++k) of[k] += r * (shares[k] - of[k]);
}

void MeanSizes::learn(const Sizes& sizes) {
  if (!has_any) of = sizes;
  has_any = true;
  for (std::size_t j = 0; j < 4; ++j) of[j] += 0.02 * (sizes[j] - of[j]);
}

PerComponent ComponentScales::at(const Sizes& sizes) const {
  PerComponent result;
  for (std::size_t k = 0; k < kComponents; ++k) {
    double b = 0;
    for (std::size_t j = 0; j < 4; ++j) b += slope[group_of(k)][j] * sizes[j];
    result[k] = power_of_2(logarithm[k] + b);
  }
  return result;
}

void ComponentScales::learn(const PerComponent& shares, const PerComponent& excesses,
                            const Sizes& sizes, const Sizes& mean) {
  std::array<double, 2> sum{};
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double step = shares[k] * excesses[k];
    logarithm[k] = std::clamp(logarithm[k] + 0.15 * step, -12.0, 16.0);
    sum[group_of(k)] += step;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    double moved = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      const double away = std::clamp(sizes[j] - mean[j], -2.0, 2.0);
      const double next = std::clamp(slope[i][j] + 0.015 * sum[i] * away, -2.0, 2.0);
      moved += (next - slope[i][j]) * mean[j];
      slope[i][j] = next;
    }
    for (std::size_t k = 0; k < kComponents; ++k) {
      if (group_of(k) == i) logarithm[k] -= moved;
    }
  }
}

}  // namespace plain
