// By vertex, and linear: the whole model in memory.
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/progressive_mesh.h"
#include "render/gl_materials.h"
#include "view/open_model.h"
#include "view/shown_mesh.h"

#include <memory>
#include <span>
#include <vector>

namespace crease {

// The nearest of the boxes; 0 inside of one.
double distance_to(std::span<const Box> parts, const Vec3d& eye);

// What several meshes of a model share: one of the two.
struct WholeData {
  std::shared_ptr<const MeshHierarchy> hierarchy;
  ProgressiveArraysPtr levels;
  Box box;
  std::vector<Box> parts;  // around triangles that are near each other

  bool is_there() const { return hierarchy || levels; }
};

struct WholeModel {
  WholeData data;
  // One of the two.
  std::unique_ptr<AdaptiveMesh> vertices;
  std::unique_ptr<ProgressiveMesh> linear;
  std::uint64_t bytes_read = 0;
};

// `mode`: not Blocks. For threads in the background.
Result<WholeModel> load_whole(const ModelSource& model, ViewMode mode, Note& note);
// Another mesh of what is loaded.
WholeModel mesh_of(WholeData data);

// The largest of its arrays must fit the device: OverLimit. `materials`: the model's, which all
// that show it share. A context must be current.
Result<std::unique_ptr<ShownMesh>> show_whole(WholeModel model, const GlLimits& limits,
                                              GlMaterialsPtr materials);

}  // namespace crease
