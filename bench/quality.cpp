// How far crease and its peers are from the original at the same number of triangles.
//
//   bench/quality --models bunny,fandisk --ratios 50,10,1
//
// All are measured by compare_meshes in this run. crease is taken at the count that meshoptimizer's
// simplifyWithUpdate reached; the verdict compares with that.
#include "crease/compare.h"
#include "crease/contraction.h"
#include "crease/simplify.h"
#include "models.h"
#include "peers.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace crease::bench {
namespace {

struct Options {
  std::vector<std::string> models, peers{"update", "attributes", "vtk", "lt", "openmesh"};
  std::vector<double> ratios{50, 10, 1};  // percent
  std::size_t samples = 200'000;
  double normal_weight = SimplifyOptions{}.normal_weight;
  bool endpoint = false, fresh = false;
  std::filesystem::path list = std::filesystem::path(CREASE_BENCH_SOURCE) / "models.txt";
  std::filesystem::path cache, csv;
};

struct Row {
  std::string model;
  double ratio = 0;
  std::string method;
  std::size_t triangles = 0;
  double mean_ppm = 0, max_ppm = 0, normal_deg = 0, p95_deg = 0, seconds = 0;
};

Row measure(const Mesh& original, const Mesh& simplified, std::size_t samples) {
  const Comparison c = *compare_meshes(original, simplified, {.samples = samples});
  const auto& [a_to_b, b_to_a] = c.distance;
  Row row;
  row.triangles = simplified.triangle_count();
  row.mean_ppm = 0.5e6 * (a_to_b.mean + b_to_a.mean) / c.diagonal;
  row.max_ppm = 1e6 * std::max(a_to_b.max, b_to_a.max) / c.diagonal;
  row.normal_deg = c.normal_deviation.mean;
  row.p95_deg = c.normal_deviation.p95;
  return row;
}

// Triangles left after the first `count` contractions.
std::size_t triangles_after(const Mesh& mesh, const ContractionSequence& sequence,
                            std::size_t count) {
  std::vector<VertexId> stands_for(mesh.vertex_count());
  for (std::size_t v = 0; v < stands_for.size(); ++v) stands_for[v] = VertexId(v);
  for (std::size_t i = count; i-- > 0;) {  // latest first: `kept` is final when it is read
    const Contraction& c = sequence.contractions[i];
    stands_for[index_of(c.removed)] = stands_for[index_of(c.kept)];
  }
  std::size_t alive = 0;
  for (const Triangle& t : mesh.triangles) {
    const VertexId a = stands_for[index_of(t[0])], b = stands_for[index_of(t[1])],
                   c = stands_for[index_of(t[2])];
    alive += a != b && b != c && c != a;
  }
  return alive;
}

// The finest level with at most `triangles`.
Mesh level_of(const Mesh& mesh, const ContractionSequence& sequence, std::size_t triangles) {
  std::size_t low = 0, high = sequence.contractions.size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (triangles_after(mesh, sequence, middle) <= triangles) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return mesh_of_level(mesh, sequence, apply_contractions(mesh, sequence, low));
}

// Peers do not change, so what was measured of them is kept too, until --fresh.
Row measure_peer(const PeerResult& result, const std::filesystem::path& note, const Model& model,
                 const std::string& kind, const Options& options) {
  Row row;
  std::size_t samples = 0;
  std::ifstream known(note);
  if (!options.fresh &&
      known >> samples >> row.triangles >> row.mean_ppm >> row.max_ppm >> row.normal_deg >>
          row.p95_deg &&
      samples == options.samples) {
    return row;
  }
  row = measure(model.mesh, from_exchange(result.mesh, kind), options.samples);
  std::ofstream(note) << options.samples << ' ' << row.triangles << ' ' << row.mean_ppm << ' '
                      << row.max_ppm << ' ' << row.normal_deg << ' ' << row.p95_deg << '\n';
  return row;
}

// Nothing when the level has no triangles at all.
std::optional<Row> measure_crease(const Model& model, const ContractionSequence& sequence,
                                  std::size_t triangles, const char* name, const Options& options) {
  const Mesh level = level_of(model.mesh, sequence, triangles);
  if (level.triangle_count() == 0) return std::nullopt;
  Row row = measure(model.mesh, level, options.samples);
  row.method = name;
  return row;
}

// The folder that holds this input and what the peers made of it; empty when the disk is full.
bool prepare_cache(const std::filesystem::path& cache, const Mesh& mesh) {
  const exchange::Mesh input = to_exchange(mesh);
  exchange::Mesh known;
  const std::string path = (cache / "input.bin").string();
  if (exchange::read_mesh(path, known) && known.positions == input.positions &&
      known.corners == input.corners && known.normals == input.normals) {
    return true;
  }
  std::error_code none;
  std::filesystem::remove_all(cache, none);
  std::filesystem::create_directories(cache, none);
  return exchange::write_mesh(path, input);
}

void print(const Row& row) {
  std::printf("%-13s %5g%% %-12s %8zu  %10.4g %10.4g  %8.4g %8.4g  %8.2f\n", row.model.c_str(),
              row.ratio, row.method.c_str(), row.triangles, row.mean_ppm, row.max_ppm,
              row.normal_deg, row.p95_deg, row.seconds);
  std::fflush(stdout);
}

// What one model needs at every ratio.
struct Case {
  const ModelEntry& entry;
  const Model& model;
  const ContractionSequence& sequence;
  double seconds;  // of crease
  std::filesystem::path cache;
};

std::optional<Row> measure_peer_at(const Case& c, const Peer& peer, std::size_t target,
                                   const Options& options) {
  const std::optional<PeerResult> result = run_peer(peer, c.cache, target);
  if (!result || result->mesh.triangle_count() == 0) return std::nullopt;
  const std::string note = peer.name + "_" + std::to_string(target) + ".measured";
  Row row = measure_peer(*result, c.cache / note, c.model, c.entry.kind, options);
  row.method = peer.name;
  row.seconds = result->seconds;
  return row;
}

// Crease's share of Update's figures; both not above it is what must be.
struct Verdict {
  bool good = true;
  std::string text;

