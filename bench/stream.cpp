// A flight through a file that streams, in real time: what a frame costs, what is shown, and what
// memory it takes.
//
//   bench_stream city.crease --budget 256 --frames 1200
//   bench_stream http://127.0.0.1:8080/city.crease --city --csv flight.csv
//   bench_stream berlin.crease --vertex             by block, by vertex in blocks and by vertex
//   over
//                                                   the whole model, at the same error
//   bench_stream URL --city --check 200 --sound city.crease     every 200th frame against brute
//                                                   force; the clock stands still meanwhile
//   bench_stream http://127.0.0.1:8080/city.crease --still      time and bytes until the model,
//                                                   seen whole, has its first picture and is right
//
// The camera moves by the clock: a frame that takes long is a frame that misses what lies between.
// Only the calls that a program makes each frame are timed; drawing is not among them.
#include "crease/adaptive_mesh.h"
#include "crease/block_streamer.h"
#include "crease/block_view.h"
#include "crease/build_hierarchy.h"
#include "crease/decode_model.h"
#include "crease/file.h"
#include "crease/http_source.h"
#include "cut_check.h"
#include "flight.h"

#include <CLI/CLI.hpp>

#include <sys/resource.h>
#include <unistd.h>
#include <ctime>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace crease::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double peak_megabytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

double resident_megabytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  long total = 0, resident = 0;
  const int read = std::fscanf(file, "%ld %ld", &total, &resident);
  std::fclose(file);
  return read == 2 ? double(resident) * double(sysconf(_SC_PAGESIZE)) / 1e6 : 0;
}

// Times that this thread gave the processor away by itself: for a lock, a file, a line.
long waits() {
  rusage usage;
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

struct Options {
  std::string file, csv, sound;
  double budget_mb = 256, pixels = 1, frames_per_second = 30;
  int frames = 900, threads = 1, check_every = 0;
  bool is_city = false, by_vertex = false, in_blocks = false, is_still = false;
};

struct Frame {
  double at = 0, wall = 0, cpu = 0, process_mb = 0;
  long waits = 0;
  std::size_t triangles = 0, resident = 0, blocks = 0, missing = 0;
  float error = 0;
};

int failed(const Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.message.c_str());
  return 2;
}

Result<BlockStreamer> open(const Options& options) {
  Result<AsyncSourcePtr> source = is_http_url(options.file)
                                      ? Result<AsyncSourcePtr>(open_async_http(options.file))
                                      : open_async_file(options.file);
  if (!source.ok()) return source.failure();
  StreamOptions stream{.decode_threads = options.threads};
  if (options.is_still) stream.prefetch_frames = 0;  // the camera leaps once, and then stays
  return BlockStreamer::open(*source, stream);
}

// What the first blocks show, to know where to fly. A base may be two triangles and tells nothing
// of how large a model is. `begins`: called once something is shown.
template <typename Begins>
Box box_of_start(BlockStreamer& streamer, Begins begins) {
  constexpr std::size_t kEnough = 1000;
  BlockViewParameters coarse;
  coarse.view.max_triangles = std::clamp<std::size_t>(streamer.mesh().facts().triangle_count / 50,
                                                      4 * kEnough, 20 * kEnough);
  coarse.in_levels = false;
  const BlockMesh& mesh = streamer.mesh();
  bool has_begun = false;
  for (;;) {
    streamer.update(coarse);
    if (!has_begun && !mesh.shown().empty()) begins();
    has_begun |= !mesh.shown().empty();
    if (has_begun && (mesh.missing().empty() || mesh.triangle_count() >= kEnough)) break;
    streamer.wait(std::chrono::milliseconds(100));
  }
  std::vector<Vec3d> positions;
  for (const ShownRange& range : mesh.shown()) {
    const DrawList list = range.block->draw_list();
    for (const Vec3f& p : list.positions) positions.push_back(list.origin + Vec3d{p.x, p.y, p.z});
  }
  return box_of(positions);
}

