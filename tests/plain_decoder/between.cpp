#include "plain_decoder/between.h"

#include "plain_decoder/tables.h"

#include <bit>

namespace plain {

namespace {

std::array<AdaptiveBit, 4> start_at(const std::array<double, 4>& q) {
  return {AdaptiveBit(q[0], 24), AdaptiveBit(q[1], 24), AdaptiveBit(q[2], 24),
          AdaptiveBit(q[3], 24)};
}

std::int64_t rounded_quotient(std::int64_t a, std::int64_t b, std::int64_t eighths) {
  const std::int64_t sum = (8 - eighths) * a + eighths * b + 4;
  return sum >= 0 ? sum / 8 : -((7 - sum) / 8);
}

}  // namespace

BetweenModel::BetweenModel()
    : in_middle_(start_at(kInMiddle)),
      to_nearer_(start_at(kToNearer)),
      third_axis_(start_at(kThirdAxis)),
      is_one_{start_at(kIsOne[0]), start_at(kIsOne[1])},
      is_two_{start_at(kIsTwo[0]), start_at(kIsTwo[1])} {}

Between BetweenModel::read(RangeDecoder& in, float f, float g, const std::array<float, 3>& normal) {
  Between result;
  result.eighths = read_eighths(in, f, g);
  result.axis = read_axis(in, normal);
  return result;
}

std::int64_t BetweenModel::read_eighths(RangeDecoder& in, float f, float g) {
  const bool first_is_nearer = f <= g;
  const float lesser = first_is_nearer ? f : g;
  const std::size_t c =
      f + g > 0 ? std::min<std::size_t>(static_cast<std::size_t>(8 * lesser / (f + g)), 3) : 3;
  if (in_middle_[c].read(in)) return 4;
  const bool to_nearer = to_nearer_[c].read(in);
  std::int64_t away = 3;
  if (is_one_[to_nearer][c].read(in)) {
    away = 1;
  } else if (is_two_[to_nearer][c].read(in)) {
    away = 2;
  }
  const bool to_first = first_is_nearer ? to_nearer : !to_nearer;
  return to_first ? 4 - away : 4 + away;
}

std::size_t BetweenModel::read_axis(RangeDecoder& in, const std::array<float, 3>& normal) {
  const float n0 = std::abs(normal[0]), n1 = std::abs(normal[1]), n2 = std::abs(normal[2]);
  const std::size_t c =
      n2 > 0 ? static_cast<std::size_t>(std::min(4 * std::max(n0, n1) / n2, 3.0f)) : 0;
  if (third_axis_[c].read(in)) return 2;
  return second_axis_[n1 > n0].read(in) ? 1 : 0;
}

std::int32_t read_other(RangeDecoder& in, std::int32_t b, std::int64_t whole,
                        std::int64_t eighths) {
  // The least a, found by trying from near it on.
  std::int64_t least = (8 * whole - eighths * b) / (8 - eighths) - 10;
  while (rounded_quotient(least, b, eighths) < whole) ++least;
  std::size_t count = 0;
  while (rounded_quotient(least + std::int64_t(count), b, eighths) == whole) ++count;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(least)) +
                                   in.index(count));
}

std::int64_t step_of(std::int64_t apart_1, std::int64_t apart_2) {
  const auto greater = static_cast<std::uint64_t>(std::max(std::abs(apart_1), std::abs(apart_2)));
  const int w = static_cast<int>(std::bit_width(greater));
  return w < 6 ? 1 : std::int64_t(1) << (w - 6);
}

}  // namespace plain
