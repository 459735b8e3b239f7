// Where numbers of an attribute go from what is around: an affine map over the tangent plane,
// fitted to the values that are known, the nearest with the most weight.
//
//   ValuePrediction expected = predict_value(samples, normal, dimension);
#pragma once

#include "codec/coded_numbers.h"
#include "codec/deterministic_math.h"
#include "codec/patch_mesh.h"
#include "codec/spot.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

// Of the size of their difference.
inline std::uint32_t bits_between(std::int32_t a, std::int32_t b) {
  const std::int32_t off = wrapped_difference(a, b);
  const std::uint32_t size =
      off < 0 ? 0u - static_cast<std::uint32_t>(off) : static_cast<std::uint32_t>(off);
  return static_cast<std::uint32_t>(std::bit_width(size));
}

struct ValueSample {
  Spot at{};  // from the vertex
  CodedValue value{};
};

struct ValuePrediction {
  CodedValue value{};
  std::size_t doubt = 0;  // below kDoubts: by how far the samples are off the map
};
inline constexpr std::size_t kDoubts = 16;

// `normal` of any length. Of no samples it is zero.
inline ValuePrediction predict_value(std::span<const ValueSample> samples, const Spot& normal,
                                     std::size_t dimension) {
  ValuePrediction result;
  if (samples.empty()) {
    result.doubt = kDoubts - 1;
    return result;
  }
  const Spot sizes = size_of_each(normal);
  std::size_t third = 0;
  for (std::size_t k = 1; k < 3; ++k) third = sizes[k] > sizes[third] ? k : third;
  const std::size_t first = (third + 1) % 3, second = (third + 2) % 3;
  float squares = 0;
  for (const ValueSample& s : samples) squares += dot(s.at, s.at);
  const float near = squares > 0 ? 0.05f * (squares / static_cast<float>(samples.size())) : 1.0f;

  const CodedValue base = samples[0].value;
  float weights = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
  FourFloats u{}, au{}, bu{};
  const auto value_of = [&](const ValueSample& s) {
    FourFloats value{};
    for (std::size_t k = 0; k < dimension; ++k) {
      value[k] = static_cast<float>(wrapped_difference(s.value[k], base[k]));
    }
    return value;
  };
  for (const ValueSample& s : samples) {
    const float weight = 1 / (dot(s.at, s.at) + near), x = s.at[first], y = s.at[second];
    const FourFloats value = value_of(s);
    weights += weight;
    a += weight * x;
    b += weight * y;
    aa += weight * x * x;
    ab += weight * x * y;
    bb += weight * y * y;
    u += value * weight;
    au += value * (weight * x);
    bu += value * (weight * y);
  }
  const float mean_a = a / weights, mean_b = b / weights;
  aa -= a * mean_a;
  ab -= a * mean_b;
  bb -= b * mean_b;
  const float ridge = 0.006f * (aa + bb);
  aa += ridge;
  bb += ridge;
  au -= u * mean_a;
  bu -= u * mean_b;
  const float determinant = aa * bb - ab * ab;
  FourFloats along_a{}, along_b{};
  if (determinant > 0) {
    const float inverse = 1 / determinant;
    along_a = (au * bb - bu * ab) * inverse;
    along_b = (bu * aa - au * ab) * inverse;
  }
  const FourFloats mean = u * (1 / weights);
  const FourFloats here = mean - along_a * mean_a - along_b * mean_b;
  FourFloats off{};
  for (const ValueSample& s : samples) {
    const float weight = 1 / (dot(s.at, s.at) + near);
    const FourFloats rest = value_of(s) - here - along_a * s.at[first] - along_b * s.at[second];
    off += rest * rest * weight;
  }
  float all = 0;
  for (std::size_t k = 0; k < dimension; ++k) {
    const float x = here[k] + 0.5f;
    const bool is_near = x > -1e9f && x < 1e9f;
    result.value[k] = wrapped_sum(base[k], is_near ? static_cast<std::int32_t>(std::floor(x)) : 0);
    all += off[k];
  }
  const float doubt = rough_log2(std::min(all / weights, 1e12f) + 1) * 0.5f;
  result.doubt = std::min(static_cast<std::size_t>(doubt), kDoubts - 1);
  return result;
}

}  // namespace crease::codec
