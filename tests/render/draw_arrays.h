// A mesh as the draw list that its own triangles make, built the obvious way, so that the renderer
// is tested without the run time.
#pragma once

#include "crease/draw_list.h"

#include <array>
#include <vector>

namespace crease {

class DrawArrays {
 public:
  explicit DrawArrays(const Mesh& mesh);
  DrawList list() const;  // valid while this lives and stays where it is

 private:
  struct Part {
    std::vector<std::uint32_t> indices, materials;
    std::vector<Vec3f> normals;
    std::vector<std::array<float, 4>> colors;
    DrawPart view() const { return {indices, normals, materials, colors}; }
  };
  Vec3d origin_;
  std::vector<Vec3f> positions_, vertex_normals_;
  std::vector<Material> materials_;
  Part sn_, fn_, nsn_;
};

}  // namespace crease
