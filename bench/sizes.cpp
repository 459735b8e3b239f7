// What files take, and how fast they are written and read, beside Draco on the same snapped mesh.
//
//   bench_sizes [--models bunny,fandisk] [--rounds 5] [--csv sizes_bench.csv] [--write]
//
// Positions at 14 bits over the longest side; without attributes and with 10 bits a component of
// normals, at both placements. Everything counts: bits a vertex are 8 * the file's bytes / the
// input's vertices, for both. Times are of the processor on one thread, medians of `rounds` turns
// that take each program after the other.
#include "bare_blocks.h"
#include "crease/file.h"
#include "draco_mesh.h"
#include "heap.h"
#include "models.h"
#include "parallel/parallel.h"
#include "pipeline/sized_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>

namespace crease::bench {
namespace {

struct Options {
  std::vector<std::string> models;
  std::size_t max_triangles = 400'000;  // 0: all
  int rounds = 3;
  bool write = false;
  std::filesystem::path csv, sizes = CREASE_BENCH_SOURCE "/../tests/sizes.csv";
};

struct Times {
  std::vector<double> encode, decode, blocks;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

struct Coded {
  std::size_t bytes = 0, decode_peak = 0;  // bytes of memory beside the file and the result
  Times times;
};

struct Line {
  std::string model, kind;
  std::size_t vertices = 0, triangles = 0;
  bool with_normals = false;
  std::array<Coded, 2> ours;  // by placement
  Coded draco;
  StreamBits streams;         // of the endpoint file
  std::size_t container = 0;  // its bytes that are no block's
  double bits(const Coded& coded) const { return 8 * double(coded.bytes) / double(vertices); }
  double ratio(Placement p) const {
    return double(ours[std::size_t(p)].bytes) / double(draco.bytes);
  }
};

// The ratio that a file must not exceed, 0: none is asked for.
double limit_of(const Line& line) {
  if (line.kind == "scan") return 1.35;
  if (line.kind == "cad") return line.with_normals ? 1.1 : 1.25;
  const bool is_named = line.model.starts_with("berlin") || line.model.starts_with("linz");
  return line.with_normals && is_named ? 1.0 : 0;
}

// What decoding takes beside what it gives.
template <typename Decode>
std::size_t working_memory(const Decode& decode) {
  HeapWatch watch;
  const auto result = decode();
  return watch.most() - std::min(watch.most(), watch.now());
}

template <typename Work>
double seconds_of(const Work& work) {
  const double begin = processor_seconds();
  work();
  return processor_seconds() - begin;
}

struct File {
  SizedModel model;
  std::vector<std::byte> bytes;
  Result<BlockFile> opened() const { return BlockFile::open(memory_source(bytes)); }
};

// One turn of everything that is timed.
bool take_turn(const std::array<File, 2>& files, const DracoMesh& draco, Line& line) {
  for (const Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    const File& file = files[std::size_t(placement)];
    Times& times = line.ours[std::size_t(placement)].times;
    SizedModel copy = file.model;
    times.encode.push_back(
        run_on(1, [&] { return seconds_of([&] { encode_sized(std::move(copy)); }); }));
    const Result<BlockFile> opened = file.opened();
    bool decoded = false;
    times.decode.push_back(seconds_of([&] { decoded = decode_model(*opened).ok(); }));
    const Result<BareBlocks> blocks = decode_bare_blocks(*opened);
    if (!decoded || !blocks.ok()) return false;
    times.blocks.push_back(blocks->seconds);
  }
  std::vector<char> bytes;
  line.draco.times.encode.push_back(seconds_of([&] { bytes = draco.encode(); }));
  line.draco.times.decode.push_back(seconds_of([&] { decode_draco(bytes); }));
  return true;
}

bool measure_file(const File& file, Placement placement, Line& line) {
  Coded& coded = line.ours[std::size_t(placement)];
  const Result<BlockFile> opened = file.opened();
  if (!opened.ok()) return false;
  const Result<DecodedModel> whole = decode_model(*opened, {.count_bits = true});
  if (!whole.ok() || whole->mesh.triangle_count() != line.triangles) return false;
  coded.bytes = file.bytes.size();
  coded.decode_peak = working_memory([&] { return decode_model(*opened); });
  if (placement != Placement::Endpoint) return true;
  for (const StreamBits& bits : whole->bits) line.streams += bits;
  line.container = file.bytes.size() - whole->payload_bytes;
  return true;
}

// The smaller of what Draco makes with vertices at one place joined or not, if no triangle is lost.
std::unique_ptr<DracoMesh> best_draco(const SizedModel& model, bool with_normals, Coded& coded) {
  std::unique_ptr<DracoMesh> best;
  for (const bool join : {false, true}) {
    auto mesh = std::make_unique<DracoMesh>(model.mesh, model.sequence.grid, with_normals, join);
    const std::vector<char> bytes = mesh->encode();
    if (decode_draco(bytes) != model.mesh.triangle_count()) continue;
    if (best != nullptr && bytes.size() >= coded.bytes) continue;
    coded.bytes = bytes.size();
    coded.decode_peak = working_memory([&] { return decode_draco(bytes); });
    best = std::move(mesh);
  }
  return best;
}

Result<Line> measure(const ModelEntry& entry, const Mesh& mesh, bool with_normals, int rounds) {
  const Failure failed = fail(Error::BadFormat, entry.name + ": it does not come back");
  Line line{.model = entry.name,
            .kind = entry.kind,
            .vertices = mesh.vertex_count(),
            .triangles = mesh.triangle_count(),
            .with_normals = with_normals,
            .ours = {},
            .draco = {},
            .streams = {}};
  std::array<File, 2> files;
  for (const Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    File& file = files[std::size_t(placement)];
    file.model = simplify_sized(mesh, placement, with_normals);
    file.bytes = encode_sized(file.model);
    if (!measure_file(file, placement, line)) return failed;
  }
  const std::unique_ptr<DracoMesh> draco = best_draco(files[0].model, with_normals, line.draco);
  if (draco == nullptr) return fail(Error::BadFormat, entry.name + ": Draco refuses it");
  for (int i = 0; i < rounds; ++i) {
    if (!take_turn(files, *draco, line)) return failed;
  }
  return line;
}

void print(const Line& line) {
  const double million = double(line.triangles) / 1e6;
  const double limit = limit_of(line);
  const Coded& ours = line.ours[std::size_t(Placement::Optimal)];
  std::printf("%-12s %-4s %-8s %7zu vertices  endpoint %6.2f  optimal %6.2f  Draco %6.2f bits",
              line.model.c_str(), line.kind.c_str(), line.with_normals ? "normals" : "geometry",
              line.vertices, line.bits(line.ours[0]), line.bits(line.ours[1]),
              line.bits(line.draco));
  std::printf("  ratio %.2f %.2f", line.ratio(Placement::Endpoint), line.ratio(Placement::Optimal));
  if (limit > 0) {
    std::printf("  (at most %.2f: %s, %s)", limit,
                line.ratio(Placement::Endpoint) <= limit ? "met" : "MISSED",
                line.ratio(Placement::Optimal) <= limit ? "met" : "MISSED");
  }
  std::printf("\n    M triangles/s, optimal: decoded %.2f, its blocks alone %.2f, Draco %.2f;",
              million / median(ours.times.decode), million / median(ours.times.blocks),
              million / median(line.draco.times.decode));
  std::printf(" encoded %.2f, Draco %.2f; memory to decode %.0f, Draco %.0f bytes a triangle\n",
              million / median(ours.times.encode), million / median(line.draco.times.encode),
              double(ours.decode_peak) / double(line.triangles),
              double(line.draco.decode_peak) / double(line.triangles));
  std::fflush(stdout);
}

void write_csv(const std::filesystem::path& path, const std::vector<Line>& lines) {
  std::ofstream csv(path);
  csv << "model,class,normals,vertices,triangles,limit,endpoint_bytes,optimal_bytes,draco_bytes,"
         "container,roots,flags,shapes,positions,categories,values,labels";
  for (const char* who : {"endpoint", "optimal"}) {
    for (const char* what : {"encode_s", "decode_s", "blocks_s", "decode_peak"}) {
      csv << ',' << who << '_' << what;
    }
  }
  csv << ",draco_encode_s,draco_decode_s,draco_decode_peak\n";
  for (const Line& l : lines) {
    csv << l.model << ',' << l.kind << ',' << l.with_normals << ',' << l.vertices << ','
        << l.triangles << ',' << limit_of(l) << ',' << l.ours[0].bytes << ',' << l.ours[1].bytes
        << ',' << l.draco.bytes;
    const StreamBits& s = l.streams;
    for (const double bits : {8.0 * double(l.container), s.roots, s.flags, s.shapes, s.positions,
                              s.categories, s.values, s.labels}) {
      csv << ',' << bits / double(l.vertices);
    }
    for (const Coded& c : l.ours) {
      csv << ',' << median(c.times.encode) << ',' << median(c.times.decode) << ','
          << median(c.times.blocks) << ',' << c.decode_peak;
    }
    csv << ',' << median(l.draco.times.encode) << ',' << median(l.draco.times.decode) << ','
        << l.draco.decode_peak << '\n';
  }
}

// Geometric means over a class, which is what one model's luck moves least.
void print_summary(const std::vector<Line>& lines) {
  struct Sum {
    double endpoint = 0, optimal = 0;
    int count = 0, limited = 0, endpoint_met = 0, optimal_met = 0;
  };
  std::map<std::string, Sum> sums;
  for (const Line& line : lines) {
    Sum& sum = sums[line.kind + (line.with_normals ? ", normals" : ", geometry")];
    sum.endpoint += std::log(line.ratio(Placement::Endpoint));
    sum.optimal += std::log(line.ratio(Placement::Optimal));
    ++sum.count;
    if (limit_of(line) == 0) continue;
    ++sum.limited;
    sum.endpoint_met += line.ratio(Placement::Endpoint) <= limit_of(line);
    sum.optimal_met += line.ratio(Placement::Optimal) <= limit_of(line);
  }
  for (const auto& [name, sum] : sums) {
    std::printf("%-16s mean ratio endpoint %.3f optimal %.3f; limit met by %d, %d of %d models\n",
                name.c_str(), std::exp(sum.endpoint / sum.count), std::exp(sum.optimal / sum.count),
                sum.endpoint_met, sum.optimal_met, sum.limited);
  }
}

// What tests/sizes.csv has of a file becomes `row`; a warning where it grew.
void compare(std::vector<SizeRow>& known, SizeRow row) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const SizeRow& old) { return old.is_same_file(row); });
  if (found == known.end()) {
    known.push_back(std::move(row));
    return;
  }
  if (double(row.bytes) > 1.01 * double(found->bytes)) {
    std::printf("%s: %zu bytes, more than 1 %% above the %zu of tests/sizes.csv\n",
                row.model.c_str(), row.bytes, found->bytes);
  }
  *found = std::move(row);
}

