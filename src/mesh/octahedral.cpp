#include "mesh/octahedral.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace crease {

namespace {

std::int32_t with_sign_of(std::int32_t size, std::int64_t sign) {
  return sign < 0 ? -size : size;
}

// Tells zeros apart by their signs.
bool has_bits_of(const Vec3f& a, const Vec3f& b) {
  return std::memcmp(&a, &b, sizeof(Vec3f)) == 0;
}

// A vector as integers of up to 30 bits, which changes its direction by less than 1e-9.
struct ScaledVector {
  std::int64_t x = 0, y = 0, z = 0;
  std::int64_t sum() const { return std::abs(x) + std::abs(y) + std::abs(z); }
};

// Halves away from zero; |x| < 2^62.
std::int64_t rounded(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  const double rest = x - static_cast<double>(whole);
  return whole + (rest >= 0.5) - (rest <= -0.5);
}

ScaledVector scaled(const Vec3d& d) {
  const double largest = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
  if (largest == 0) return {};
  if (!(largest > 1e-200 && largest < 1e200)) {
    const double up = largest > 1 ? 0x1p-500 : 0x1p500;
    return scaled({d.x * up, d.y * up, d.z * up});
  }
  // 2^30 / (the next power of two)
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) >> 52;
  const double scale = std::bit_cast<double>((2 * 1023 + 29 - exponent) << 52);
  return {rounded(d.x * scale), rounded(d.y * scale), rounded(d.z * scale)};
}

// round(m * part / whole), halves away from zero. The quotient of doubles is cut as that of
// integers would be: of fewer than 2^33 parts each, it is 2^-33 at least below the next one, or
// that.
std::int32_t rounded_share(std::int32_t m, std::int64_t part, std::int64_t whole) {
  const double size =
      static_cast<double>(2 * m * std::abs(part) + whole) / static_cast<double>(2 * whole);
  return with_sign_of(static_cast<std::int32_t>(size), part);
}

}  // namespace

OctahedralCoding::OctahedralCoding(int bits) : m_(((1 << (bits - 1)) - 1) / 6 * 6) {
  CREASE_ASSERT(bits >= kMinBits && bits <= kMaxBits);
}

OctahedralCoding::Point OctahedralCoding::point_of(OctahedralCode code) const {
  return {static_cast<std::int32_t>(code.u) - m_, static_cast<std::int32_t>(code.v) - m_};
}

OctahedralCode OctahedralCoding::code_of(Point p) const {
  return {static_cast<std::uint32_t>(p.x + m_), static_cast<std::uint32_t>(p.y + m_)};
}

// Over the diamond's sides: the point with -z instead of z. Its own inverse on canonical points.
OctahedralCoding::Point OctahedralCoding::folded(Point p) const {
  return {with_sign_of(m_ - std::abs(p.y), p.x), with_sign_of(m_ - std::abs(p.x), p.y)};
}

// One step beyond the square's side is inside its other half.
OctahedralCoding::Point OctahedralCoding::inside(Point p) const {
  if (std::abs(p.x) > m_) p = {with_sign_of(2 * m_ - std::abs(p.x), p.x), -p.y};
  if (std::abs(p.y) > m_) p = {-p.x, with_sign_of(2 * m_ - std::abs(p.y), p.y)};
  return p;
}

OctahedralCoding::Point OctahedralCoding::settled(Point p) const {
  if (std::abs(p.x) == m_) p.y = std::abs(p.y);
  if (std::abs(p.y) == m_) p.x = std::abs(p.x);
  return p;
}

OctahedralCode OctahedralCoding::canonical(OctahedralCode code) const {
  return code == kZero ? code : code_of(settled(point_of(code)));
}

bool OctahedralCoding::is_canonical(OctahedralCode code) const {
  return code.u <= max_component() && code.v <= max_component() && canonical(code) == code;
}

OctahedralCode OctahedralCoding::encode(const Vec3d& direction) const {
  const ScaledVector d = scaled(direction);
  const std::int64_t sum = d.sum();
  if (sum == 0) return kZero;
  Point near{rounded_share(m_, d.x, sum), rounded_share(m_, d.y, sum)};
  if (d.z < 0) {
    near = {with_sign_of(m_ - std::abs(near.y), d.x), with_sign_of(m_ - std::abs(near.x), d.y)};
  }
  // On a face of the octahedron the codes are a lattice of equilateral triangles, which the square
  // shears: the nearest is the rounded one or one of its eight neighbours.
  std::array<Point, 9> points;
  std::array<double, 9> along, squared, cosine2;
  const bool is_inside = std::abs(near.x) < m_ - 1 && std::abs(near.y) < m_ - 1;
  for (std::int32_t i = 0; i < 9; ++i) {
    Point p{near.x + i % 3 - 1, near.y + i / 3 - 1};
    points[std::size_t(i)] = is_inside ? p : settled(inside(p));
  }
  double most = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const Vec3i n = octahedral_vector(m_, points[i].x, points[i].y);
    along[i] = static_cast<double>(d.x * n.x + d.y * n.y + d.z * n.z);  // 47 bits: exact
    squared[i] = static_cast<double>(std::int64_t(n.x) * n.x + std::int64_t(n.y) * n.y +
                                     std::int64_t(n.z) * n.z);
    cosine2[i] = along[i] > 0 ? along[i] * along[i] / squared[i] : 0;
    most = std::max(most, cosine2[i]);
  }
  // Mostly one is the nearest by far, else roots tell, and of equals the first.
  OctahedralCode best{};
  double best_cosine = -1e300;
  for (std::size_t i = 0; i < 9; ++i) {
    if (cosine2[i] < most * (1 - 1e-12)) continue;
    const double cosine = along[i] / std::sqrt(squared[i]);
    const OctahedralCode code = code_of(points[i]);
    const bool first = code.v != best.v ? code.v < best.v : code.u < best.u;
    if (cosine < best_cosine || (cosine == best_cosine && !first)) continue;
    best = code;
    best_cosine = cosine;
  }
  return best;
}

