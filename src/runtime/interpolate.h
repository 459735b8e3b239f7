// Where something is that is on its way: positions along a segment, normals along the sphere.
#pragma once

#include "crease/vec.h"

#include <algorithm>
#include <cmath>

namespace crease {

// `share` 0: at `from`, 1 and more: exactly at `to`.
inline Vec3f lerp(const Vec3f& from, const Vec3f& to, float share) {
  return share >= 1 ? to : from + (to - from) * std::max(share, 0.0f);
}

// Along the shorter arc, at even speed; where there are two, along one of them.
inline Vec3f slerp(const Vec3f& from, const Vec3f& to, float share) {
  if (share >= 1 || from == Vec3f{} || to == Vec3f{}) return to;
  if (share <= 0) return from;
  const float cosine = std::clamp(dot(from, to), -1.0f, 1.0f);
  Vec3f aside = to - from * cosine;
  if (length(aside) < 1e-3f) {
    if (cosine > 0) return normalized(lerp(from, to, share));
    aside = std::fabs(from.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    aside = aside - from * dot(from, aside);
  }
  const float angle = share * std::acos(cosine);
  return normalized(from * std::cos(angle) + normalized(aside) * std::sin(angle));
}

}  // namespace crease
