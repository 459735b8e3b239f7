// Boxes of many sizes on rough ground, none of which touches it or another one.
#pragma once

#include "crease/mesh.h"
#include "support/hashed.h"
#include "support/mesh_builder.h"
#include "support/rough_ground.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kVillageSide = 12;  // boxes
inline constexpr std::size_t kBoxes = std::size_t(kVillageSide) * kVillageSide;

inline Mesh village() {
  MeshBuilder builder;
  add_rough_ground(builder, kVillageSide, 0);
  for (std::uint32_t i = 0; i < kBoxes; ++i) {
    const Vec3d low{i % kVillageSide + 0.1, i / kVillageSide + 0.1, 0.2};
    builder.box(low,
                low + Vec3d{0.3 + 0.5 * hashed(3 * i), 0.3 + 0.5 * hashed(3 * i + 1),
                            0.3 + 0.5 * hashed(3 * i + 2)},
                3);
  }
  return builder.take();
}

// The area of each box.
inline std::vector<double> box_areas(const Mesh& mesh) {
  std::vector<double> areas(kBoxes, 0);
  for (const Triangle& t : mesh.triangles) {
    Vec3d at[3];
    for (std::size_t c = 0; c < 3; ++c) at[c] = mesh.positions[index_of(t[c])];
    const Vec3d middle = (at[0] + at[1] + at[2]) * (1.0 / 3);
    if (std::min({at[0].z, at[1].z, at[2].z}) < 0.15) continue;  // the ground
    const std::size_t box = std::size_t(middle.x) + std::size_t(middle.y) * kVillageSide;
    areas[std::min(box, kBoxes - 1)] += 0.5 * length(cross(at[1] - at[0], at[2] - at[0]));
  }
  return areas;
}

struct BoxCount {
  std::size_t whole = 0, broken = 0, gone = 0;
};

// Of a level.
inline BoxCount count_boxes(const Mesh& input, const Mesh& level) {
  const std::vector<double> before = box_areas(input), now = box_areas(level);
  BoxCount count;
  for (std::size_t i = 0; i < kBoxes; ++i) {
    const double share = now[i] / before[i];
    ++(share == 0 ? count.gone : share > 0.99 && share < 1.01 ? count.whole : count.broken);
  }
  return count;
}

}  // namespace crease
