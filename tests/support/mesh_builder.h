// Puts test meshes together corner by corner, with one normal layer.
//
//   MeshBuilder b;
//   const AttributeId up = b.normal({0, 0, 1});
//   b.quad({b.at({0, 0, 0}), b.at({1, 0, 0}), b.at({1, 1, 0}), b.at({0, 1, 0})}, up);
//   Mesh mesh = b.take();
#pragma once

#include "crease/mesh.h"

#include <array>
#include <map>
#include <utility>

namespace crease {

class MeshBuilder {
 public:
  MeshBuilder();

  VertexId vertex(Vec3d p);     // a new vertex
  VertexId at(Vec3d p);         // the vertex that at() made at exactly this position, or a new one
  AttributeId normal(Vec3d n);  // a new value, normalized
  AttributeId normal_at(
      Vec3d n);  // the value that normal_at() made of bit-equal floats, or a new one

  void triangle(std::array<VertexId, 3> v, std::array<AttributeId, 3> n);
  void triangle(std::array<VertexId, 3> v, AttributeId n) { triangle(v, {n, n, n}); }
  // With its geometric normal, a value of its own.
  void flat_triangle(std::array<VertexId, 3> v);
  // Two triangles, split from corner 0 to corner 2.
  void quad(std::array<VertexId, 4> v, std::array<AttributeId, 4> n);
  void quad(std::array<VertexId, 4> v, AttributeId n) { quad(v, {n, n, n, n}); }

  // A flat parallelogram of columns x rows quads that share one normal (u x v); vertices by at().
  void grid(Vec3d origin, Vec3d u, Vec3d v, int columns, int rows);
  // An axis-parallel box out of six grids of cells^2 quads.
  void box(Vec3d low, Vec3d high, int cells);

  Vec3d position(VertexId v) const { return mesh_.positions[index_of(v)]; }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
  std::map<std::array<double, 3>, VertexId> vertex_at_;
  std::map<std::array<float, 3>, AttributeId> normal_at_;
};

}  // namespace crease
