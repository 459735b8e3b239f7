// Where a vertex may be, as a mixture (axis_mixture.h) along each of three axes, one after the
// other. Floats without fused products, as in predict_position.h.
#pragma once

#include "codec/axis_mixture.h"
#include "codec/seen_coordinates.h"
#include "codec/spot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

// A place as a mixture: what each component expects on two axes and, less what the tangent plane
// rises over them, on the third, the one nearest to the normal.
// Afterwards the excesses say how much farther off each component was than it expected.
struct PlaceMixture {
  std::array<PerComponent, 3> center{};
  PerComponent weight{}, tangent{}, normal{};  // of being right; how far off then
  std::array<float, 3> direction{0, 0, 1};     // of the normal along the axes, of unit length
  PerComponent tangent_excess{}, normal_excess{};
};

// How far a step along the first two axes leads along the third in the tangent plane.
inline float rise(const std::array<float, 3>& normal, float first, float second) {
  return -(normal[0] * first + normal[1] * second) / normal[2];
}
inline EightFloats rise(const std::array<float, 3>& normal, const EightFloats& first,
                        const EightFloats& second) {
  return 0.0f - (normal[0] * first + normal[1] * second) / normal[2];
}
// Eight places' x, y and z, each of all eight.
[[gnu::always_inline]] inline std::array<EightFloats, 3> coordinates_of(
    const std::array<Spot, kComponents>& p) {
  const auto low = coordinates_of(p[0], p[1], p[2], p[3]);
  const auto high = coordinates_of(p[4], p[5], p[6], p[7]);
  return {EightFloats(low[0], high[0]), {low[1], high[1]}, {low[2], high[2]}};
}
inline std::int32_t rounded(float x) {
  constexpr float kLimit = 1 << 30;
  if (!(x > -kLimit)) x = -kLimit;  // or not a number
  const float up = (x < kLimit ? x : kLimit) + 0.5f;
  const std::int32_t cut = static_cast<std::int32_t>(up);
  return cut - (static_cast<float>(cut) > up);
}

// How distributions' scales should grow where they were off by z: the slope of their logarithm by
// that of the scale, less where what no scale goes below is much of it.
inline EightFloats excess(const EightFloats& z2, float least, const EightFloats& inverse_scale) {
  return (3.0f * z2 / (1.0f + z2) - 1.0f) * (1.0f - least * inverse_scale);
}

// Leaves in `mixture.weight` how likely each component was right.
template <class Coder>
std::array<std::int32_t, 3> code_place(Coder& coder, PlaceMixture& mixture,
                                       const std::array<std::int32_t, 3>& place, SeenPlace& seen) {
  constexpr float kLeast = 0.2f;  // of scales, beside which the grid is coarse
  const auto& [n0, n1, n2] = mixture.direction;
  const float across = std::sqrt(std::max(1 - n0 * n0, 0.0f));
  AxisMixture axis;
  axis.weight = mixture.weight;
  axis.center = mixture.center[0];
  const EightFloats tangent(mixture.tangent);
  EightFloats scale = tangent * across + kLeast, inverse = 1.0f / scale;
  inverse.store(axis.inverse_scale);
  const auto code_along = [&](std::size_t i, std::int32_t less, std::int32_t value) {
    const std::int32_t start = rounded(axis.center[0]);
    return seen.code(coder, i, less, axis, start, value, [&](std::int32_t other) {
      return code_axis(coder, axis, start, scale.low[0], other);
    });
  };
  std::array<std::int32_t, 3> result;
  result[0] = code_along(0, 0, place[0]);

  // A step along the first axis leads some way along the second; one that is long for a component
  // makes it expect more there as well.
  const float place_0 = static_cast<float>(result[0]);
  const float along = n0 * n1 / (across * across), rest = std::abs(n2) / across;
  const EightFloats off = place_0 - EightFloats(axis.center);
  EightFloats z = off * inverse;
  const EightFloats first_excess = excess(z * z, kLeast, inverse);
  scale = tangent * rest * root(0.5f + 0.5f * z * z) + kLeast;
  inverse = 1.0f / scale;
  inverse.store(axis.inverse_scale);
  (EightFloats(mixture.center[1]) - along * off).store(axis.center);
  result[1] = code_along(1, 0, place[1]);

  const float place_1 = static_cast<float>(result[1]);
  z = (place_1 - EightFloats(axis.center)) * inverse;
  (first_excess + excess(z * z, kLeast, inverse)).store(mixture.tangent_excess);
  axis.center = mixture.center[2];
  scale = EightFloats(mixture.normal) * (1 / std::abs(n2)) + kLeast;
  inverse = 1.0f / scale;
  inverse.store(axis.inverse_scale);
  const std::uint32_t plane =
      static_cast<std::uint32_t>(rounded(rise(mixture.direction, place_0, place_1)));
  const std::int32_t above =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(place[2]) - plane);
  const std::int32_t beside = code_along(2, static_cast<std::int32_t>(plane), above);
  const float beside_as_float = static_cast<float>(beside);
  z = (beside_as_float - EightFloats(axis.center)) * inverse;
  excess(z * z, kLeast, inverse).store(mixture.normal_excess);
  result[2] = static_cast<std::int32_t>(static_cast<std::uint32_t>(beside) + plane);
  mixture.weight = axis.weight;
  return result;
}

// Where along `axis` (of the mixture's three) a child is whose other two coordinates are known, as
// a number of steps: `offset` + `per_unit` * coordinate, rounded. Leaves in `mixture` what
// code_place() does, as far as that can be told.
template <class Coder>
std::int32_t code_steps(Coder& coder, PlaceMixture& mixture, std::size_t axis,
                        const std::array<std::int32_t, 3>& place, float offset, float per_unit,
                        std::int32_t steps) {
  constexpr float kLeast = 0.2f, kLeastOfAxis = 0.1f;
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto& n = mixture.direction;
  float along = n[axis];
  if (std::abs(along) < kLeastOfAxis) along = along < 0 ? -kLeastOfAxis : kLeastOfAxis;
  const float plane =
      -(n[i] * static_cast<float>(place[i]) + n[j] * static_cast<float>(place[j])) / along;
  AxisMixture of;
  of.weight = mixture.weight;
  const EightFloats center = plane + EightFloats(mixture.center[2]) * (n[2] / along);
  const EightFloats from = offset + per_unit * center;
  const EightFloats scale =
      EightFloats(mixture.normal) * (std::abs(per_unit) / std::abs(along)) + kLeast;
  const EightFloats inverse = 1.0f / scale;
  from.store(of.center);
  inverse.store(of.inverse_scale);
  steps = code_axis(coder, of, rounded(of.center[0]), scale.low[0], steps);
  const float steps_as_float = static_cast<float>(steps);
  const EightFloats z = (steps_as_float - from) * inverse;
  mixture.tangent_excess.fill(0);
  excess(z * z, kLeast, inverse).store(mixture.normal_excess);
  mixture.weight = of.weight;
  return steps;
}

}  // namespace crease::codec
