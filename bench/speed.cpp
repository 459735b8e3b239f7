// How fast crease makes its whole sequence, beside peers that simplify to 1 %.
//
//   bench/speed --models bunny,city200k --rounds 5
//
// Every run is a process of its own; crease and the peers take turns, so that whatever else the
// machine does falls on all of them. Rates are triangles removed per second of the library's call
// alone, from a mesh that is in memory.
#include "models.h"
#include "peers.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace crease::bench {
namespace {

struct Options {
  std::vector<std::string> models{"bunny", "wrist", "berlin", "city200k"},
      peers{"vtk", "attributes"};
  int rounds = 5;
  std::filesystem::path list = std::filesystem::path(CREASE_BENCH_SOURCE) / "models.txt";
  std::filesystem::path cache, csv;
};

struct Runner {
  std::string name;
  std::vector<std::string> command;
  double removed = 0;  // triangles
  std::vector<double> seconds, processor_seconds;
  double peak_bytes = 0;  // crease only
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

// Seconds by the wall clock and of the processor, then for crease the peak of its memory in bytes.
bool run_once(Runner& runner) {
  const std::optional<std::string> line = run_command(runner.command);
  if (!line) return false;
  std::istringstream words(*line);
  double seconds = 0, processor_seconds = 0, bytes = 0;
  if (!(words >> seconds >> processor_seconds)) return false;
  if (words >> bytes) runner.peak_bytes = std::max(runner.peak_bytes, bytes);
  runner.seconds.push_back(seconds);
  runner.processor_seconds.push_back(processor_seconds);
  return true;
}

bool measure_model(const ModelEntry& entry, const Options& options,
                   const std::filesystem::path& programs, std::ofstream& csv) {
  Result<Model> model = load_model(entry, data_folder());
  if (!model.ok()) {
    std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), model.failure().message.c_str());
    return false;
  }
  const std::filesystem::path input = options.cache / (entry.name + "_speed.bin");
  const std::filesystem::path output = options.cache / "speed_result.bin";
  if (!exchange::write_mesh(input.string(), to_exchange(model->mesh))) {
    std::fprintf(stderr, "%s: cannot be written\n", input.c_str());
    return false;
  }
  const std::size_t triangles = model->mesh.triangle_count();
  *model = {};

  std::vector<Runner> runners;
  const std::string crease = (programs / "bench_simplify_once").string();
  for (const char* threads : {"1", "2"}) {
    runners.push_back({.name = std::string("crease, threads ") + threads,
                       .command = {crease, input.string(), threads},
                       .removed = double(triangles),
                       .seconds = {},
                       .processor_seconds = {}});
  }
  const std::size_t target = triangles / 100;
  for (const Peer& peer : all_peers(programs)) {
    if (std::ranges::find(options.peers, peer.name) == options.peers.end()) continue;
    std::vector<std::string> command = peer.command;
    command.insert(command.end(), {input.string(), output.string(), std::to_string(target)});
    runners.push_back({.name = peer.name + " to 1 %",
                       .command = command,
                       .removed = double(triangles - target),
                       .seconds = {},
                       .processor_seconds = {}});
  }
  for (int round = 0; round < options.rounds; ++round) {
    for (Runner& runner : runners) {
      if (!run_once(runner)) std::fprintf(stderr, "%s failed\n", runner.name.c_str());
    }
  }

  std::map<std::string, double> rate, processor_rate;
  for (const Runner& r : runners) {
    if (r.seconds.empty()) continue;
    const auto [least, most] = std::ranges::minmax(r.seconds);
    const double middle = median(r.seconds);
    const double processor = median(r.processor_seconds);
    rate[r.name] = r.removed / middle;
    processor_rate[r.name] = r.removed / processor;
    const double bytes = r.peak_bytes / double(triangles);
    std::printf(
        "%-12s %-20s %9zu tris  median %8.3f s  (%.3f to %.3f)  processor %8.3f s  "
        "%8.0f tris/s",
        entry.name.c_str(), r.name.c_str(), triangles, middle, least, most, processor,
        r.removed / middle);
    if (bytes > 0) std::printf("  peak %.0f bytes/tri", bytes);
    std::printf("\n");
    if (csv) {
      csv << entry.name << ',' << triangles << ',' << '"' << r.name << '"' << ',' << middle << ','
          << least << ',' << most << ',' << processor << ',' << r.removed / middle << ',' << bytes
          << '\n';
    }
  }
  if (rate.contains("vtk to 1 %")) {
    std::printf(
        "%-12s crease on one thread: %.2f times VTK (%.2f by processor time); on two: %.2f "
        "times one\n\n",
        entry.name.c_str(), rate["crease, threads 1"] / rate["vtk to 1 %"],
        processor_rate["crease, threads 1"] / processor_rate["vtk to 1 %"],
        rate["crease, threads 2"] / rate["crease, threads 1"]);
  }
  std::fflush(stdout);
  std::error_code none;
  std::filesystem::remove(input, none);
  std::filesystem::remove(output, none);
  return true;
}

int run(int argc, char** argv) {
  const std::filesystem::path self = std::filesystem::canonical("/proc/self/exe");
  Options options;
  options.cache = self.parent_path().parent_path() / "bench_cache";
  CLI::App app("Speed and memory of crease's whole sequence beside peers that simplify to 1 %");
  app.add_option("--models", options.models, "names of models.txt")->delimiter(',');
  app.add_option("--peers", options.peers, "vtk, attributes, update, lt, openmesh")->delimiter(',');
  app.add_option("--rounds", options.rounds, "runs of each");
  app.add_option("--list", options.list, "instead of models.txt");
  app.add_option("--cache", options.cache, "for the files in between");
  app.add_option("--csv", options.csv, "write the table there as well");
  CLI11_PARSE(app, argc, argv);

  const Result<std::vector<ModelEntry>> entries = read_models(options.list);
  if (!entries.ok()) {
    std::fprintf(stderr, "%s\n", entries.failure().message.c_str());
    return 2;
  }
  std::error_code none;
  std::filesystem::create_directories(options.cache, none);
  std::ofstream csv;
  if (!options.csv.empty()) {
    csv.open(options.csv);
    csv << "model,triangles,method,median_s,least_s,most_s,processor_s,triangles_per_s,peak_bytes_"
           "per_"
           "triangle\n";
  }
  bool good = true;
  for (const ModelEntry& entry : *entries) {
    if (std::ranges::find(options.models, entry.name) == options.models.end()) continue;
    good = measure_model(entry, options, self.parent_path(), csv) && good;
  }
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