  void add(double ratio, const Row& mine, const Row& update) {
    // A lossless level measures 1e-9 ppm, not 0: below these, both are lossless.
    constexpr double kFloorPpm = 1e-4, kFloorDeg = 1e-4;
    const bool distance = mine.mean_ppm <= std::max(update.mean_ppm, kFloorPpm);
    const bool normal = mine.normal_deg <= std::max(update.normal_deg, kFloorDeg);
    good = good && distance && normal;
    char line[160];
    std::snprintf(line, sizeof line, "  %g%%: distance %s x%.3f, normals %s x%.3f;", ratio,
                  distance ? "ok" : "ABOVE", mine.mean_ppm / std::max(update.mean_ppm, kFloorPpm),
                  normal ? "ok" : "ABOVE",
                  mine.normal_deg / std::max(update.normal_deg, kFloorDeg));
    text += line;
  }
};

void measure_ratio(const Case& c, double ratio, const std::vector<Peer>& peers,
                   const Options& options, Verdict& verdict, std::vector<Row>& rows) {
  const auto target = std::size_t(double(c.model.mesh.triangle_count()) * ratio / 100);
  const auto keep = [&](Row row) {
    row.model = c.entry.name;
    row.ratio = ratio;
    if (row.method.starts_with("crease")) row.seconds = c.seconds;
    print(row);
    rows.push_back(row);
  };
  std::optional<Row> update;
  for (const Peer& peer : peers) {
    const std::optional<Row> row = measure_peer_at(c, peer, target, options);
    if (!row) {
      std::fprintf(stderr, "%s: %s gave nothing at %g %%\n", c.entry.name.c_str(),
                   peer.name.c_str(), ratio);
      continue;
    }
    keep(*row);
    if (peer.name == "update") update = row;
  }
  const std::size_t triangles = update ? update->triangles : target;
  const std::optional<Row> mine = measure_crease(c.model, c.sequence, triangles, "crease", options);
  if (mine) keep(*mine);
  if (update && mine) verdict.add(ratio, *mine, *update);
  if (!mine) verdict.good = false;
  // Where Update stopped short, crease goes on: what that costs.
  if (double(triangles) <= 1.02 * double(target)) return;
  const std::optional<Row> further =
      measure_crease(c.model, c.sequence, target, "crease there", options);
  if (further) keep(*further);
}

bool measure_model(const ModelEntry& entry, const Options& options, const std::vector<Peer>& peers,
                   std::vector<Row>& rows) {
  Result<Model> model = load_model(entry, data_folder());
  if (!model.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), model.failure().message.c_str());
    return false;
  }
  const std::filesystem::path cache = options.cache / entry.name;
  if (!prepare_cache(cache, model->mesh)) {
    std::fprintf(stderr, "%s: cannot be written\n", cache.c_str());
    return false;
  }
  const auto start = std::chrono::steady_clock::now();
  const Result<ContractionSequence> sequence =
      simplify(model->mesh, model->grid,
               {.placement = options.endpoint ? Placement::Endpoint : Placement::Optimal,
                .normal_weight = options.normal_weight,
                .progress = {}});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!sequence.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), sequence.failure().message.c_str());
    return false;
  }
  const Case c{entry, *model, *sequence, seconds, cache};
  Verdict verdict;
  for (double ratio : options.ratios) measure_ratio(c, ratio, peers, options, verdict, rows);
  std::printf("VERDICT %-13s %s%s\n\n", entry.name.c_str(), verdict.good ? "pass" : "FAIL",
              verdict.text.c_str());
  std::fflush(stdout);
  return verdict.good;
}

