#include "cli/view.h"

#include "cli/console.h"
#include "cli/number_check.h"
#include "cli/view_blocks.h"
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
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) {
    return fail(Error::ReadFailed, path.string() + ": a folder, not a camera file");
  }
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
// far more triangles than it may have, not much more is read than they take.
constexpr double kCoarsest = 256, kStep = 4;
// What a try may read over the one before it that would do, so that there are few.
constexpr double kNearlyAll = 1.5;

ViewParameters with_errors(ViewParameters view, double times) {
  view.camera.pixels *= times;
  view.degrees *= times;
  return view;
}

// Times the errors asked for: 1 in the end. Those whose blocks, as the file's directory knows, have
// no more triangles than are allowed need no try, nor those that read little less than the next.
Result<std::vector<double>> tries_of(const BlockFile& file, const ViewParameters& view) {
  const Result<BlockDirectory> directory = BlockDirectory::read(file);
  if (!directory.ok()) return directory.failure();
  std::vector<double> tries;
  double triangles_before = 0;  // of the first try that the last one of `tries` stands for
  for (double times = kCoarsest; times >= 1; times /= kStep) {
    const double triangles = double(directory->triangles_at_most(with_errors(view, times)));
    if (tries.empty() && times > 1 && triangles <= double(view.max_triangles)) continue;
    if (!tries.empty() && triangles <= kNearlyAll * triangles_before) {
      tries.back() = times;
    } else {
      tries.push_back(times);
      triangles_before = triangles;
    }
  }
  return tries;
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
  const std::uint64_t read_before = file.bytes_read();
  Result<std::vector<double>> tries = std::vector<double>{1};
  if (has_limit && !reads.all) tries = tries_of(file.blocks(), view);
  if (!tries.ok()) return tries.failure();
  for (std::size_t i = 0;; ++i) {
    const double times = (*tries)[i];
    Detail detail{.part_names = reads.part_names};
    if (!reads.all) detail.view = with_errors(unlimited, times);
    Result<ModelHierarchy> model = load_hierarchy(file, detail);
    if (!model.ok()) return model.failure();
    AdaptiveMesh mesh(model->hierarchy);
    mesh.update(with_errors(unlimited, times));
    if (times > 1 && mesh.triangle_count() <= view.max_triangles) continue;

    // A host was asked for what came with the tries before as well.
    const std::uint64_t read = file.is_remote()
                                   ? file.bytes_read() - read_before + file.bytes_to_open()
                                   : model->bytes_read;
    const auto viewed = [&](AdaptiveMesh& as, StoppedBy stop) {
      return ViewedModel{std::move(as), stop, model->error, read, model->blocks_read};
    };
    const std::vector<char> faces_away = triangles_facing_away(model->finest, model->maps);
    mesh.unfold(unlimited.max_triangles, faces_away);
    if (mesh.triangle_count() <= view.max_triangles) return viewed(mesh, StoppedBy::View);
    AdaptiveMesh limited = limited_cut(model->hierarchy, with_errors(view, times), faces_away);
    const bool fits = limited.triangle_count() <= view.max_triangles;
    return viewed(limited, fits ? StoppedBy::Triangles : StoppedBy::Topology);
  }
}

}  // namespace crease::cli
