#include "cli/view.h"

#include "cli/console.h"
#include "crease/progressive_mesh.h"
#include "crease/render.h"

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

namespace crease::cli {

Result<Camera> read_camera(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(Error::NotFound, path.string() + ": no such camera file");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  Result<Camera> camera = parse_camera(text);
  if (!camera.ok()) {
    return fail(camera.failure().error, path.string() + ": " + camera.failure().message);
  }
  return camera;
}

Result<ModelHierarchy> load_hierarchy(const std::filesystem::path& path, const ReadOptions& options,
                                      const Common& common) {
  Result<BuildOptions> build = build_options(options, common);
  if (!build.ok()) return build.failure();
  Mesh full;
  Grid grid;
  FileInfo info;
  if (is_crease_file(path)) {
    Result<CreaseFile> file = read_crease(path, {});
    if (!file.ok()) return file.failure();
    full = ProgressiveMesh(file->arrays).extract();
    grid = file->arrays->grid;
    build->simplify.placement = file->arrays->placement;
    info = std::move(file->info);
  } else {
    Result<Mesh> mesh = load_mesh(path, options, common);
    if (!mesh.ok()) return mesh.failure();
    full = *std::move(mesh);
    grid = make_grid(full, build->precision);
    snap(full, grid);
    snap_attributes(full, build->attributes);
  }
  if (full.triangle_count() == 0) {
    return fail(Error::NoTriangles, path.string() + ": no triangles");
  }
  Result<ContractionSequence> sequence = simplify(full, grid, build->simplify);
  wipe_progress_bar();
  if (!sequence.ok()) return sequence.failure();
  HierarchyMaps maps;
  Result<MeshHierarchy> hierarchy = build_hierarchy(full, *sequence, {}, &maps);
  if (!hierarchy.ok()) return hierarchy.failure();
  return ModelHierarchy{std::make_shared<const MeshHierarchy>(*std::move(hierarchy)),
                        std::move(maps), std::move(full), std::move(info)};
}

Result<ViewedModel> load_viewed(const std::filesystem::path& path, const ReadOptions& options,
                                const Common& common) {
  Result<ModelHierarchy> model = load_hierarchy(path, options, common);
  if (!model.ok()) return model.failure();
  return ViewedModel{AdaptiveMesh(std::move(model->hierarchy)), std::move(model->full),
                     std::move(model->info)};
}

}  // namespace crease::cli
