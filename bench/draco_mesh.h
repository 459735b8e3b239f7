// Draco as a library, at its smallest: edgebreaker, speed 0 (`draco_encoder -cl 10`).
//
//   const DracoMesh mesh(snapped, grid, /*with_normals=*/true);
//   const std::vector<char> bytes = mesh.encode();
//   const std::size_t triangles = decode_draco(bytes);
//
// It gets the mesh that crease gets: positions are the grid's integers, which its quantization
// keeps as they are; normals are those that were snapped, one a vertex and side of a hard edge, so
// that Draco finds the seams itself and splits there.
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace crease::bench {

class DracoMesh {
 public:
  // `join_positions`: vertices that the grid put at one place become one, as its own importers do.
  DracoMesh(const Mesh& snapped, const Grid& grid, bool with_normals, bool join_positions);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  // `normal_bits`: a component. Empty where Draco refuses.
  std::vector<char> encode(int normal_bits = 10) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// Decodes everything and gives the number of triangles, 0 where it fails.
std::size_t decode_draco(std::span<const char> bytes);

// The same as a mesh on the grid, as a viewer shows it; empty where it fails. With normals.
Mesh draco_result(std::span<const char> bytes, const Grid& grid);

}  // namespace crease::bench
