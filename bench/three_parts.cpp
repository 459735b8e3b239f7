// What a triangle takes on the GPU and how long a frame takes, for the three parts of DB03 beside
// vertices split by (position, normal) with one index buffer, and beside three vertices a triangle.
//
//   bench_three_parts [--models city200k,kuka,lucy] [--rounds 15] [--draws 1]
//
// Bytes are those of positions and normals as floats and of indices of 32 bits. All three hold the
// same triangles and are drawn by the renderer's own programs from the same camera, one after the
// other in each round; a time is the median of the rounds. Where all triangles are SN the first two
// are the same arrays, so that row tells the noise. On a GPU a frame is too short for its timer:
// --draws 50 times so many together.
#include "draw_time.h"
#include "models.h"
#include "render/fit_camera.h"
#include "render/gl_context.h"
#include "render/gl_scene.h"
#include "render/gl_target.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>

namespace crease::bench {
namespace {

constexpr int kWidth = 960, kHeight = 720;

// Owns what its list points into: all triangles smooth, so that one indexed part has them.
struct IndexedArrays {
  Vec3d origin;
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> indices;

  DrawList list() const {
    DrawList made;
    made.origin = origin;
    made.positions = positions;
    made.vertex_normals = normals;
    made.sn.indices = indices;
    return made;
  }
  std::size_t vertex_bytes() const { return 24 * positions.size(); }
};

// `splits`: corners of one position and normal share a vertex. Else no two corners do.
IndexedArrays indexed_arrays(const Mesh& mesh, const Vec3d& origin, bool splits) {
  IndexedArrays made;
  made.origin = origin;
  const AttributeLayer& layer = *mesh.normals();
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const VertexId vertex = mesh.triangles[corner / 3][corner % 3];
    const AttributeId normal = layer.of_corner[corner];
    const auto next = std::uint32_t(made.positions.size());
    if (splits) {
      const auto [at, is_new] = known.try_emplace(
          {std::uint32_t(index_of(vertex)), std::uint32_t(index_of(normal))}, next);
      made.indices.push_back(at->second);
      if (!is_new) continue;
    } else {
      made.indices.push_back(next);
    }
    const Vec3d p = mesh.positions[index_of(vertex)] - origin;
    const std::span<const float> n = layer.value(normal);
    made.positions.push_back({float(p.x), float(p.y), float(p.z)});
    made.normals.push_back({n[0], n[1], n[2]});
  }
  return made;
}

std::size_t bytes_of(const DrawList& list) {
  std::size_t bytes = list.positions.size_bytes() + list.vertex_normals.size_bytes();
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    bytes += part->indices.size_bytes() + part->normals.size_bytes();
  }
  return bytes;
}

class Stage {
 public:
  static Result<Stage> make(const DrawList& shown) {
    Result<GlContext> gl = open_gl();
    if (!gl.ok()) return gl.failure();
    Result<GlTarget> target = GlTarget::make(gl->limits(), kWidth, kHeight);
    if (!target.ok()) return target.failure();
    Stage stage(*std::move(gl), *std::move(target));
    const PointSet points{shown.origin, shown.positions};
    const Camera camera = fit_camera_to(std::span(&points, 1), {0, 0, 1}, kWidth, kHeight);
    Box box;
    for (const Vec3f& p : shown.positions) box.add(shown.origin + Vec3d{p.x, p.y, p.z});
    stage.pass_.view = make_view(camera, double(kWidth) / kHeight);
    stage.pass_.depth = depth_range(stage.pass_.view, box.low, box.high);
    stage.style_.coloring = Coloring::Kind;
    stage.style_.surface = kDefaultSurface;
    stage.style_.reversed_depth = stage.gl_.limits().can_reverse_depth;
    return stage;
  }
  // Of one frame.
  Result<DrawTime> frame(const GlScene& scene, int draws) {
    Status drawn = Done{};
    const DrawTime took = time_drawing(draws, [&] {
      target_.begin(kWidth, kHeight);
      const Status now = scene.draw(programs_, pass_, style_);
      if (!now.ok()) drawn = now;
      target_.resolve(kWidth, kHeight);
    });
    if (!drawn.ok()) return drawn.failure();
    return took;
  }
  const std::string& renderer() const { return gl_.limits().renderer; }

 private:
  Stage(GlContext gl, GlTarget target) : gl_(std::move(gl)), target_(std::move(target)) {}
  GlContext gl_;
  GlTarget target_;
  ProgramCache programs_;
  DrawPass pass_;
  DrawStyle style_;
};

Status print_row(const std::string& name, const Mesh& mesh, int rounds, int draws) {
  const MeshDrawArrays arrays(mesh);
  const DrawList parts = arrays.draw_list();
  const IndexedArrays split = indexed_arrays(mesh, parts.origin, true);
  const IndexedArrays soup = indexed_arrays(mesh, parts.origin, false);
  Result<Stage> stage = Stage::make(parts);
  if (!stage.ok()) return stage.failure();
  const DrawList lists[] = {parts, split.list(), soup.list()};
  const std::size_t bytes[] = {bytes_of(parts), bytes_of(split.list()), soup.vertex_bytes()};
  std::vector<GlScene> scenes;
  for (const DrawList& list : lists) scenes.emplace_back(list, std::span<const float>{});

  std::vector<DrawTime> times[3];
  for (int round = -1; round < rounds; ++round) {  // the first compiles
    for (std::size_t i = 0; i < 3; ++i) {
      const Result<DrawTime> took = stage->frame(scenes[i], draws);
      if (!took.ok()) return took.failure();
      if (round >= 0) times[i].push_back(*took);
    }
  }
  const double count = double(mesh.triangle_count());
  const DrawTime ours = median(times[0]), split_took = median(times[1]),
                 soup_took = median(times[2]);
  std::printf("| %s | %zu | %.0f / %.0f / %.0f %% | %.1f | %.1f | %.1f |", name.c_str(),
              mesh.triangle_count(), 100 * double(parts.sn.triangle_count()) / count,
              100 * double(parts.fn.triangle_count()) / count,
              100 * double(parts.nsn.triangle_count()) / count, double(bytes[0]) / count,
              double(bytes[1]) / count, double(bytes[2]) / count);
  std::printf(" %.3f | %.2f | %.2f | %.3f | %.2f | %.2f | %s |\n", ours.processor_ms,
              split_took.processor_ms / ours.processor_ms,
              soup_took.processor_ms / ours.processor_ms, ours.gpu_ms,
              split_took.gpu_ms / ours.gpu_ms, soup_took.gpu_ms / ours.gpu_ms,
              stage->renderer().c_str());
  return Done{};
}

int run(int argc, char** argv) {
  CLI::App app{"GPU bytes and frame times of three ways to draw triangles with their own normals"};
  std::vector<std::string> models = {"city200k", "kuka", "lucy"};
  int rounds = 15, draws = 1;
  app.add_option("--models", models, "of models.txt and models_more.txt")->delimiter(',');
  app.add_option("--rounds", rounds)->check(CLI::Range(1, 1000));
  app.add_option("--draws", draws, "frames that are timed together")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| model | triangles | SN / FN / NSN | three parts, bytes a triangle | split vertices "
      "| three vertices | processor, ms a frame | split | three vertices | GPU, ms a frame "
      "| split | three vertices | drawn by |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n");
  for (const ModelEntry& entry : all_models(models)) {
    Result<Model> model = load_model(entry, data_folder());
    const Status printed =
        model.ok() ? print_row(entry.name, model->mesh, rounds, draws) : Status(model.failure());
    if (printed.ok()) continue;
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), printed.failure().message.c_str());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
