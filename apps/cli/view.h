// CAM.json of the command line, and FILE as a hierarchy and as a mesh that is fine where a camera
// looks.
//
//   Result<Camera> camera = read_camera("camera.json");
//   Result<ModelFile> file = open_model("city.obj", read, common);
//   Result<ViewedModel> model = load_viewed(*file, view_of(*camera, {}, 5000), {});
#pragma once

#include "cli/command.h"
#include "cli/level.h"
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

// What is asked of a view beside what its camera says.
struct ViewOptions {
  double degrees = 0;  // 0: any
  bool consistent = false;
};
// `view`: the option without which they are refused.
void add_view_options(CLI::App& command, CLI::Option* view, ViewOptions& options);

ViewParameters view_of(const Camera& camera, const ViewOptions& options,
                       const std::optional<std::size_t>& triangles);

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
  StoppedBy stopped_by = StoppedBy::View;
  LevelError error;  // of its finest cut
  std::uint64_t bytes_read = 0;
  std::size_t blocks_read = 0;
};

// What of a file is read for a view.
struct ViewReads {
  bool all = false;  // so that errors and levels are known everywhere
  bool part_names = true;
};
// As fine as `view` needs it, or as its triangles allow. Unless all is read it is made of the
// blocks that the cut depends on, which is that of the whole file to within a few percent of the
// triangles.
Result<ViewedModel> load_viewed(const ModelFile& file, const ViewParameters& view,
                                const ViewReads& reads);

}  // namespace crease::cli
