// What a renderer needs for the three-part drawing of DB03: SN triangles indexed, FN triangles with
// one normal each, NSN triangles with three. No renderer is named here.
//
//   DrawList list = progressive_mesh.draw_list();
//   upload(list.positions);
//   draw_indexed(list.sn.indices);
//   draw_flat(list.fn.indices, list.fn.normals);
#pragma once

#include "crease/mesh.h"
#include "crease/vec.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace crease {

// One of the three parts. Triangle t has corners indices[3 * t ..], all three from `positions`.
struct DrawPart {
  std::span<const std::uint32_t> indices;  // 3 * triangle_count
  std::span<const Vec3f> normals;          // SN: empty; FN: triangle_count; NSN: 3 * triangle_count
  std::span<const std::uint32_t> materials;  // triangle_count, or empty
  // RGBA 0..1 per corner, 3 * triangle_count, or empty when the mesh has no colour layer: sRGB, as
  // the layer has them, where materials' base colours are linear; and linear alpha.
  std::span<const std::array<float, 4>> colors;
  // Per corner, v up, 3 * triangle_count: the first layer of texture coordinates in a plane, or
  // empty where there is none.
  std::span<const std::array<float, 2>> texcoords{};

  std::size_t triangle_count() const { return indices.size() / 3; }
};

// Views into their owner, valid until the owner changes.
struct DrawList {
  Vec3d origin;                           // positions are relative to it, so that floats suffice
  std::span<const Vec3f> positions;       // model units less origin; SN vertices first
  std::span<const Vec3f> vertex_normals;  // of the SN vertices: position v has normal v
  DrawPart sn, fn, nsn;
  std::span<const Material> materials;
  // Of the materials' textures, as far as they are known; else base colours stand alone. Meshes for
  // drawing have none: who draws adds them.
  std::span<const ImageFile> images{};
};

// The arrays of a mesh that is not progressive, partitioned the same way, and the mesh's images.
// Needs a normal layer.
class MeshDrawArrays {
 public:
  explicit MeshDrawArrays(const Mesh& mesh);
  ~MeshDrawArrays();
  MeshDrawArrays(MeshDrawArrays&&) noexcept;
  DrawList draw_list() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crease
