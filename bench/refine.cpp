// How fast an adaptive mesh follows a camera, and what it costs.
//
//   bench/refine --models lucy,city200k,kuka --frames 600
//
// Each model is flown over along a path with a fixed seed. On one thread, processor time: splits
// plus merges per second of the whole update (evaluation, moves, draw arrays), of several flights
// the fastest of each frame; vertices and pairs evaluated per frame; what a still camera costs;
// bytes; triangles at 1 pixel beside the coarsest uniform level that is as right everywhere in the
// view.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/file.h"
#include "flight.h"
#include "models.h"
#include "opened.h"

#include <CLI/CLI.hpp>

#include <ctime>

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>

namespace crease::bench {
namespace {

double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Of what is drawn, in whatever order: equal for equal positions, normals and shading kinds.
std::uint64_t hash_of(const DrawList& list) {
  std::uint64_t sum = 0;
  const auto mix = [](std::uint64_t& h, const Vec3f& v) {
    for (const float x : {v.x, v.y, v.z}) {
      h = (h ^ std::bit_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
  };
  std::uint64_t kind = 0;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    ++kind;
    for (std::size_t c = 0; c < part->indices.size(); c += 3) {
      std::uint64_t triangle = kind;
      for (std::size_t k = c; k < c + 3; ++k) {
        mix(triangle, list.positions[part->indices[k]]);
        mix(triangle, kind == 1   ? list.vertex_normals[part->indices[k]]
                      : kind == 2 ? part->normals[c / 3]
                                  : part->normals[k]);
      }
      sum += triangle;
    }
  }
  return sum;
}

struct Flight {
  std::uint64_t hash = 0;  // of what is drawn in all frames, if asked for
  std::size_t moves = 0, evaluated = 0, triangles = 0, frames = 0, most_moves = 0;
  std::vector<double> seconds_of_frame;

  double seconds() const {
    return std::accumulate(seconds_of_frame.begin(), seconds_of_frame.end(), 0.0);
  }
};

// Every round does the same moves in the same frames; of each frame the fastest counts, which is
// the one that others on the machine disturbed least.
Flight fly(AdaptiveMesh& mesh, const ViewParameters& start, const Box& box, bool is_city,
           int frames, const Flight* before, bool hashes = false) {
  Flight flight;
  for (int f = 0; f < frames; ++f) {
    ViewParameters view = start;
    view.camera = camera_at(box, is_city, double(f) / frames);
    view.camera.pixels = start.camera.pixels;
    const double began = processor_seconds();
    const UpdateReport report = mesh.update(view);
    double seconds = processor_seconds() - began;
    if (hashes) flight.hash = 31 * flight.hash + hash_of(mesh.draw_list());
    if (f == 0) continue;  // from the coarsest cut
    if (before != nullptr) seconds = std::min(seconds, before->seconds_of_frame[flight.frames]);
    flight.seconds_of_frame.push_back(seconds);
    flight.moves += report.splits + report.merges;
    flight.most_moves = std::max(flight.most_moves, report.splits + report.merges);
    flight.evaluated += report.evaluated;
    flight.triangles += mesh.triangle_count();
    ++flight.frames;
  }
  return flight;
}

// The coarsest level that has the same error everywhere and is as right in this view: its error is
// what is allowed where the view is finest.
std::size_t uniform_triangles(const std::shared_ptr<const MeshHierarchy>& hierarchy,
                              const ViewParameters& view, const DrawList& list) {
  const double half = std::tan(radians(view.camera.vertical_fov_deg) / 2);
  const Vec3d forward = normalized(view.camera.target - view.camera.position);
  double nearest = 1e300;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (const std::uint32_t slot : part->indices) {
      const Vec3f& p = list.positions[slot];
      const Vec3d to = Vec3d{p.x, p.y, p.z} + list.origin - view.camera.position;
      const double along = dot(to, forward);
      const double aside = length(to - forward * along);
      if (along > 0 && aside < half * along) nearest = std::min(nearest, length(to));
    }
  }
  AdaptiveMesh uniform(hierarchy);
  uniform.set_error(
      static_cast<float>(view.camera.pixels * 2 * half * nearest / view.camera.height_px));
  return uniform.triangle_count();
}

// Of a .crease file, or built.
Result<DecodedModel> open_model(const ModelEntry& entry) {
  if (entry.where.ends_with(".crease")) {
    const Result<BlockFile> file = open_crease(entry.where);
    if (!file.ok()) return file.failure();
    return decode_model(*file);
  }
  Result<Mesh> source = load_mesh(entry, data_folder());
  if (!source.ok()) return source.failure();
  Result<Opened> opened = open_built(*std::move(source));
  if (!opened.ok()) return opened.failure();
  return std::move(opened->model);
}

// The error on the screen at which the cut has about so many triangles on the way: halves of a
// factor until it is within 2 %.
double pixels_for(const std::shared_ptr<const MeshHierarchy>& hierarchy, const Box& box,
                  bool is_city, std::size_t triangles) {
  constexpr int kFrames = 16, kMostSteps = 24;
  AdaptiveMesh mesh(hierarchy);
  ViewParameters view;
  double factor = 4096;
  for (int step = 0; step < kMostSteps; ++step) {
    const Flight flight = fly(mesh, view, box, is_city, kFrames, nullptr);
    const double share = double(flight.triangles) / double(flight.frames) / double(triangles);
    if (std::abs(share - 1) < 0.02) break;
    view.camera.pixels *= share > 1 ? factor : 1 / factor;
    factor = std::sqrt(factor);
  }
  return view.camera.pixels;
}

bool measure(const ModelEntry& entry, int frames, int rounds, double pixels,
             std::size_t triangles_wanted, bool one_root, bool hashes) {
  Result<DecodedModel> opened = open_model(entry);
  if (!opened.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), opened.failure().message.c_str());
    return false;
  }
  const Mesh& decoded = opened->mesh;
  const Box box = box_of(decoded.positions);
  const std::size_t vertices = decoded.vertex_count(), triangles = decoded.triangle_count();
  Result<MeshHierarchy> built = build_hierarchy(decoded, opened->sequence, {.one_root = one_root});
  if (!built.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), built.failure().message.c_str());
    return false;
  }
  *opened = {};
  const auto hierarchy = std::make_shared<const MeshHierarchy>(*std::move(built));
  const bool is_city = entry.kind == "city";
  if (triangles_wanted > 0) pixels = pixels_for(hierarchy, box, is_city, triangles_wanted);
  ViewParameters view;
  view.camera.pixels = pixels;

  Flight flight;
  for (int r = 1; r < rounds; ++r) {
    AdaptiveMesh mesh(hierarchy);
    flight = fly(mesh, view, box, is_city, frames, r == 1 ? nullptr : &flight);
  }
  AdaptiveMesh mesh(hierarchy);
  flight = fly(mesh, view, box, is_city, frames, rounds == 1 ? nullptr : &flight, hashes);
  const double worst_frame = *std::ranges::max_element(flight.seconds_of_frame);
  const double moves = double(std::max<std::size_t>(1, flight.moves));
  view.camera = camera_at(box, is_city, double(frames - 1) / frames);
  view.camera.pixels = pixels;
  mesh.update(view);
  const double before = processor_seconds();
  std::size_t evaluated = 0;
  for (int i = 0; i < 1000; ++i) evaluated += mesh.update(view).evaluated;
  const double still = (processor_seconds() - before) / 1000;
  const std::size_t uniform = uniform_triangles(hierarchy, view, mesh.draw_list());

  std::printf(
      "%-12s %8zu tris  hierarchy %5.1f bytes/vertex  active %6.1f bytes/active vertex\n"
      "  flight: %.3g pixels  %7.0f active tris  %7.1f moves/frame (most %zu)  %7.1f "
      "evaluated/frame  "
      "%.2f M moves/s  %.0f ns/move  frame %.3f ms (worst %.3f)\n"
      "  still:  %.2f us/frame, %zu evaluated\n"
      "  last view: %zu triangles, %zu vertices, uniform level of the same error %zu (%.1f "
      "times)\n",
      entry.name.c_str(), triangles, double(hierarchy_bytes(*hierarchy).total()) / double(vertices),
      double(mesh.active_bytes()) / double(mesh.vertex_count()), pixels,
      double(flight.triangles) / double(flight.frames),
      double(flight.moves) / double(flight.frames), flight.most_moves,
      double(flight.evaluated) / double(flight.frames), moves / flight.seconds() / 1e6,
      flight.seconds() / moves * 1e9, flight.seconds() / double(flight.frames) * 1e3,
      worst_frame * 1e3, still * 1e6, evaluated, mesh.triangle_count(), mesh.vertex_count(),
      uniform, double(uniform) / double(mesh.triangle_count()));
  if (hashes) std::printf("  drawn: %016" PRIx64 "\n", flight.hash);
  std::fflush(stdout);
  return true;
}