void measure_own(std::vector<SizeRow>& rows) {
  for (const std::string& name : own_models()) {
    const Mesh mesh = own_model(name);
    for (const bool with_normals : {false, true}) {
      for (const Placement placement : {Placement::Endpoint, Placement::Optimal}) {
        const std::size_t bytes =
            encode_sized(simplify_sized(mesh, placement, with_normals)).size();
        compare(rows,
                {"own:" + name, "-", "-", mesh.triangle_count(), placement, with_normals, bytes});
      }
    }
  }
}

void add_rows(std::vector<SizeRow>& rows, const ModelEntry& entry, const Line& line) {
  if (entry.where.starts_with("generate:")) return;
  for (const Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    compare(rows, {entry.name, entry.where, entry.normals, line.triangles, placement,
                   line.with_normals, line.ours[std::size_t(placement)].bytes});
  }
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Sizes and speed of model.crease beside Draco");
  app.add_option("--models", options.models, "names of models.txt and models_more.txt")
      ->delimiter(',');
  app.add_option("--max-triangles", options.max_triangles, "larger ones are left out; 0: none");
  app.add_option("--rounds", options.rounds, "turns that are timed");
  app.add_option("--csv", options.csv, "write everything there");
  app.add_flag("--write", options.write, "write tests/sizes.csv");
  CLI11_PARSE(app, argc, argv);

  std::vector<SizeRow> sizes = read_sizes(options.sizes);
  std::vector<Line> lines;
  bool good = true;
  for (const ModelEntry& entry : all_models(options.models)) {
    const Result<Mesh> mesh = load_mesh(entry, data_folder());
    if (!mesh.ok()) {
      std::fprintf(stderr, "%s\n", mesh.failure().message.c_str());
      continue;
    }
    if (options.max_triangles > 0 && mesh->triangle_count() > options.max_triangles) continue;
    for (const bool with_normals : {false, true}) {
      Result<Line> line = measure(entry, *mesh, with_normals, options.rounds);
      if (!line.ok()) {
        std::fprintf(stderr, "%s\n", line.failure().message.c_str());
        good = false;
        continue;
      }
      print(*line);
      add_rows(sizes, entry, *line);
      lines.push_back(*std::move(line));
    }
  }
  measure_own(sizes);
  print_summary(lines);
  if (!options.csv.empty()) write_csv(options.csv, lines);
  if (options.write && !write_sizes(options.sizes, sizes)) good = false;
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
