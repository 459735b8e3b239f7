// What one sees of a model after its first bytes: prefixes of model.crease, beside Draco, which
// shows nothing before its last byte, and a chain of GLBs with meshopt compression, coarse to fine.
//
//   bench_progressive [--models bunny,berlin] [--csv progressive.csv]
//
// Positions of 14 bits, normals of 10 bits a component in all of them. A prefix shows the blocks
// that lie wholly in it. Errors are those of compare_meshes against the input: distance in
// millionths of its diagonal, normals in degrees.
#include "crease/compare.h"
#include "crease/file.h"
#include "draco_mesh.h"
#include "models.h"
#include "peers.h"
#include "pipeline/sized_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace crease::bench {
namespace {

constexpr double kPrefixes[] = {1, 2, 5, 10, 20, 50, 100};  // percent
constexpr std::size_t kChain[] = {64, 16, 4, 1};            // shares of the triangles
constexpr double kFiner = 1.1;  // a level with fewer triangles than so many times the last is none

struct Options {
  std::vector<std::string> models{"bunny", "lucy", "kuka", "berlin", "city200k"};
  std::size_t samples = 200'000;
  std::filesystem::path cache, csv, programs;
};

class Report {
 public:
  Report(const ModelEntry& entry, const Mesh& original, std::size_t samples, std::ofstream& csv)
      : entry_(entry), original_(original), samples_(samples), csv_(csv) {}

  // `step`: what was read of the method's bytes, in words.
  void add(const std::string& method, const std::string& step, std::size_t bytes,
           const Mesh& shown) {
    if (shown.triangle_count() == 0) return;
    const Comparison c = *compare_meshes(original_, shown, {.samples = samples_});
    const double ppm = 0.5e6 * (c.distance.a_to_b.mean + c.distance.b_to_a.mean) / c.diagonal;
    std::printf("%-10s %-16s %-13s %9zu bytes %8zu triangles %10.2f ppm %8.3f degrees\n",
                entry_.name.c_str(), method.c_str(), step.c_str(), bytes, shown.triangle_count(),
                ppm, c.normal_deviation.mean);
    std::fflush(stdout);
    csv_ << entry_.name << ',' << method << ',' << step << ',' << bytes << ','
         << shown.triangle_count() << ',' << ppm << ',' << c.normal_deviation.mean << '\n';
  }

