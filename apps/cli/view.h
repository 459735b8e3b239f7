// CAM.json of the command line, and FILE as a hierarchy and as a mesh that is fine where a camera
// looks.
//
//   Result<Camera> camera = read_camera("camera.json");
//   Result<ViewedModel> model = load_viewed("city.obj", read, common);
//   model->mesh.update({.camera = *camera});
#pragma once

#include "cli/command.h"
#include "cli/model.h"
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/camera.h"

#include <filesystem>
#include <memory>

namespace crease::cli {

Result<Camera> read_camera(const std::filesystem::path& path);

struct ModelHierarchy {
  std::shared_ptr<const MeshHierarchy> hierarchy;
  HierarchyMaps maps;
  Mesh full;        // snapped
  FileInfo info{};  // of a .crease file; of a mesh file all zero
};

// The hierarchy is made from the full resolution, whatever FILE is: this first .crease holds levels
// alone. So it takes as long as a build.
Result<ModelHierarchy> load_hierarchy(const std::filesystem::path& path, const ReadOptions& options,
                                      const Common& common);

struct ViewedModel {
  AdaptiveMesh mesh;
  Mesh full;
  FileInfo info{};
};
Result<ViewedModel> load_viewed(const std::filesystem::path& path, const ReadOptions& options,
                                const Common& common);

}  // namespace crease::cli