Frame fly_one(BlockStreamer& streamer, const BlockViewParameters& parameters) {
  Frame frame;
  const Clock::time_point start = Clock::now();
  const double cpu = thread_seconds();
  const long waited = waits();
  streamer.update(parameters);
  frame.waits = waits() - waited;
  frame.cpu = thread_seconds() - cpu;
  frame.wall = seconds_since(start);
  frame.process_mb = resident_megabytes();
  const BlockMesh& mesh = streamer.mesh();
  frame.triangles = mesh.triangle_count();
  frame.resident = mesh.resident_bytes();
  frame.blocks = mesh.resident_count();
  frame.missing = mesh.missing().size();
  frame.error = mesh.view_error() * float(parameters.view.camera.pixels);
  return frame;
}

double of_all(std::vector<double> all, double share) {
  std::sort(all.begin(), all.end());
  return all.empty() ? 0 : all[std::min(all.size() - 1, std::size_t(share * double(all.size())))];
}

void write_csv(const std::string& path, const std::vector<Frame>& frames) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) return;
  std::fprintf(out,
               "seconds,update_ms,triangles,resident_mb,blocks,missing,error_pixels,process_mb\n");
  for (const Frame& f : frames) {
    std::fprintf(out, "%.3f,%.4f,%zu,%.2f,%zu,%zu,%.3f,%.1f\n", f.at, f.wall * 1e3, f.triangles,
                 double(f.resident) / 1e6, f.blocks, f.missing, double(f.error), f.process_mb);
  }
  std::fclose(out);
}

void report(const Options& options, const BlockStreamer& streamer,
            const std::vector<Frame>& frames) {
  std::vector<double> cpu, wall, triangles, errors, blocks;
  std::size_t resident = 0, within = 0, waiting = 0;
  double process_mb = options.check_every > 0 ? 0 : peak_megabytes();  // a check takes memory too
  for (const Frame& f : frames) {
    cpu.push_back(f.cpu * 1e3);
    wall.push_back(f.wall * 1e3);
    triangles.push_back(double(f.triangles));
    errors.push_back(double(f.error));
    blocks.push_back(double(f.blocks));
    resident = std::max(resident, f.resident);
    within += f.error <= float(options.pixels);
    waiting += f.waits > 0;
    process_mb = std::max(process_mb, f.process_mb);
  }
  const StreamStatistics statistics = streamer.statistics();
  std::printf(
      "%s: %zu frames of %.1f s, budget %.0f MB\n"
      "  update: cpu %.3f ms median, %.3f 99 %%, %.3f most; by the clock %.3f ms 99 %%, %.3f most\n"
      "  waited in update: %zu frames\n"
      "  shown: %.0f triangles median; error %.2f px median, %.2f 95 %%; within %.3g px in %.1f %% "
      "of the frames\n"
      "  resident: %.0f blocks median, %.1f MB most; process %.0f MB most\n"
      "  source: %.1f MB in %llu requests; %.1f MB in %llu ranges asked for, %llu of them "
      "cancelled; latency mean %.1f ms, most %.1f ms, %llu retries\n"
      "  decoded %zu blocks in %.2f s, prefetched %zu, dropped %zu, failed %zu\n",
      options.file.c_str(), frames.size(), frames.back().at, options.budget_mb, of_all(cpu, 0.5),
      of_all(cpu, 0.99), of_all(cpu, 1), of_all(wall, 0.99), of_all(wall, 1), waiting,
      of_all(triangles, 0.5), of_all(errors, 0.5), of_all(errors, 0.95), options.pixels,
      100.0 * double(within) / double(frames.size()), of_all(blocks, 0.5), double(resident) / 1e6,
      process_mb, double(statistics.source.bytes_transferred) / 1e6,
      static_cast<unsigned long long>(statistics.source.requests),
      double(statistics.source.bytes_asked) / 1e6,
      static_cast<unsigned long long>(statistics.source.asked),
      static_cast<unsigned long long>(statistics.source.cancelled),
      statistics.source.latency_mean_seconds * 1e3, statistics.source.latency_max_seconds * 1e3,
      static_cast<unsigned long long>(statistics.source.retries), statistics.blocks_decoded,
      statistics.decode_seconds, statistics.blocks_prefetched, statistics.blocks_dropped,
      statistics.blocks_failed);
}

// Frames that were looked at and those that were wrong.
struct Checked {
  std::size_t frames = 0, wrong = 0, triangles = 0;