int run(int argc, char** argv) {
  std::vector<std::string> models{"lucy", "city200k", "kuka"};
  std::filesystem::path list = std::filesystem::path(CREASE_BENCH_SOURCE) / "models.txt";
  int frames = 600, rounds = 3;
  double pixels = 1;
  std::size_t cut_triangles = 0;
  bool is_city = false, one_root = false, hashes = false;
  CLI::App app("Flights over adaptive meshes");
  app.add_option("--models", models, "names of models.txt, generate:N, or .crease files")
      ->delimiter(',');
  app.add_flag("--one-root", one_root, "what the simplifier leaves is joined under one root");
  app.add_flag("--city", is_city, ".crease files are flown over, not around");
  app.add_option("--list", list, "instead of models.txt");
  app.add_option("--frames", frames, "of a flight");
  app.add_option("--rounds", rounds, "flights; of each frame the fastest counts")
      ->check(CLI::PositiveNumber);
  app.add_option("--pixels", pixels, "error allowed on the screen");
  app.add_option("--cut", cut_triangles, "as many pixels as give a cut of so many triangles");
  app.add_flag("--hash", hashes, "of what is drawn in every frame, equal for equal commits");
  CLI11_PARSE(app, argc, argv);
  Result<std::vector<ModelEntry>> entries = read_models(list);
  if (!entries.ok()) {
    std::fprintf(stderr, "%s\n", entries.failure().message.c_str());
    return 2;
  }
  bool good = true;
  for (const std::string& name : models) {
    if (name.starts_with("generate:")) {
      good = measure({name, "city", "keep", name}, frames, rounds, pixels, cut_triangles, one_root,
                     hashes) &&
             good;
    } else if (name.ends_with(".crease")) {
      const std::string stem = std::filesystem::path(name).stem().string();
      good = measure({stem, is_city ? "city" : "scan", "keep", name}, frames, rounds, pixels,
                     cut_triangles, one_root, hashes) &&
             good;
    }
    for (const ModelEntry& entry : *entries) {
      if (entry.name == name)
        good = measure(entry, frames, rounds, pixels, cut_triangles, one_root, hashes) && good;
    }
  }
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
