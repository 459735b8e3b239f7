#include "plain_decoder/octahedral.h"

#include <cstdlib>

namespace plain {

namespace {

// "s(a, b)".
template <class Number, class Sign>
Number s(Number a, Sign b) {
  return b < 0 ? -a : a;
}

Octahedral::Flat turn(Octahedral::Flat p) {
  return {-p.y, p.x};
}

bool is_zero_code(const Code& code) {
  return code[0] == 0 && code[1] == 0;
}

// n / d to the nearest whole number, halves away from zero; d > 0.
std::int64_t share(std::int64_t n, std::int64_t d) {
  return s((2 * std::abs(n) + d) / (2 * d), n);
}

std::int64_t rounded_away(double x) {
  return std::llround(x);
}

}  // namespace

Octahedral::Flat Octahedral::fold(Flat p) const {
  return {s(m_ - std::abs(p.y), p.x), s(m_ - std::abs(p.x), p.y)};
}

Point Octahedral::vector(Flat p) const {
  const std::int32_t z = m_ - std::abs(p.x) - std::abs(p.y);
  if (z < 0) p = fold(p);
  return {p.x, p.y, z};
}

Octahedral::Flat Octahedral::settle(Flat p) const {
  if (std::abs(p.x) == m_) p.y = std::abs(p.y);
  if (std::abs(p.y) == m_) p.x = std::abs(p.x);
  return p;
}

Vector Octahedral::direction(const Code& code) const {
  if (is_zero_code(code)) return {};
  const Point n = vector(point(code));
  const std::int64_t x = n.x, y = n.y, z = n.z;
  const double root = std::sqrt(double(x * x + y * y + z * z));
  return {double(float(double(x) / root)), double(float(double(y) / root)),
          double(float(double(z) / root))};
}

Code Octahedral::encode(const Vector& d) const {
  const double greatest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (greatest == 0) return {};
  int e = 0;
  std::frexp(greatest, &e);
  const std::int64_t X = rounded_away(std::ldexp(d.x, 30 - e));
  const std::int64_t Y = rounded_away(std::ldexp(d.y, 30 - e));
  const std::int64_t Z = rounded_away(std::ldexp(d.z, 30 - e));
  const std::int64_t S = std::abs(X) + std::abs(Y) + std::abs(Z);
  Flat middle{static_cast<std::int32_t>(share(m_ * X, S)),
              static_cast<std::int32_t>(share(m_ * Y, S))};
  if (Z < 0) middle = {s(m_ - std::abs(middle.y), X), s(m_ - std::abs(middle.x), Y)};
  Code best{};
  double greatest_cosine = 0;
  bool has_best = false;
  for (std::int32_t dy = -1; dy <= 1; ++dy) {
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      Flat p{middle.x + dx, middle.y + dy};
      if (std::abs(p.x) > m_) p = {s(2 * m_ - std::abs(p.x), p.x), -p.y};
      if (std::abs(p.y) > m_) p = {-p.x, s(2 * m_ - std::abs(p.y), p.y)};
      p = settle(p);
      const Point n = vector(p);
      const std::int64_t x = n.x, y = n.y, z = n.z;
      const double cosine =
          double(X * x + Y * y + Z * z) / std::sqrt(double(x * x + y * y + z * z));
      const Code c = code(p);
      const bool comes_first = c[1] != best[1] ? c[1] < best[1] : c[0] < best[0];
      if (!has_best || cosine > greatest_cosine || (cosine == greatest_cosine && comes_first)) {
        best = c;
        greatest_cosine = cosine;
        has_best = true;
      }
    }
  }
  return best;
}

Octahedral::Frame Octahedral::frame(const Code& code) const {
  Frame f;
  if (!is_zero_code(code)) f.point = point(code);
  f.flipped = std::abs(f.point.x) + std::abs(f.point.y) > m_;
  if (f.flipped) f.point = fold(f.point);
  const auto is_there = [](Flat p) { return (p.x > 0 && p.y >= 0) || (p.x == 0 && p.y == 0); };
  while (!is_there(f.point)) {
    f.point = turn(f.point);
    ++f.turns;
  }
  return f;
}

std::array<double, 2> Octahedral::near(const Vector& d, const Frame& frame) const {
  const double S = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  if (!(S > 0)) return {0, 0};
  double x = d.x * m_ / S, y = d.y * m_ / S;
  if ((d.z < 0) != frame.flipped) {
    const double folded_x = std::copysign(m_ - std::abs(y), x);
    const double folded_y = std::copysign(m_ - std::abs(x), y);
    x = folded_x;
    y = folded_y;
  }
  for (int i = 0; i < frame.turns; ++i) {
    const double turned_x = -y;
    y = x;
    x = turned_x;
  }
  return {x - frame.point.x, y - frame.point.y};
}

std::int32_t Octahedral::brought_round(std::int64_t x) const {
  const std::int64_t span = 2 * std::int64_t(m_) + 1;
  std::int64_t rest = (x + m_) % span;
  if (rest < 0) rest += span;
  return static_cast<std::int32_t>(rest - m_);
}

Code Octahedral::restore(std::int32_t x, std::int32_t y, const Frame& frame) const {
  Flat p{brought_round(std::int64_t(x) + frame.point.x),
         brought_round(std::int64_t(y) + frame.point.y)};
  if (p.x == -m_ && p.y == -m_) return {};
  p = settle(p);
  for (int i = frame.turns; i < 4; ++i) p = turn(p);
  p = settle(p);
  if (frame.flipped) p = fold(p);
  return code(settle(p));
}

}  // namespace plain
