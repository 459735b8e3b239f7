#include "plain_decoder/mixture.h"

#include "plain_decoder/arithmetic.h"

namespace plain {

namespace {

std::size_t group_of(std::size_t component) {
  return component < 2 ? 0 : 1;
}

// `centre` is less by the start.
float g_of(const Axis& axis, std::size_t k, float centre, float y) {
  const float z = (y - centre) * axis.inverse_scale[k];
  return z / std::sqrt(1 + z * z);
}

}  // namespace

void weigh(Axis& axis, std::int32_t start, std::int64_t low, std::int64_t width) {
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float centre = axis.centre[k] - float(start);
    const float end = g_of(axis, k, centre, float(low + width) - 0.5f);
    axis.weight[k] = axis.weight[k] * (end - g_of(axis, k, centre, float(low) - 0.5f));
  }
}

std::int32_t read_axis(RangeDecoder& in, Axis& axis, std::int32_t start, float size) {
  const float least = sum_by_fours({axis.weight.begin(), axis.weight.end()}) * (1.0f / 256);
  std::vector<float> counting;
  float I = 0;
  PerComponent centre;
  for (std::size_t k = 0; k < kComponents; ++k) {
    centre[k] = axis.centre[k] - float(start);
    counting.push_back(axis.weight[k] > least ? axis.weight[k] : 0.0f);
    if (axis.weight[k] > least) I = std::max(I, axis.inverse_scale[k]);
  }
  const float W = sum_by_fours(counting);
  const auto G = [&](float y) {
    float sum = 0;
    for (std::size_t k = 0; k < kComponents; ++k) {
      if (axis.weight[k] > least) sum += axis.weight[k] * g_of(axis, k, centre[k], y);
    }
    return sum;
  };
  const auto parts_from = [&](std::int64_t low, std::int64_t width, std::size_t n) {
    std::vector<float> sums;
    for (std::size_t k = 1; k <= n; ++k)
      sums.push_back(G(float(low) + float(width) * float(k) - 0.5f));
    return sums;
  };

  // 1.
  const float whole_size = size > 0 ? std::floor(std::min(size, 1e8f)) : 0;
  int bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(whole_size)));
  const std::int64_t step = std::int64_t(1) << bits;
  std::vector<float> sums = parts_from(-4 * step, step, 7);
  sums.push_back(W);
  std::size_t part = in.one_of(sums, -W, 8);
  std::int64_t low = (std::int64_t(part) - 4) * step;
  float below = part > 0 ? sums[part - 1] : -W;
  // 2.
  if (part == 0 || part == 7) {
    const bool up = part == 7;
    float reached = up ? below : sums[0];
    for (bits += 2;; ++bits) {
      const std::int64_t width = std::int64_t(1) << bits, from = width - step;
      low = up ? from : -from - width;
      const float next = G(float(up ? from + width : low) - 0.5f);
      below = up ? reached : next;
      if (bits == 31) break;
      if (up ? in.known(next - reached, W - reached) : in.known(reached - next, reached + W)) break;
      reached = next;
    }
  }
  // 3.
  const float even_width = 1 / I;
  int even = 0;
  while (even < 28 && float(std::int64_t(2) << even) <= even_width) ++even;
  while (bits > even) {
    const int now = std::min(3, bits - even);
    bits -= now;
    const std::int64_t width = std::int64_t(1) << bits;
    sums = parts_from(low, width, std::size_t(1) << now);
    part = in.one_of(sums, below, 8);
    low += std::int64_t(part) * width;
    if (part > 0) below = sums[part - 1];
  }
  // 4.
  const std::int64_t width = std::int64_t(1) << bits;
  weigh(axis, start, low, width);
  low += in.index(static_cast<std::size_t>(width));
  return sum_of(start, static_cast<std::int32_t>(static_cast<std::uint32_t>(low)));
}

std::int32_t round_of(float x) {
  constexpr float kMost = 1 << 30;
  if (!(x > -kMost)) x = -kMost;
  if (x > kMost) x = kMost;
  return static_cast<std::int32_t>(std::floor(x + 0.5f));
}

float excess(float q) {
  return 3 * q / (1 + q) - 1;
}

bool make_shares(PerComponent& weights) {
  const float sum = sum_by_fours({weights.begin(), weights.end()});
  if (!(sum >= 0x1p-126f)) return false;
  for (float& w : weights) w = w * (1 / sum);
  return true;
}

void ComponentWeights::learn(const PerComponent& shares) {
  const float r = 1 / float(std::min(n, 100) + 15);
  ++n;
  for (std::size_t k = 0; k < kComponents; ++k) of[k] += r * (shares[k] - of[k]);
}

void MeanSizes::learn(const Sizes& sizes) {
  if (!has_any) of = sizes;
  has_any = true;
  for (std::size_t j = 0; j < 4; ++j) of[j] += rate * (sizes[j] - of[j]);
}

PerComponent ComponentScales::at(const Sizes& sizes) const {
  PerComponent result;
  for (std::size_t k = 0; k < kComponents; ++k) {
    float b = 0;
    for (std::size_t j = 0; j < 4; ++j) b += slope[group_of(k)][j] * sizes[j];
    result[k] = power_of_2(logarithm[k] + b);
  }
  return result;
}

void ComponentScales::learn(const PerComponent& shares, const PerComponent& excesses,
                            const Sizes& sizes, const Sizes& mean) {
  const float rate = 0.15f + first / (1 + float(n) / 8);
  if (n < 1 << 20) ++n;
  PerComponent step;
  for (std::size_t k = 0; k < kComponents; ++k) {
    step[k] = shares[k] * excesses[k];
    logarithm[k] = std::clamp(logarithm[k] + rate * step[k], -12.0f, 16.0f);
  }
  const std::array<float, 2> sum{step[0] + step[1],
                                 (step[2] + step[3]) + (step[4] + step[5]) + (step[6] + step[7])};
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<float> moved;
    for (std::size_t j = 0; j < 4; ++j) {
      const float away = std::clamp(sizes[j] - mean[j], -2.0f, 2.0f);
      const float next = std::clamp(slope[i][j] + slope_rate * sum[i] * away, -2.0f, 2.0f);
      moved.push_back((next - slope[i][j]) * mean[j]);
      slope[i][j] = next;
    }
    for (std::size_t k = 0; k < kComponents; ++k) {
      if (group_of(k) == i) logarithm[k] -= sum_by_fours(moved);
    }
  }
}

}  // namespace plain
