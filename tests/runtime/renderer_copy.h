// What a renderer holds of a draw list, and what is seen of it.
#pragma once

#include "crease/adaptive_mesh.h"

#include <string>
#include <vector>

namespace crease {

// Copies that fetch nothing but the ranges that are told.
class RendererCopy {
 public:
  explicit RendererCopy(const DrawList& list);
  void fetch(const DrawList& list, const DrawChanges& changes);
  // Empty if everything that is drawn is as in the list.
  std::string difference(const DrawList& list) const;

 private:
  struct PartCopy {
    std::vector<std::uint32_t> indices, materials;
    std::vector<Vec3f> normals;
    std::vector<std::array<float, 4>> colors;
    std::vector<std::array<float, 2>> texcoords;
  };
  std::vector<Vec3f> positions_, vertex_normals_;
  PartCopy parts_[3];
};

// All triangles, sorted, each as the bytes of its positions, normals, texture coordinates, colours
// and material.
std::vector<std::string> shown_triangles(const DrawList& list);
std::vector<std::string> shown_triangles(const Mesh& mesh, const Grid& grid);

}  // namespace crease
