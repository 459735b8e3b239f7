// Puts buildings together out of closed bodies, in metres, on a grid of millimetres.
//
//   ModelBuilder b(materials, names);
//   b.begin_part("house 1", {.origin = {20, 30, 0}});
//   b.begin_body();                              // vertices are shared within a body
//   b.material(Surface::Brick);
//   const AttributeId n = b.normal({0, -1, 0});
//   b.patch(4, 2, n, [&](int i, int j) { return Vec3d{i * 1.0, 0, j * 1.5}; });
//
// Flat faces stay exactly flat: sites are turned by multiples of 90 degrees or by the angle of the
// 3-4-5 triangle, so points on a grid of 5 mm (on_grid) land on whole millimetres.
#pragma once

#include "crease/mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace crease {

inline constexpr Vec3d kUp{0, 0, 1};

enum class Coat : std::uint8_t {  // the material of a surface
  Plaster,
  Ochre,
  Cream,
  Rose,
  Brick,
  Concrete,
  Sandstone,
  RedTile,
  BrownTile,
  Slate,
  Copper,
  Stone,
  Metal,
  Glass,
  Wood,
  Grass,
  Field,
  Leaves,
  Asphalt,
  Water,
  Count,
};

// Where a building stands and which way it looks.
struct Site {
  Vec3d origin;
  double cosine = 1, sine = 0;

  Vec3d direction(const Vec3d& v) const {
    return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
  }
  Vec3d point(const Vec3d& p) const { return origin + direction(p); }
  // A site within this one: `offset` and `quarter_turns` as seen from here.
  Site at(const Vec3d& offset, int quarter_turns = 0) const;
};
inline constexpr double kPythagoreanCosine = 0.8, kPythagoreanSine = 0.6;

inline double on_grid(double metres) {
  return double(std::llround(metres * 200)) / 200;
}
inline Vec3d on_grid(const Vec3d& p) {
  return {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
}

// A point of the unit circle, k of n steps round. Rounded to 10^-6, so that the last bit of a
// library's sine does not matter.
Vec3d on_circle(double k, int n);

using PointOf = std::function<Vec3d(int i, int j)>;

class ModelBuilder {
 public:
  ModelBuilder();

  void begin_part(std::string name);
  void begin_body() { vertex_at_.clear(); }
  void place(const Site& site) { site_ = site; }
  const Site& site() const { return site_; }
  void coat(Coat coat) { coat_ = MaterialId(static_cast<std::uint32_t>(coat)); }

  AttributeId normal(const Vec3d& direction);
  VertexId vertex(const Vec3d& p);
  // Triangles with two equal corners are left out.
  void triangle(const std::array<VertexId, 3>& v, const std::array<AttributeId, 3>& n);
  void quad(const std::array<Vec3d, 4>& p, AttributeId n);
  // With the normal of its four points as they are after rounding. They lie in a plane, or the last
  // two are one.
  void flat_quad(const std::array<Vec3d, 4>& p);

  // columns x rows quads, i to the right and j upwards as seen from outside.
  void patch(int columns, int rows, AttributeId n, const PointOf& point);
  struct RimNormals {
    std::vector<AttributeId> low, high;  // of the first and the last row
  };
  RimNormals smooth_patch(int columns, int rows, const PointOf& point, const PointOf& normal);
  // A polygon in a plane without holes, counter-clockwise from where `facing` points, cut along its
  // shortest diagonals. Time O(corners cubed).
  void polygon(std::span<const Vec3d> loop, const Vec3d& facing);
  // Triangles around `centre`, which sees all of the loop.
  void fan(std::span<const Vec3d> loop, const Vec3d& centre, const Vec3d& facing);

  std::size_t triangle_count() const { return mesh_.triangle_count(); }
  // Everything since then is taken back.
  struct Mark {
    std::size_t positions, triangles, normal_values, parts;
  };
  Mark mark() const;
  void take_back(const Mark& mark);
  Mesh take() { return std::move(mesh_); }

 private:
  struct Millimetres {
    std::int64_t x, y, z;
    bool operator==(const Millimetres&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Millimetres& p) const;
  };

  AttributeId placed_normal(const Vec3d& n);  // of a direction in the model

  Mesh mesh_;
  Site site_;
  MaterialId coat_{};
  std::unordered_map<Millimetres, VertexId, Hash> vertex_at_;  // looked up, never walked
};

}  // namespace crease