  void add(int frame, const CutCheck::Found& found) {
    ++frames;
    wrong += !found.is_right();
    triangles += found.triangles;
    if (found.is_right()) return;
    std::printf("  frame %d: %zu open edges, %zu blocks that are not the file's, %zu differences\n",
                frame, found.open_edges, found.wrong_blocks, found.differences);
  }
};

int fly(const Options& options) {
  std::optional<CutCheck> check;
  if (options.check_every > 0) {
    Result<CutCheck> sound = CutCheck::open(options.sound.empty() ? options.file : options.sound);
    if (!sound.ok()) return failed(sound.failure());
    check = *std::move(sound);
  }
  const Clock::time_point start = Clock::now();
  Result<BlockStreamer> opened = open(options);
  if (!opened.ok()) return failed(opened.failure());
  BlockStreamer& streamer = *opened;
  const Box box = box_of_start(streamer, [&] {
    std::printf("first triangles after %.3f s, %.1f kB\n", seconds_since(start),
                double(streamer.statistics().source.bytes_transferred) / 1e3);
  });
  BlockViewParameters parameters;
  parameters.max_bytes = std::size_t(options.budget_mb * 1e6);
  parameters.by_vertex = options.in_blocks;
  std::vector<Frame> frames;
  Checked checked;
  Clock::time_point begin = Clock::now();
  for (int f = 0; f < options.frames; ++f) {
    parameters.view.camera = camera_at(box, options.is_city, double(f) / options.frames);
    parameters.view.camera.pixels = options.pixels;
    frames.push_back(fly_one(streamer, parameters));
    frames.back().at = seconds_since(begin);
    if (check && (f + 1) % options.check_every == 0) {
      const Clock::time_point stopped = Clock::now();
      checked.add(f, check->look(streamer.mesh()));
      begin += Clock::now() - stopped;
    }
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>((f + 1) / options.frames_per_second)));
  }
  if (streamer.trouble()) std::printf("trouble: %s\n", streamer.trouble()->message.c_str());
  report(options, streamer, frames);
  if (!options.csv.empty()) write_csv(options.csv, frames);
  if (!check) return 0;
  std::printf("  checked %zu frames, %zu triangles: %zu wrong\n", checked.frames, checked.triangles,
              checked.wrong);
  return checked.wrong > 0 ? 6 : 0;
}

Result<ByteSourcePtr> open_blocking(const std::string& file) {
  return is_http_url(file) ? open_http_source(file) : open_file_source(file);
}

// What a file shows once its first 64 KiB are there, which are one request.
Status report_first_bytes(const Options& options, const Camera& camera) {
  const Result<ByteSourcePtr> source = open_blocking(options.file);
  if (!source.ok()) return source.failure();
  std::vector<std::byte> bytes(std::min<std::uint64_t>((*source)->size(), 64 * 1024));
  if (Status status = (*source)->read(0, bytes); !status.ok()) return status;
  const Result<BlockFile> file = BlockFile::open(memory_source(std::span<const std::byte>(bytes)));
  if (!file.ok()) return file.failure();
  const Result<std::uint32_t> complete = file->complete_blocks();
  Result<BlockMesh> mesh = BlockMesh::open(*file);
  const Result<DirectoryPage> page = file->read_page(0);
  if (!complete.ok() || !mesh.ok() || !page.ok()) return Done{};  // not even the base
  if (Status status = mesh->add_page(*page); !status.ok()) return status;
  const std::size_t count = std::min<std::size_t>(*complete, page->blocks.size());
  for (const BlockEntry& entry : std::span(page->blocks).first(count)) {
    const Result<std::vector<std::byte>> payload = file->read_block(entry);
    if (!payload.ok()) return payload.failure();
    const Result<ResidentBlockPtr> block = mesh->decode_job(entry.id)->run(*payload);
    if (!block.ok()) return block.failure();
    mesh->insert(*block);
  }
  mesh->update({.view = {.camera = camera}, .in_levels = false});
  std::printf("  the first %zu bytes show %zu triangles within %.1f px\n", bytes.size(),
              mesh->triangle_count(), std::max(1.0, double(mesh->view_error()) * camera.pixels));
  return Done{};
}

