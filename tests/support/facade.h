// A wall with windows of many sizes, every second of them set back, above rough ground.
#pragma once

#include "crease/mesh.h"
#include "support/hashed.h"
#include "support/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kFacadeSide = 12;  // windows
inline constexpr std::size_t kWindows = std::size_t(kFacadeSide) * kFacadeSide;
inline constexpr std::uint32_t kWallMaterial = 0, kGlassMaterial = 1, kGroundMaterial = 2;

// The wall stands at y = 0, a window in each square of side 1; the ground is at negative z.
inline Mesh facade() {
  MeshBuilder builder;
  std::vector<MaterialId> materials;
  const auto quad = [&](const std::array<Vec3d, 4>& at, AttributeId normal,
                        std::uint32_t material) {
    builder.quad({builder.at(at[0]), builder.at(at[1]), builder.at(at[2]), builder.at(at[3])},
                 normal);
    materials.insert(materials.end(), 2, MaterialId{material});
  };
  const AttributeId front = builder.normal({0, -1, 0});
  for (std::uint32_t i = 0; i < kWindows; ++i) {
    const double x = i % kFacadeSide, z = i / kFacadeSide;
    const double width = 0.3 + 0.3 * hashed(2 * i), height = 0.3 + 0.3 * hashed(2 * i + 1);
    const std::array<Vec3d, 4> outer{
        Vec3d{x, 0, z}, {x + 1, 0, z}, {x + 1, 0, z + 1}, {x, 0, z + 1}};
    std::array<Vec3d, 4> rim, pane;
    for (int k = 0; k < 4; ++k) {
      const bool right = k == 1 || k == 2, top = k >= 2;
      rim[k] = {x + 0.5 + (right ? 0.5 : -0.5) * width, 0, z + 0.5 + (top ? 0.5 : -0.5) * height};
      pane[k] = rim[k] + Vec3d{0, i % 2 == 0 ? 0 : 0.05, 0};
    }
    for (int k = 0; k < 4; ++k) {
      const int next = (k + 1) % 4;
      quad({outer[k], outer[next], rim[next], rim[k]}, front, kWallMaterial);
      if (i % 2 == 0) continue;
      const Vec3d edge = rim[next] - rim[k];
      quad({rim[k], rim[next], pane[next], pane[k]}, builder.normal(cross(edge, Vec3d{0, 1, 0})),
           kWallMaterial);
    }
    quad(pane, front, kGlassMaterial);
  }
  constexpr int kCells = 4;  // of the ground, a window
  const auto ground = [&](int x, int y) {
    const double height = 0.1 * hashed(std::uint32_t(1000 * y + x));
    return builder.at({double(x) / kCells, -1 - double(y) / kCells, -1 + height});
  };
  for (int y = 0; y < kCells * kFacadeSide; ++y) {
    for (int x = 0; x < kCells * kFacadeSide; ++x) {
      const VertexId v[] = {ground(x, y), ground(x, y + 1), ground(x + 1, y + 1), ground(x + 1, y)};
      builder.flat_triangle({v[0], v[1], v[2]});
      builder.flat_triangle({v[0], v[2], v[3]});
      materials.insert(materials.end(), 2, MaterialId{kGroundMaterial});
    }
  }
  Mesh mesh = builder.take();
  mesh.materials.resize(3);
  mesh.material_of_triangle = std::move(materials);
  return mesh;
}

// The area of glass in each square.
inline std::vector<double> glass_areas(const Mesh& mesh) {
  std::vector<double> areas(kWindows, 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.material_of_triangle[t] != MaterialId{kGlassMaterial}) continue;
    Vec3d at[3];
    for (std::size_t c = 0; c < 3; ++c) at[c] = mesh.positions[index_of(mesh.triangles[t][c])];
    const Vec3d middle = (at[0] + at[1] + at[2]) * (1.0 / 3);
    const std::size_t window = std::size_t(middle.x) + std::size_t(middle.z) * kFacadeSide;
    areas[std::min(window, kWindows - 1)] += 0.5 * length(cross(at[1] - at[0], at[2] - at[0]));
  }
  return areas;
}

struct WindowCount {
  std::size_t whole = 0, broken = 0, gone = 0;
};

inline WindowCount count_windows(const Mesh& input, const Mesh& level) {
  const std::vector<double> full = glass_areas(input), left = glass_areas(level);
  WindowCount count;
  for (std::size_t i = 0; i < kWindows; ++i) {
    const double share = left[i] / full[i];
    ++(share > 0.8 && share < 1.2 ? count.whole : share < 0.05 ? count.gone : count.broken);
  }
  return count;
}

}  // namespace crease