// What was decoded lies so near to its lattice point that rounding finds it.
std::optional<OctahedralCode> OctahedralCoding::exact_code(const Vec3f& direction) const {
  if (has_bits_of(direction, {})) return kZero;
  const double x = double(direction.x), y = double(direction.y), z = double(direction.z);
  const double sum = std::abs(x) + std::abs(y) + std::abs(z);
  if (!(sum < 2)) return std::nullopt;  // no unit vector has more
  const double scale = m_ / sum;
  Point p{static_cast<std::int32_t>(std::lround(x * scale)),
          static_cast<std::int32_t>(std::lround(y * scale))};
  if (z < 0) p = {with_sign_of(m_ - std::abs(p.y), p.x), with_sign_of(m_ - std::abs(p.x), p.y)};
  const OctahedralCode code = code_of(settled(p));
  if (code == kZero || !has_bits_of(decode(code), direction)) return std::nullopt;
  return code;
}

Vec3f OctahedralCoding::decode(OctahedralCode code) const {
  CREASE_ASSERT(code.u <= max_component() && code.v <= max_component());
  return octahedral_direction(max_component(), code);
}

namespace {

template <typename Point>
Point turned(Point p, int quarter_turns) {
  for (int i = 0; i < quarter_turns; ++i) p = {-p.y, p.x};
  return p;
}

}  // namespace

OctahedralCoding::Frame OctahedralCoding::frame_of(OctahedralCode predicted) const {
  Frame frame;
  frame.predicted = predicted == kZero ? Point{0, 0} : point_of(predicted);
  frame.flip = std::abs(frame.predicted.x) + std::abs(frame.predicted.y) > m_;
  if (frame.flip) frame.predicted = folded(frame.predicted);
  while (frame.turns < 4 && !(frame.predicted.x > 0 && frame.predicted.y >= 0) &&
         !(frame.predicted.x == 0 && frame.predicted.y == 0)) {
    frame.predicted = turned(frame.predicted, 1);
    ++frame.turns;
  }
  return frame;
}

// Into [-m, m], around the square.
std::int32_t OctahedralCoding::wrapped(std::int64_t x) const {
  const std::int64_t span = 2 * std::int64_t(m_) + 1;
  const std::int64_t rest = (x + m_) % span;
  return static_cast<std::int32_t>((rest < 0 ? rest + span : rest) - m_);
}

// In the turned frame canonical codes have the sign of the prediction at the square's sides: of two
// codes of one direction it is the nearer one. The zero vector keeps the corner that no canonical
// code has.
OctahedralResidual OctahedralCoding::residual(OctahedralCode code, const Frame& frame) const {
  Point p = point_of(code);
  if (code != kZero) {
    if (frame.flip) p = folded(p);
    p = settled(turned(p, frame.turns));
  }
  return {wrapped(std::int64_t(p.x) - frame.predicted.x),
          wrapped(std::int64_t(p.y) - frame.predicted.y)};
}

OctahedralCode OctahedralCoding::near(float x, float y) const {
  const auto rounded = [&](float c) {  // cut off from above zero
    const std::int32_t up = static_cast<std::int32_t>(c + (static_cast<float>(m_) + 0.5f)) - m_;
    return std::clamp(up, -m_, m_);
  };
  return code_of(settled({rounded(x), rounded(y)}));
}

OctahedralCode OctahedralCoding::restore(OctahedralResidual residual, const Frame& frame) const {
  Point p{wrapped(std::int64_t(residual.x) + frame.predicted.x),
          wrapped(std::int64_t(residual.y) + frame.predicted.y)};
  if (code_of(p) == kZero) return kZero;
  p = settled(turned(settled(p), 4 - frame.turns));
  if (frame.flip) p = folded(p);
  return code_of(settled(p));
}

std::optional<int> octahedral_bits_of(std::span<const float> directions) {
  constexpr int kFewestBits = 8;
  if (directions.empty()) return std::nullopt;
  for (int bits = kFewestBits; bits <= OctahedralCoding::kMaxBits; ++bits) {
    const OctahedralCoding coding(bits);
    std::size_t i = 0;
    while (i < directions.size() &&
           coding.exact_code({directions[i], directions[i + 1], directions[i + 2]})) {
      i += 3;
    }
    if (i == directions.size()) return bits;
  }
  return std::nullopt;
}

}  // namespace crease