// All of the model at full HD.
Camera camera_of_all(const Box& box) {
  Camera camera;
  camera.target = box.at(0.5, 0.5, 0.5);
  camera.position = camera.target + normalized(Vec3d{0.6, -1, 0.7}) * (1.3 * box.diagonal());
  camera.width_px = 1920;
  camera.height_px = 1080;
  return camera;
}

// A camera that sees the whole model and does not move.
int stand_still(const Options& options) {
  const Clock::time_point start = Clock::now();
  Result<BlockStreamer> opened = open(options);
  if (!opened.ok()) return failed(opened.failure());
  BlockStreamer& streamer = *opened;
  const std::uint64_t file_bytes = streamer.head().file_bytes;
  const auto report = [&](const char* what) {
    const double bytes = double(streamer.statistics().source.bytes_transferred);
    std::printf("  %-15s %7.3f s  %9.1f kB  %5.1f %% of the file  %zu triangles, %.2f px\n", what,
                seconds_since(start), bytes / 1e3, 100 * bytes / double(file_bytes),
                streamer.mesh().triangle_count(),
                double(streamer.mesh().view_error()) * options.pixels);
  };
  std::printf("%s\n", options.file.c_str());
  const Box box = box_of_start(streamer, [&] { report("first triangles"); });
  BlockViewParameters parameters;
  parameters.max_bytes = std::size_t(options.budget_mb * 1e6);
  Camera& camera = parameters.view.camera = camera_of_all(box);
  for (const double pixels : {16.0, 4.0, 1.0}) {
    camera.pixels = pixels * options.pixels;
    while (!streamer.update(parameters).is_complete) streamer.wait(std::chrono::milliseconds(16));
    report(pixels > 10 ? "within 16 px" : pixels > 2 ? "within 4 px" : "within 1 px");
  }
  camera.pixels = options.pixels;
  if (Status status = report_first_bytes(options, camera); !status.ok()) {
    return failed(status.failure());
  }
  return 0;
}

struct Granularity {
  const char* name;
  // Per frame; ratios: to by vertex; drawn: in groups that are in view.
  std::vector<double> update_ms, triangles, ratios, drawn, drawn_ratios;
};

void print(const Granularity& g) {
  std::printf("  %-28s update %8.4f ms median, %8.4f 99 %%; %8.0f triangles median", g.name,
              of_all(g.update_ms, 0.5), of_all(g.update_ms, 0.99), of_all(g.triangles, 0.5));
  if (!g.ratios.empty()) {
    std::printf(", %.2f times median, %.2f most", of_all(g.ratios, 0.5), of_all(g.ratios, 1));
    std::printf("; in view %.0f, %.2f times median, %.2f most", of_all(g.drawn, 0.5),
                of_all(g.drawn_ratios, 0.5), of_all(g.drawn_ratios, 1));
  }
  std::printf("\n");
}

// Levels and blocks by vertex are worked out in the background and come over a few with each
// update.
void wait_for(BlockStreamer& streamer, const BlockViewParameters& parameters) {
  while (!streamer.update(parameters).is_complete || !streamer.mesh().missing_levels().empty()) {
    streamer.wait(std::chrono::milliseconds(100));
  }
}

template <typename Update>
void time_one(Granularity& g, Update update) {
  const double start = thread_seconds();
  const std::size_t triangles = update();
  g.update_ms.push_back((thread_seconds() - start) * 1e3);
  g.triangles.push_back(double(triangles));
}

std::size_t drawn_triangles(const BlockMesh& mesh, const Camera& camera) {
  std::size_t count = 0;
  for (const ShownRange& r : shown_in_view(mesh.shown(), mesh.facts().grid.origin, camera)) {
    count += r.triangle_count();
  }
  for (const ShownCut& cut : mesh.shown_cuts()) {
    for (const ShownRange& r : shown_in_view(cut, camera)) count += r.triangle_count();
  }
  return count;
}

