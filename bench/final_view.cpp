// Bytes until a view is what it will stay, within 1 pixel at full HD, beside what the whole model
// takes compressed: Draco, and a GLB with meshopt compression, at the same precision.
//
//   bench_final_view --models dragon,berlin_mitte --csv build/final_view.csv
//   bench_final_view --models none --files city.crease --city     of a file that is there
//
// Positions of 14 bits over the longest side and normals of 10 bits a component, endpoints alone;
// then what a build takes by itself: 24 and 12 bits. Each file is served by a host of this process,
// and counted is what its connections brought until BlockStreamer had all that the view wants,
// requests for what lies between included. All get the same triangles: those of the file.
#include "crease/block_streamer.h"
#include "crease/build.h"
#include "crease/decode_model.h"
#include "crease/file_server.h"
#include "crease/http_source.h"
#include "draco_mesh.h"
#include "flight.h"
#include "models.h"
#include "peers.h"
#include "pipeline/sized_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>

namespace crease::bench {
namespace {

constexpr double kGoal = 0.6;  // of either, on large models
constexpr const char* kServed = "model.crease";

struct Options {
  std::vector<std::string> models{"lucy",  "dragon",       "wrist",      "city200k",
                                  "so100", "berlin_mitte", "linz_south", "terrain"};
  std::vector<std::filesystem::path> files;
  bool is_city = false;                           // the files
  std::size_t max_meshopt_triangles = 4'000'000;  // its script keeps a text for each vertex
  std::filesystem::path cache, csv;
};

// The whole model, as others compress it.
struct Peers {
  std::size_t draco = 0, meshopt = 0, meshopt_gzip = 0;  // bytes; 0: not measured
};

struct Seen {
  std::size_t first_bytes = 0;  // until the first triangles
  std::size_t bytes = 0;        // until all was there
  std::size_t triangles = 0;    // that are shown then
};

class Table {
 public:
  explicit Table(const std::filesystem::path& csv) {
    if (!csv.empty()) csv_.open(csv);
    csv_ << "model,precision,triangles,file_bytes,draco_bytes,meshopt_bytes,meshopt_gzip_bytes,"
            "view,first_bytes,bytes,shown\n";
    std::printf(
        "| model | precision | triangles | file | Draco | meshopt, gzip | view | came | of the "
        "file "
        "| of Draco | of meshopt | 60 %% |\n|---|---|--:|--:|--:|--:|---|--:|--:|--:|--:|---|\n");
  }

  void add(const std::string& model, const std::string& precision, std::size_t triangles,
           std::size_t file_bytes, const Peers& peers, const char* view, const Seen& seen) {
    const auto percent = [&](std::size_t of) {
      char text[16] = "-";
      if (of > 0)
        std::snprintf(text, sizeof text, "%.0f %%", 100 * double(seen.bytes) / double(of));
      return std::string(text);
    };
    const std::size_t least =
        peers.meshopt_gzip > 0 ? std::min(peers.draco, peers.meshopt_gzip) : peers.draco;
    const bool is_met = double(seen.bytes) <= kGoal * double(least);
    std::printf(
        "| %s | %s | %.0f k | %.2f MB | %.2f MB | %.2f, %.2f MB | %s | %.2f MB | %s | %s | %s | %s "
        "|\n",
        model.c_str(), precision.c_str(), double(triangles) / 1e3, double(file_bytes) / 1e6,
        double(peers.draco) / 1e6, double(peers.meshopt) / 1e6, double(peers.meshopt_gzip) / 1e6,
        view, double(seen.bytes) / 1e6, percent(file_bytes).c_str(), percent(peers.draco).c_str(),
        percent(peers.meshopt_gzip).c_str(), is_met ? "met" : "missed");
    std::fflush(stdout);
    csv_ << model << ',' << precision << ',' << triangles << ',' << file_bytes << ',' << peers.draco
         << ',' << peers.meshopt << ',' << peers.meshopt_gzip << ',' << view << ','
         << seen.first_bytes << ',' << seen.bytes << ',' << seen.triangles << std::endl;
  }

