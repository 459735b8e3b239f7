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

FloatVector Octahedral::direction(const Code& code) const {
  if (is_zero_code(code)) return {};
  const Point n = vector(point(code));
  const std::int64_t x = n.x, y = n.y, z = n.z;
  const double root = std::sqrt(double(x * x + y * y + z * z));
  return {float(double(x) / root), float(double(y) / root), float(double(z) / root)};
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

std::array<float, 2> Octahedral::on_plane(const FloatVector& d, float S, bool flipped) const {
  const float m = float(m_), unit = m / S, x = d.x * unit, y = d.y * unit;
  if ((d.z < 0) == flipped) return {x, y};
  return {std::copysign(m - std::abs(y), x), std::copysign(m - std::abs(x), y)};
}

Code Octahedral::rough(const FloatVector& d) const {
  const float S = length_1(d);
  if (!(S > 0)) return {};
  const std::array<float, 2> p = on_plane(d, S, false);
  const auto whole = [&](float x) {
    return std::clamp(static_cast<std::int32_t>(x + (float(m_) + 0.5f)) - m_, -m_, m_);
  };
  return code(settle({whole(p[0]), whole(p[1])}));
}

std::array<float, 2> Octahedral::near(const FloatVector& d, const Frame& frame) const {
  const float S = length_1(d);
  if (!(S > 0)) return {0, 0};
  auto [x, y] = on_plane(d, S, frame.flipped);
  for (int i = 0; i < frame.turns; ++i) {
    const float turned_x = -y;
    y = x;
    x = turned_x;
  }
  return {x - float(frame.point.x), y - float(frame.point.y)};
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