void write_csv(const std::filesystem::path& path, const std::vector<Row>& rows) {
  std::ofstream csv(path);
  csv << "model,ratio_percent,method,triangles,mean_ppm,max_ppm,normal_mean_deg,normal_p95_deg,"
         "seconds\n";
  for (const Row& r : rows) {
    csv << r.model << ',' << r.ratio << ',' << r.method << ',' << r.triangles << ',' << r.mean_ppm
        << ',' << r.max_ppm << ',' << r.normal_deg << ',' << r.p95_deg << ',' << r.seconds << '\n';
  }
}

int run(int argc, char** argv) {
  const std::filesystem::path self = std::filesystem::canonical("/proc/self/exe");
  Options options;
  options.cache = self.parent_path().parent_path() / "bench_cache";
  CLI::App app("Quality of crease and of its peers at the same number of triangles");
  app.add_option("--models", options.models, "names of models.txt; all by default")->delimiter(',');
  app.add_option("--ratios", options.ratios, "percent of the triangles")->delimiter(',');
  app.add_option("--peers", options.peers, "update, attributes, vtk, lt, openmesh; none")
      ->delimiter(',');
  app.add_option("--samples", options.samples, "on each surface");
  app.add_option("--normal-weight", options.normal_weight, "of crease's simplifier");
  app.add_flag("--endpoint", options.endpoint, "crease with endpoint placement");
  app.add_flag("--fresh", options.fresh, "measure the peers' results again");
  app.add_option("--list", options.list, "instead of models.txt");
  app.add_option("--cache", options.cache, "where peers' results stay");
  app.add_option("--csv", options.csv, "write the table there as well");
  CLI11_PARSE(app, argc, argv);

  const Result<std::vector<ModelEntry>> entries = read_models(options.list);
  if (!entries.ok()) {
    std::fprintf(stderr, "%s\n", entries.failure().message.c_str());
    return 2;
  }
  std::vector<Peer> peers = all_peers(self.parent_path());
  std::erase_if(peers, [&](const Peer& peer) {
    return std::ranges::find(options.peers, peer.name) == options.peers.end();
  });
  std::printf("%-13s %6s %-12s %8s  %10s %10s  %8s %8s  %8s\n", "model", "ratio", "method", "tris",
              "mean ppm", "max ppm", "mean deg", "p95 deg", "seconds");
  std::vector<Row> rows;
  int failed = 0;
  for (const ModelEntry& entry : *entries) {
    const bool wanted = options.models.empty() ||
                        std::ranges::find(options.models, entry.name) != options.models.end();
    if (wanted) failed += !measure_model(entry, options, peers, rows);
  }
  if (!options.csv.empty()) write_csv(options.csv, rows);
  std::printf("%d models above simplifyWithUpdate\n", failed);
  return failed == 0 ? 0 : 6;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
