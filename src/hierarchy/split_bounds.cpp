#include "crease/split_bounds.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease {

RoundedUp RoundedUp::from(float value) {
  CREASE_ASSERT(value >= 0);
  constexpr std::uint32_t kCut = 15;  // the sign is 0
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::uint16_t>((bits + ((1u << kCut) - 1)) >> kCut)};
}

float RoundedUp::value() const {
  return std::bit_cast<float>(std::uint32_t(bits) << 15);
}

namespace {

constexpr float kAxisSteps = 127;
constexpr float kAngleSteps = 255;

float sign_of(float f) {
  return f < 0 ? -1.0f : 1.0f;
}

Vec3f unpack_axis(const std::array<std::int8_t, 2>& packed) {
  float x = packed[0] / kAxisSteps, y = packed[1] / kAxisSteps;
  const float z = 1 - std::fabs(x) - std::fabs(y);
  if (z < 0) {
    const float folded = (1 - std::fabs(y)) * sign_of(x);
    y = (1 - std::fabs(x)) * sign_of(y);
    x = folded;
  }
  return normalized(Vec3f{x, y, z});
}

std::array<std::int8_t, 2> pack_axis(const Vec3f& axis) {
  const float sum = std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z);
  float x = axis.x / sum, y = axis.y / sum;
  if (axis.z < 0) {
    const float folded = (1 - std::fabs(y)) * sign_of(x);
    y = (1 - std::fabs(x)) * sign_of(y);
    x = folded;
  }
  return {static_cast<std::int8_t>(std::lround(x * kAxisSteps)),
          static_cast<std::int8_t>(std::lround(y * kAxisSteps))};
}

}  // namespace

NormalCone SplitBounds::cone() const {
  return {unpack_axis(cone_axis), cone_angle * float(kPi) / kAngleSteps};
}

void SplitBounds::set_cone(const NormalCone& cone) {
  cone_axis = {};
  cone_angle = 255;
  if (!(cone.half_angle_rad >= 0) || cone.axis == Vec3f{}) return;
  cone_axis = pack_axis(cone.axis);
  const Vec3f axis = unpack_axis(cone_axis);
  const float off = std::atan2(length(cross(axis, cone.axis)), dot(axis, cone.axis));
  constexpr float kRounding = 1e-5f;  // of the floats here
  const float steps = (cone.half_angle_rad + off + kRounding) * (kAngleSteps / float(kPi));
  cone_angle = static_cast<std::uint8_t>(std::min(255.0f, std::ceil(steps)));
}

}  // namespace crease
