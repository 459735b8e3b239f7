// What geomorphs cost: bytes that go to the GPU each frame, and time, along a flight over an
// adaptive mesh, with them and without.
//
//   bench_geomorphs --models bunny,city200k --frames 600 --seconds 0,0.25
//
// The path is that of bench_refine, flown at 60 frames a second. Bytes are those of the ranges that
// the mesh says have changed, as GlScene uploads them; time is the processor's, of update() alone.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/simplify.h"
#include "flight.h"
#include "models.h"
#include "samples.h"

#include <CLI/CLI.hpp>

#include <ctime>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace crease::bench {
namespace {

struct Options {
  int frames = 600;
  double pixels = 1, frames_per_second = 60;
  std::vector<double> seconds{0, 0.25};
};

double processor_ms() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

std::size_t elements(const std::vector<Range>& ranges) {
  std::size_t sum = 0;
  for (const Range& r : ranges) sum += r.count;
  return sum;
}

std::size_t upload_bytes(const DrawList& list, const DrawChanges& c) {
  const std::size_t triangle = 12 + (list.materials.empty() ? 0 : 4);
  std::size_t bytes = 12 * (elements(c.positions) + elements(c.vertex_normals));
  bytes += triangle * (elements(c.sn_indices) + elements(c.fn_indices) + elements(c.nsn_indices));
  bytes += 12 * elements(c.fn_normals) + 36 * elements(c.nsn_normals);
  return bytes + 48 * (elements(c.sn_colors) + elements(c.fn_colors) + elements(c.nsn_colors));
}

void fly(const std::string& name, const std::shared_ptr<const MeshHierarchy>& hierarchy,
         const Box& box, bool is_city, const Options& options, double seconds) {
  AdaptiveMesh mesh(hierarchy);
  ViewParameters view;
  view.camera = camera_at(box, is_city, 0);
  view.camera.pixels = options.pixels;
  mesh.update(view);
  mesh.set_geomorph_seconds(seconds);
  Samples kilobytes, ms, triangles, moving;
  for (int f = 1; f < options.frames; ++f) {
    view.camera = camera_at(box, is_city, double(f) / options.frames);
    view.camera.pixels = options.pixels;
    const double began = processor_ms();
    const UpdateReport report = mesh.update(view, 1 / options.frames_per_second);
    ms.add(processor_ms() - began);
    kilobytes.add(double(upload_bytes(mesh.draw_list(), mesh.changes())) / 1e3);
    triangles.add(double(mesh.triangle_count()));
    moving.add(double(report.moving));
  }
  std::printf("| %s | %g | %.1f | %.1f | %.1f | %.0f | %.0f | %.2f | %.2f |\n", name.c_str(),
              seconds, kilobytes.of(0.5), kilobytes.of(0.95), kilobytes.of(1), triangles.of(0.5),
              moving.of(0.5), ms.of(0.5), ms.of(1));
  std::fflush(stdout);
}

bool measure(const ModelEntry& entry, const Options& options) {
  Result<Model> model = load_model(entry, data_folder());
  if (!model.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), model.failure().message.c_str());
    return false;
  }
  const Box box = box_of(model->mesh.positions);
  const Result<ContractionSequence> sequence = simplify(model->mesh, model->grid, {});
  if (!sequence.ok()) return false;
  Result<MeshHierarchy> built = build_hierarchy(model->mesh, *sequence, {});
  if (!built.ok()) return false;
  *model = {};
  const auto hierarchy = std::make_shared<const MeshHierarchy>(*std::move(built));
  for (const double seconds : options.seconds) {
    fly(entry.name, hierarchy, box, entry.kind == "city", options, seconds);
  }
  return true;
}

int run(int argc, char** argv) {
  std::vector<std::string> models{"bunny", "lucy", "city200k", "kuka"};
  Options options;
  CLI::App app("Bytes a frame with geomorphs and without");
  app.add_option("--models", models, "names of models.txt")->delimiter(',');
  app.add_option("--frames", options.frames, "of a flight")->check(CLI::Range(2, 1'000'000));
  app.add_option("--pixels", options.pixels, "error allowed on the screen");
  app.add_option("--seconds", options.seconds, "that geomorphs take; 0: none")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| model | geomorph s | kB a frame, median | 95 %% | most | triangles | on their way | "
      "ms, median | most |\n|---|---|---|---|---|---|---|---|---|\n");
  bool good = true;
  for (const ModelEntry& entry : all_models(models)) good = measure(entry, options) && good;
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
