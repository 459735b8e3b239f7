// What a frame of a flight takes: by vertex, at full HD, with everything that changes uploaded.
//
//   bench_frames --models lucy,kuka,city200k --frames 600 --seconds 0,0.25
//
// Models are built with the defaults and loaded from their files; the path is that of bench_refine.
// A frame is update(), the upload of the ranges that changed, and the drawing; each frame ends when
// its pixels are there (glFinish), so a frame that had to wait for the one before would show.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "flight.h"
#include "models.h"
#include "opened.h"
#include "render/gl_context.h"
#include "render/gl_scene.h"
#include "render/gl_target.h"
#include "samples.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

namespace crease::bench {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;
constexpr double kFrameSeconds = 1.0 / 60;

struct Options {
  int frames = 600;
  double pixels = 1;
  std::vector<double> seconds{0, 0.25};
};

class Stopwatch {
 public:
  // Since it was made or asked last.
  double ms() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(begin_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

Status fly(const std::string& name, const std::shared_ptr<const MeshHierarchy>& hierarchy,
           const Box& box, bool is_city, const Options& options, double geomorph_seconds) {
  Result<GlContext> gl = open_gl();
  if (!gl.ok()) return gl.failure();
  Result<GlTarget> target = GlTarget::make(gl->limits(), kWidth, kHeight);
  if (!target.ok()) return target.failure();
  ProgramCache programs;
  const DrawStyle style{.reversed_depth = gl->limits().can_reverse_depth,
                        .surface = kDefaultSurface};
  AdaptiveMesh mesh(hierarchy);
  ViewParameters view;
  const auto look = [&](int frame) {
    view.camera = camera_at(box, is_city, double(frame) / options.frames);
    view.camera.pixels = options.pixels;
    view.camera.width_px = kWidth;
    view.camera.height_px = kHeight;
  };
  look(0);
  mesh.update(view);
  mesh.set_geomorph_seconds(geomorph_seconds);
  GlScene scene(mesh.draw_list(), {}, nullptr, GL_DYNAMIC_DRAW);
  Samples triangles, update, kilobytes, upload, draw, whole;
  for (int frame = 1; frame < options.frames; ++frame) {
    look(frame);
    Stopwatch watch;
    mesh.update(view, kFrameSeconds);
    const double updated = watch.ms();
    kilobytes.add(double(scene.update(mesh.draw_list(), mesh.changes())) / 1e3);
    const double uploaded = watch.ms();
    DrawPass pass{.view = make_view(view.camera, double(kWidth) / kHeight), .up = view.camera.up};
    pass.depth = depth_range(pass.view, box.low, box.high);
    target->begin(kWidth, kHeight);
    if (const Status drawn = scene.draw(programs, pass, style); !drawn.ok()) return drawn;
    target->resolve(kWidth, kHeight);
    glFinish();
    const double drawn = watch.ms();
    triangles.add(double(mesh.triangle_count()));
    update.add(updated);
    upload.add(uploaded);
    draw.add(drawn);
    whole.add(updated + uploaded + drawn);
  }
  std::printf("| %s | %g | %.0f | %.0f | %.2f, %.2f | %.2f, %.2f | %.2f, %.2f | %.2f, %.2f |\n",
              name.c_str(), geomorph_seconds, triangles.of(0.5), kilobytes.of(0.5), update.of(0.5),
              update.of(1), upload.of(0.5), upload.of(1), draw.of(0.5), draw.of(1), whole.of(0.5),
              whole.of(1));
  std::fflush(stdout);
  return Done{};
}

Status measure(const ModelEntry& entry, const Options& options) {
  Result<Model> model = load_model(entry, data_folder());
  if (!model.ok()) return model.failure();
  const Box box = box_of(model->mesh.positions);
  Result<Opened> opened = open_built(std::move(model->mesh));
  if (!opened.ok()) return opened.failure();
  Result<MeshHierarchy> built = build_hierarchy(opened->model.mesh, opened->model.sequence, {});
  if (!built.ok()) return built.failure();
  const auto hierarchy = std::make_shared<const MeshHierarchy>(*std::move(built));
  for (const double seconds : options.seconds) {
    const Status flown = fly(entry.name, hierarchy, box, entry.kind == "city", options, seconds);
    if (!flown.ok()) return flown;
  }
  return Done{};
}

int run(int argc, char** argv) {
  std::vector<std::string> models{"lucy", "kuka", "city200k"};
  Options options;
  CLI::App app("What the frames of a flight take");
  app.add_option("--models", models, "of models.txt and models_more.txt")->delimiter(',');
  app.add_option("--frames", options.frames, "of a flight")->check(CLI::Range(2, 1'000'000));
  app.add_option("--pixels", options.pixels, "error allowed on the screen");
  app.add_option("--seconds", options.seconds, "that geomorphs take; 0: none")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| model | geomorph s | triangles | kB a frame | update(), median and most ms | upload "
      "| drawing | frame |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const ModelEntry& entry : all_models(models)) {
    const Status measured = measure(entry, options);
    if (measured.ok()) continue;
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), measured.failure().message.c_str());
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
