// A sheet with a picture of four colours on it, and the picture's file.
#pragma once

#include "crease/mesh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

// 32 x 32 pixels, a colour a quarter: red, green, then blue, yellow below.
inline constexpr std::uint8_t kQuarters[][3] = {
    {220, 30, 30}, {30, 180, 30}, {40, 60, 220}, {240, 220, 40}};
inline constexpr std::uint8_t kQuartersPng[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x20, 0x08, 0x03, 0x00, 0x00, 0x00, 0x44, 0xa4, 0x8a,
    0xc6, 0x00, 0x00, 0x00, 0x0c, 0x50, 0x4c, 0x54, 0x45, 0xdc, 0x1e, 0x1e, 0x1e, 0xb4, 0x1e, 0x28,
    0x3c, 0xdc, 0xf0, 0xdc, 0x28, 0xe6, 0xb7, 0x32, 0x84, 0x00, 0x00, 0x00, 0x1e, 0x49, 0x44, 0x41,
    0x54, 0x78, 0xda, 0x63, 0x60, 0x40, 0x03, 0x8c, 0x68, 0x80, 0x61, 0x54, 0xc1, 0x88, 0x52, 0xc0,
    0x84, 0x06, 0x98, 0xd1, 0xc0, 0xa8, 0x82, 0x11, 0xa5, 0x00, 0x00, 0x34, 0x98, 0x06, 0x01, 0x48,
    0xff, 0x42, 0x56, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

inline ImageFile quarters_png() {
  std::vector<std::byte> bytes;
  for (const std::uint8_t b : kQuartersPng) bytes.push_back(std::byte{b});
  return {"quarters.png", std::make_shared<const std::vector<std::byte>>(std::move(bytes))};
}

// The unit square in z = 0 with texture coordinates equal to x and y. Its left third has one normal
// a vertex (SN), the middle one a triangle (FN), the right one a corner (NSN), all of them nearly
// up. Waves of `height`, which is little, give a simplifier something to keep.
inline Mesh painted_sheet(std::uint32_t cells, double height = 0) {
  Mesh mesh;
  AttributeLayer normals{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  AttributeLayer uv{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
  const auto add_normal = [&](std::uint32_t number) {
    const Vec3d n =
        normalized(Vec3d{0.02 * std::sin(1.0 + number), 0.02 * std::cos(2.0 + 3 * number), 1});
    for (int k = 0; k < 3; ++k) normals.values.push_back(static_cast<float>(n[k]));
    return AttributeId{static_cast<std::uint32_t>(normals.value_count() - 1)};
  };
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = double(i) / cells, y = double(j) / cells;
      mesh.positions.push_back({x, y, height * std::sin(9 * x) * std::cos(7 * y)});
      uv.values.insert(uv.values.end(), {static_cast<float>(x), static_cast<float>(y)});
      add_normal(i * j);
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = b + cells + 1, d = a + cells + 1;
      for (const std::array<std::uint32_t, 3>& t : {std::array{a, b, c}, std::array{a, c, d}}) {
        mesh.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        AttributeId normal{};
        for (std::size_t k = 0; k < 3; ++k) {
          uv.of_corner.push_back(AttributeId{t[k]});
          const bool is_own = 3 * i >= 2 * cells || (3 * i >= cells && k == 0);
          if (is_own) normal = add_normal(static_cast<std::uint32_t>(normals.of_corner.size()));
          if (3 * i < cells) normal = AttributeId{t[k]};
          normals.of_corner.push_back(normal);
        }
      }
    }
  }
  mesh.layers = {std::move(normals), std::move(uv)};
  mesh.materials = {{"paint", {1, 1, 1, 1}, "quarters.png"}};
  mesh.material_of_triangle.assign(mesh.triangle_count(), MaterialId{0});
  mesh.images = {quarters_png()};
  return mesh;
}

// Which of the four colours a pixel is nearest in proportion to.
inline int nearest_quarter(double r, double g, double b) {
  int nearest = 0;
  double best = -1;
  for (int i = 0; i < 4; ++i) {
    const std::uint8_t* c = kQuarters[i];
    const double dot = r * c[0] + g * c[1] + b * c[2];
    const double size =
        std::sqrt((r * r + g * g + b * b) *
                  (double(c[0]) * c[0] + double(c[1]) * c[1] + double(c[2]) * c[2]));
    const double likeness = size > 0 ? dot / size : 0;
    if (likeness <= best) continue;
    best = likeness;
    nearest = i;
  }
  return nearest;
}

}  // namespace crease
