#include "cli/view.h"

#include "cli/console.h"
#include "cli/number_check.h"
#include "crease/render.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

namespace {

// The views with more error that are tried before what is asked for: so that of a view that needs
// far more triangles than it may have, no more is read than they take. All together read a third
// more at most, and make as much of it.
constexpr double kCoarsest = 256, kStep = 4;

ViewParameters with_errors(ViewParameters view, double times) {
  view.camera.pixels *= times;
  view.degrees *= times;
  return view;
}

// What unfolding takes is left free by the view, which is looked at again until there is enough:
// nearly always at once.
AdaptiveMesh limited_cut(const std::shared_ptr<const MeshHierarchy>& hierarchy,
                         const ViewParameters& view, std::span<const char> faces_away) {
  constexpr int kTries = 4;
  ViewParameters with_room = view;
  for (int i = 1;; ++i) {
    const bool is_last = i == kTries;
    AdaptiveMesh mesh(hierarchy);
    mesh.update(with_room);
    mesh.unfold(is_last ? view.max_triangles : ViewParameters{}.max_triangles, faces_away);
    if (is_last || mesh.triangle_count() <= view.max_triangles) return mesh;
    const std::size_t excess = mesh.triangle_count() - view.max_triangles;
    with_room.max_triangles -= std::min(excess, with_room.max_triangles);
  }
}

}  // namespace

void add_view_options(CLI::App& command, CLI::Option* view, ViewOptions& options) {
  command
      .add_option("--degrees", options.degrees,
                  "error of shading allowed in the view besides; default: any")
      ->check(number_above(0.0, 180.0))
      ->type_name("N")
      ->needs(view);
  command
      .add_flag("--consistent", options.consistent,
                "in the view a vertex is split after those of larger errors that it depends on, so "
                "that neighbourhoods are those that the simplifier saw, but where all is flat")
      ->needs(view);
}

ViewParameters view_of(const Camera& camera, const ViewOptions& options,
                       const std::optional<std::size_t>& triangles) {
  ViewParameters view{.camera = camera, .degrees = options.degrees};
  view.consistent = options.consistent;
  if (triangles) view.max_triangles = *triangles;
  return view;
}

Result<ViewedModel> load_viewed(const ModelFile& file, const ViewParameters& view,
                                const ViewReads& reads) {
  ViewParameters unlimited = view;
  unlimited.max_triangles = ViewParameters{}.max_triangles;
  const bool has_limit = view.max_triangles != unlimited.max_triangles;
  for (double times = has_limit && !reads.all ? kCoarsest : 1;; times /= kStep) {
    Detail detail{.part_names = reads.part_names};
    if (!reads.all) detail.view = with_errors(unlimited, times);
    Result<ModelHierarchy> model = load_hierarchy(file, detail);
    if (!model.ok()) return model.failure();
    const std::vector<char> faces_away = triangles_facing_away(model->finest, model->maps);
    AdaptiveMesh mesh(model->hierarchy);
    mesh.update(with_errors(unlimited, times));
    mesh.unfold(unlimited.max_triangles, faces_away);
    const auto viewed = [&](AdaptiveMesh& as, StoppedBy stop) {
      return ViewedModel{std::move(as), stop, model->error, model->bytes_read, model->blocks_read};
    };
    if (mesh.triangle_count() > view.max_triangles) {
      AdaptiveMesh limited = limited_cut(model->hierarchy, with_errors(view, times), faces_away);
      const bool fits = limited.triangle_count() <= view.max_triangles;
      return viewed(limited, fits ? StoppedBy::Triangles : StoppedBy::Topology);
    }
    if (times <= 1) return viewed(mesh, StoppedBy::View);
  }
}

}  // namespace crease::cli
