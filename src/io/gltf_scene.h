// The scene graph of a glTF: which mesh stands where, in doubles.
//
//   Result<GltfScene> scene = walk_scene(source, json);
//   for (const MeshInstance& m : scene->instances) ...
#pragma once

#include "crease/result.h"
#include "crease/vec.h"
#include "io/json.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace crease {

// p -> x * p.x + y * p.y + z * p.z + origin.
struct Transform {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3d direction(const Vec3d& d) const { return x * d.x + y * d.y + z * d.z; }
  Vec3d point(const Vec3d& p) const { return direction(p) + origin; }
  // `inner` first, then this.
  Transform after(const Transform& inner) const;
  // Negative: the transform mirrors, and a triangle's winding turns over.
  double determinant() const;
  // The transform of normals, up to a positive factor: the inverse transpose of the linear part,
  // as cofactors, so that flattening transforms have one too.
  Transform of_normals() const;
  // True if directions keep their direction, so that normals need not be touched.
  bool only_scales() const;
};

// Of 16 numbers by columns.
template <typename Number>
Transform transform_of(const Number* m) {
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

// translation (3), rotation (4: a quaternion x, y, z, w), scale (3), the scale first (3.5.3).
Transform transform_of_trs(const double* translation, const double* rotation, const double* scale);

struct MeshInstance {
  std::size_t mesh = 0;
  Transform to_world;
  std::string name;                 // of the node, else of the mesh, else "node 3"
  std::vector<double> weights;      // of morph targets: the node's, else the mesh's; none: at rest
  std::optional<std::size_t> skin;  // to_world is void, then (3.7.3.3)
  bool is_named = false;            // by the file
  std::optional<std::size_t> instanced_node{};  // it has EXT_mesh_gpu_instancing
};

struct GltfScene {
  std::vector<MeshInstance> instances;  // in the order of the graph, parents first
  // Of those in the scene, and of all others where there are skins.
  std::vector<std::optional<Transform>> to_world_of_node;
  std::vector<std::string> notes;
};

// The default scene, else the first, else every root node, else every mesh as it is; without what
// KHR_node_visibility hides. Fails on nodes
// that are reached twice (a loop, or two parents; 3.5.2) and on references to nothing.
Result<GltfScene> walk_scene(const Source& source, const Json& json);

}  // namespace crease