 private:
  const ModelEntry& entry_;
  const Mesh& original_;
  std::size_t samples_;
  std::ofstream& csv_;
};

// How many blocks lie wholly in the first `bytes`; the directory pages before them do as well.
Result<std::uint32_t> blocks_in(std::span<const std::byte> prefix) {
  const Result<BlockFile> file = BlockFile::open(memory_source(prefix));
  if (!file.ok()) return file.failure();
  return file->complete_blocks();
}

bool add_prefix(const BlockFile& file, std::span<const std::byte> prefix, const std::string& method,
                const std::string& step, Report& report) {
  const Result<std::uint32_t> blocks = blocks_in(prefix);
  if (!blocks.ok() || *blocks == 0) return true;  // not even the head, or not the base
  const Result<DecodedModel> shown = decode_model(
      file, {.wants = [&](const BlockEntry& entry) { return index_of(entry.id) < *blocks; }});
  if (shown.ok()) report.add(method, step, prefix.size(), shown->mesh);
  return shown.ok();
}

std::size_t share(std::size_t bytes, double percent) {
  return std::size_t(std::llround(double(bytes) * percent / 100));
}

// Of its own bytes, and of as many as Draco takes.
bool add_crease(const SizedModel& model, const std::string& method, std::size_t draco_bytes,
                Report& report) {
  const std::vector<std::byte> bytes = encode_sized(model);
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  if (!file.ok()) return false;
  for (const double percent : kPrefixes) {
    char step[16];
    std::snprintf(step, sizeof step, "%g%%", percent);
    const std::size_t own = share(bytes.size(), percent);
    const std::size_t dracos = std::min(share(draco_bytes, percent), bytes.size());
    if (!add_prefix(*file, std::span(bytes).first(own), method, step, report) ||
        !add_prefix(*file, std::span(bytes).first(dracos), method, std::string(step) + " of Draco",
                    report)) {
      return false;
    }
  }
  return true;
}

// Gives its bytes.
std::size_t add_draco(const SizedModel& model, Report& report) {
  const Grid& grid = model.sequence.grid;
  const std::vector<char> bytes = DracoMesh(model.mesh, grid, true, false).encode();
  report.add("draco", "100%", bytes.size(), draco_result(bytes, grid));
  return bytes.size();
}

// Levels by meshoptimizer's own simplifyWithUpdate, each as a GLB; bytes of all so far. Where it
// stops short, levels that would repeat a coarser one are left out.
bool add_chain(const ModelEntry& entry, const Mesh& original, const Options& options,
               Report& report) {
  const std::filesystem::path cache = options.cache / (entry.name + "_chain");
  std::error_code none;
  std::filesystem::remove_all(cache, none);
  std::filesystem::create_directories(cache, none);
  const std::filesystem::path input = cache / "input.bin", decoded = cache / "decoded.bin";
  if (!exchange::write_mesh(input.string(), to_exchange(original))) return false;
  const Peer update = all_peers(options.programs).front();
  std::size_t bytes = 0, zipped = 0;
  double last_triangles = 0;
  for (const std::size_t part : kChain) {
    std::filesystem::path level = input;
    if (part > 1) {
      const std::size_t triangles = original.triangle_count() / part;
      if (!run_peer(update, cache, triangles)) return false;
      level = cache / ("update_" + std::to_string(triangles) + ".bin");
    }
    const std::optional<std::string> sizes =
        run_command({"node", CREASE_BENCH_SOURCE "/peers/meshopt_glb.mjs", options.cache.string(),
                     level.string(), decoded.string()});
    exchange::Mesh shown;
    std::size_t glb = 0, gzip = 0;
    if (!sizes || !(std::istringstream(*sizes) >> glb >> gzip) ||
        !exchange::read_mesh(decoded.string(), shown)) {
      return false;
    }
    if (double(shown.triangle_count()) < kFiner * last_triangles) continue;
    last_triangles = double(shown.triangle_count());
    const Mesh mesh = from_exchange(shown, entry.kind);
    const std::string step = "1/" + std::to_string(part);
    report.add("meshopt", step, bytes += glb, mesh);
    report.add("meshopt_gzip", step, zipped += gzip, mesh);
  }
  return true;
}

bool measure(const ModelEntry& entry, const Options& options, std::ofstream& csv) {
  const Result<Mesh> original = load_mesh(entry, data_folder());
  if (!original.ok()) {
    std::fprintf(stderr, "%s\n", original.failure().message.c_str());
    return true;  // reported and left out
  }
  Report report(entry, *original, options.samples, csv);
  const SizedModel endpoint = simplify_sized(*original, Placement::Endpoint, true);
  const std::size_t draco_bytes = add_draco(endpoint, report);
  if (!add_crease(endpoint, "crease_endpoint", draco_bytes, report) ||
      !add_crease(simplify_sized(*original, Placement::Optimal, true), "crease_optimal",
                  draco_bytes, report)) {
    return false;
  }
  return add_chain(entry, *original, options, report);
}

int run(int argc, char** argv) {
  Options options;
  options.programs = std::filesystem::canonical("/proc/self/exe").parent_path();
  options.cache = options.programs.parent_path() / "bench_cache";
  CLI::App app("What prefixes of files show");
  app.add_option("--models", options.models, "names of models.txt and models_more.txt")
      ->delimiter(',');
  app.add_option("--samples", options.samples, "on each surface");
  app.add_option("--csv", options.csv, "write the table there as well");
  CLI11_PARSE(app, argc, argv);
  std::ofstream csv;
  if (!options.csv.empty()) csv.open(options.csv);
  csv << "model,method,step,bytes,triangles,mean_ppm,normal_mean_deg\n";
  bool good = true;
  for (const ModelEntry& entry : all_models(options.models)) {
    if (measure(entry, options, csv)) continue;
    std::fprintf(stderr, "%s: failed\n", entry.name.c_str());
    good = false;
  }
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
