#include "cli/view.h"

#include "cli/console.h"
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

Result<ModelHierarchy> load_hierarchy(const ModelFile& file, const Detail& detail) {
  Result<Model> model = file.load(detail);
  if (!model.ok()) return model.failure();
  if (file.triangle_count() == 0) {
    return fail(Error::NoTriangles, file.blocks().source().name() + ": no triangles");
  }
  const DecodedModel& decoded = model->decoded;
  HierarchyMaps maps;
  Result<MeshHierarchy> hierarchy = build_hierarchy(decoded.mesh, decoded.sequence, {}, &maps);
  if (!hierarchy.ok()) return hierarchy.failure();
  return ModelHierarchy{std::make_shared<const MeshHierarchy>(*std::move(hierarchy)),
                        std::move(maps),
                        std::move(model->decoded.mesh),
                        decoded.error,
                        model->bytes_read,
                        decoded.blocks.size()};
}

Result<ViewedModel> load_viewed(const ModelFile& file, const Camera& view, const Detail& detail) {
  Result<ModelHierarchy> model = load_hierarchy(file, detail);
  if (!model.ok()) return model.failure();
  AdaptiveMesh mesh(std::move(model->hierarchy));
  mesh.update({.camera = view});
  return ViewedModel{std::move(mesh), model->error, model->bytes_read, model->blocks_read};
}

}  // namespace crease::cli
