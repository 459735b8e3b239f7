// CAM.json of the command line, and FILE as a hierarchy and as a mesh that is fine where a camera
// looks.
//
//   Result<Camera> camera = read_camera("camera.json");
//   Result<ModelFile> file = open_model("city.obj", read, common);
//   Result<ViewedModel> model = load_viewed(*file, *camera, {.view = *camera});
//   model->mesh.update({.camera = *camera});
#pragma once

#include "cli/command.h"
#include "cli/model.h"
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/camera.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace crease::cli {

Result<Camera> read_camera(const std::filesystem::path& path);

struct ModelHierarchy {
  std::shared_ptr<const MeshHierarchy> hierarchy;
  HierarchyMaps maps;
  Mesh finest;       // of what was decoded
  LevelError error;  // its own
  std::uint64_t bytes_read = 0;
  std::size_t blocks_read = 0;
};

Result<ModelHierarchy> load_hierarchy(const ModelFile& file, const Detail& detail);

struct ViewedModel {
  AdaptiveMesh mesh;
  LevelError error;  // of its finest cut
  std::uint64_t bytes_read = 0;
  std::size_t blocks_read = 0;
};
// As fine as `view` needs it. With that view as its detail it is made of the blocks that the cut
// depends on, which is that of the whole file to within a few percent of the triangles; of all
// blocks its errors and levels are known everywhere.
Result<ViewedModel> load_viewed(const ModelFile& file, const Camera& view, const Detail& detail);

}  // namespace crease::cli