 private:
  std::ofstream csv_;
};

Result<Seen> look(const std::string& url, const Camera& camera) {
  Result<BlockStreamer> streamer = BlockStreamer::open(open_async_http(url));
  if (!streamer.ok()) return streamer.failure();
  BlockViewParameters parameters;
  parameters.view.camera = camera;
  parameters.max_bytes = std::size_t(6) << 30;
  parameters.in_levels = false;  // which asks for nothing more
  const auto bytes = [&] { return std::size_t(streamer->statistics().source.bytes_transferred); };
  Seen seen;
  while (!streamer->update(parameters).is_complete) {
    if (seen.first_bytes == 0 && streamer->mesh().triangle_count() > 0) seen.first_bytes = bytes();
    if (streamer->trouble()) return *streamer->trouble();
    streamer->wait(std::chrono::milliseconds(16));
  }
  seen.bytes = bytes();
  if (seen.first_bytes == 0) seen.first_bytes = seen.bytes;
  seen.triangles = streamer->mesh().triangle_count();
  return seen;
}

Camera full_hd(Camera camera) {
  camera.width_px = 1920;
  camera.height_px = 1080;
  camera.pixels = 1;
  return camera;
}

// All of it in view, as bench_stream --still has it.
Camera whole_view(const Box& box) {
  Camera camera;
  camera.target = box.at(0.5, 0.5, 0.5);
  camera.position = camera.target + normalized(Vec3d{0.6, -1, 0.7}) * (1.3 * box.diagonal());
  return full_hd(camera);
}

// In the middle of the streets, or so near that a half of it fills the picture.
Camera near_view(const Box& box, bool is_city) {
  if (is_city) return full_hd(camera_at(box, true, 0.1));
  Camera camera = whole_view(box);
  camera.position = camera.target + (camera.position - camera.target) * (0.55 / 1.3);
  return camera;
}

// The smaller of what it makes with vertices at one place joined or not, if no triangle is lost.
std::size_t draco_bytes(const Mesh& mesh, const Grid& grid, int normal_bits) {
  std::size_t best = 0;
  for (const bool join : {false, true}) {
    const std::vector<char> bytes = DracoMesh(mesh, grid, true, join).encode(normal_bits);
    if (bytes.empty() || decode_draco(bytes) != mesh.triangle_count()) continue;
    if (best == 0 || bytes.size() < best) best = bytes.size();
  }
  return best;
}

void measure_meshopt(const Mesh& mesh, int position_bits, int normal_bits, const Options& options,
                     Peers& peers) {
  const std::string input = (options.cache / "final_view.bin").string();
  if (!exchange::write_mesh(input, to_exchange(mesh))) return;
  const std::optional<std::string> sizes = run_command(
      {"node", "--max-old-space-size=12000", CREASE_BENCH_SOURCE "/peers/meshopt_glb.mjs",
       options.cache.string(), input, (options.cache / "final_view_decoded.bin").string(),
       std::to_string(position_bits), std::to_string(normal_bits)});
  if (sizes) std::istringstream(*sizes) >> peers.meshopt >> peers.meshopt_gzip;
}

struct Named {
  std::string model, precision;
  int position_bits = 24;
  bool is_city = false;
};

Status measure(const Named& named, const std::filesystem::path& path, const Options& options,
               Table& table) {
  const Result<BlockFile> file = open_crease(path);
  if (!file.ok()) return file.failure();
  const ModelFacts& facts = file->facts();
  Peers peers;
  Box box;
  {
    const Result<DecodedModel> whole =
        decode_model(*file, {.contracted_bands = 0, .part_names = false});
    if (!whole.ok()) return whole.failure();
    const int bits = facts.layers.empty() ? 0 : facts.layers[0].bits;
    box = box_of(whole->mesh.positions);
    peers.draco = draco_bytes(whole->mesh, facts.grid, bits);
    if (facts.triangle_count <= options.max_meshopt_triangles) {
      measure_meshopt(whole->mesh, named.position_bits, bits, options, peers);
    }
  }
  Result<std::unique_ptr<FileServer>> server =
      FileServer::start(path.parent_path().empty() ? "." : path.parent_path());
  if (!server.ok()) return server.failure();
  const std::string url = (*server)->url() + path.filename().string();
  for (const bool is_near : {false, true}) {
    const Result<Seen> seen = look(url, is_near ? near_view(box, named.is_city) : whole_view(box));
    if (!seen.ok()) return seen.failure();
    table.add(named.model, named.precision, facts.triangle_count, file->head().file_bytes, peers,
              !is_near        ? "whole"
              : named.is_city ? "streets"
                              : "near",
              *seen);
  }
  return Done{};
}

Status measure_bytes(const Named& named, std::vector<std::byte> bytes, const Options& options,
                     Table& table) {
  const std::filesystem::path folder = options.cache / "final_view";
  std::error_code none;
  std::filesystem::create_directories(folder, none);
  const std::filesystem::path path = folder / kServed;
  if (Status status = write_crease(path, bytes); !status.ok()) return status;
  bytes = {};
  return measure(named, path, options, table);
}

Status measure_model(const ModelEntry& entry, const Options& options, Table& table) {
  const Result<Mesh> mesh = load_mesh(entry, data_folder());
  if (!mesh.ok()) return mesh.failure();
  const bool is_city = entry.kind == "city";
  Status coarse =
      measure_bytes({entry.name, "14 and 10", 14, is_city},
                    encode_sized(simplify_sized(*mesh, Placement::Endpoint, true)), options, table);
  if (!coarse.ok()) return coarse;
  Result<Built> built = build_model(*mesh, {});
  if (!built.ok()) return built.failure();
  return measure_bytes({entry.name, "24 and 12", 24, is_city}, std::move(built->file_bytes),
                       options, table);
}

int run(int argc, char** argv) {
  Options options;
  options.cache =
      std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "bench_cache";
  CLI::App app("Bytes until a view is final, beside whole models compressed");
  app.add_option("--models", options.models, "names of models.txt and models_more.txt, or none")
      ->delimiter(',');
  app.add_option("--files", options.files, ".crease files to measure besides, at their precision")
      ->delimiter(',');
  app.add_flag("--city", options.is_city, "those files are cities: look from their streets");
  app.add_option("--csv", options.csv, "write the table there as well");
  CLI11_PARSE(app, argc, argv);
  Table table(options.csv);
  int failures = 0;
  const auto note = [&failures](const std::string& name, const Status& status) {
    if (status.ok()) return;
    std::fprintf(stderr, "%s: %s\n", name.c_str(), status.failure().message.c_str());
    ++failures;
  };
  for (const ModelEntry& entry : all_models(options.models)) {
    note(entry.name, measure_model(entry, options, table));
  }
  for (const std::filesystem::path& path : options.files) {
    note(path.string(),
         measure({path.stem().string(), "as it is", 24, options.is_city}, path, options, table));
  }
  return failures > 0 ? 2 : 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