// Everything in memory: triangles and time at the same error, along the same path.
int compare_granularities(const Options& options) {
  Result<BlockStreamer> opened = open(options);
  const Result<BlockFile> file = open_crease(options.file);
  if (!opened.ok()) return failed(opened.failure());
  if (!file.ok()) return failed(file.failure());
  BlockStreamer& streamer = *opened;
  const Result<DecodedModel> model = decode_model(*file);
  if (!model.ok()) return failed(model.failure());
  const Box box = box_of(model->mesh.positions);  // not of a base that may be two triangles
  Result<MeshHierarchy> hierarchy = build_hierarchy(model->mesh, model->sequence, {});
  if (!hierarchy.ok()) return failed(hierarchy.failure());
  AdaptiveMesh whole(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
  Granularity by_vertex{"by vertex, whole model", {}, {}, {}, {}, {}},
      by_block{"by block", {}, {}, {}, {}, {}},
      within_blocks{"by vertex in blocks", {}, {}, {}, {}, {}};
  BlockViewParameters parameters;
  parameters.max_bytes = std::size_t(8) << 30;
  const auto look = [&](int f) {
    parameters.view.camera = camera_at(box, options.is_city, double(f) / options.frames);
    parameters.view.camera.pixels = options.pixels;
  };
  const auto update_blocks = [&] {
    streamer.update(parameters);
    return streamer.mesh().triangle_count();
  };
  for (const bool in_blocks : {false, true}) {
    parameters.by_vertex = in_blocks;
    Granularity& g = in_blocks ? within_blocks : by_block;
    for (int f = 0; f < options.frames; ++f) {
      look(f);
      wait_for(streamer, parameters);
    }
    std::size_t went_on = 0;  // frames with more new blocks than one update makes cuts of
    for (int f = 0; f < options.frames; ++f) {
      look(f);
      time_one(g, update_blocks);
      went_on += !streamer.mesh().has_arrived();
      wait_for(streamer, parameters);
      g.triangles.back() = double(streamer.mesh().triangle_count());
      g.drawn.push_back(double(drawn_triangles(streamer.mesh(), parameters.view.camera)));
    }
    std::printf("%s: %zu blocks resident, %.1f MB; %zu frames went on\n", g.name,
                streamer.mesh().resident_count(), double(streamer.mesh().resident_bytes()) / 1e6,
                went_on);
  }
  for (int f = 0; f < options.frames; ++f) {
    look(f);
    time_one(by_vertex, [&] {
      whole.update(parameters.view);
      return whole.triangle_count();
    });
  }
  for (Granularity* g : {&by_block, &within_blocks}) {
    for (std::size_t f = 0; f < g->triangles.size(); ++f) {
      if (by_vertex.triangles[f] > 0) {
        g->ratios.push_back(g->triangles[f] / by_vertex.triangles[f]);
        g->drawn_ratios.push_back(g->drawn[f] / by_vertex.triangles[f]);
      }
    }
  }
  std::printf("%s at %.3g px, %zu blocks resident\n", options.file.c_str(), options.pixels,
              streamer.mesh().resident_count());
  for (const Granularity* g : {&by_block, &within_blocks, &by_vertex}) print(*g);
  return 0;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("A flight through a file that streams");
  app.add_option("FILE", options.file, "a .crease, or its URL")->required();
  app.add_option("--budget", options.budget_mb, "of resident blocks, MB");
  app.add_option("--pixels", options.pixels, "error allowed on the screen");
  app.add_option("--frames", options.frames, "of the flight")->check(CLI::PositiveNumber);
  app.add_option("--fps", options.frames_per_second, "by the clock");
  app.add_option("--threads", options.threads, "that decode");
  app.add_flag("--city", options.is_city, "fly over it, low, instead of around");
  app.add_flag("--vertex", options.by_vertex, "beside the mesh by vertex, with all in memory");
  app.add_flag("--in-blocks", options.in_blocks, "the flight by vertex inside blocks");
  app.add_flag("--still", options.is_still, "until a camera that sees all of it is satisfied");
  app.add_option("--check", options.check_every, "every so many frames against brute force");
  app.add_option("--sound", options.sound, "with --check and a URL: the file that is there");
  app.add_option("--csv", options.csv, "a line for each frame");
  CLI11_PARSE(app, argc, argv);
  if (options.is_still) return stand_still(options);
  return options.by_vertex ? compare_granularities(options) : fly(options);
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
