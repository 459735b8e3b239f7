// Towers of three boxes on rough ground, one on the other: a body, a low drum, a tall spire.
#pragma once

#include "crease/mesh.h"
#include "support/hashed.h"
#include "support/mesh_builder.h"
#include "support/rough_ground.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kSteepleSide = 10;
inline constexpr std::size_t kSteeples = std::size_t(kSteepleSide) * kSteepleSide;
inline constexpr double kDrumAt = 1, kSpireAt = 1.1;  // above ground

inline Mesh steeples() {
  MeshBuilder builder;
  add_rough_ground(builder, kSteepleSide, -0.1);
  constexpr double kGap = 0.001;  // so that no vertex is of two boxes
  for (std::uint32_t i = 0; i < kSteeples; ++i) {
    const Vec3d at{i % kSteepleSide + 0.5, i / kSteepleSide + 0.5, 0};
    const double width = 0.1 + 0.1 * hashed(2 * i), height = 0.5 + hashed(2 * i + 1);
    builder.box(at - Vec3d{0.3, 0.3, 0}, at + Vec3d{0.3, 0.3, kDrumAt - kGap}, 2);
    builder.box(at + Vec3d{-width, -width, kDrumAt}, at + Vec3d{width, width, kSpireAt - kGap}, 2);
    builder.box(at + Vec3d{-0.1, -0.1, kSpireAt}, at + Vec3d{0.1, 0.1, kSpireAt + height}, 2);
  }
  return builder.take();
}

struct SteepleCount {
  std::size_t whole = 0, floating = 0;  // of those that have a spire
};

inline SteepleCount count_steeples(const Mesh& mesh) {
  std::vector<std::array<bool, 2>> has(kSteeples, {false, false});  // a drum, a spire
  for (const Triangle& t : mesh.triangles) {
    Vec3d middle;
    for (const VertexId v : t) middle = middle + mesh.positions[index_of(v)] * (1.0 / 3);
    const std::size_t steeple = std::size_t(middle.x) + std::size_t(middle.y) * kSteepleSide;
    if (middle.z < kDrumAt - 0.0005) continue;
    has[steeple][middle.z > kSpireAt - 0.0005] = true;
  }
  SteepleCount count;
  for (const auto& [drum, spire] : has) {
    if (spire) ++(drum ? count.whole : count.floating);
  }
  return count;
}

}  // namespace crease
