// What a frame by block costs with everything in memory, along the path of bench_stream --vertex.
//
//   bench_block_update city.crease --city --frames 20                  large steps
//   bench_block_update city.crease --city --frames 100 --path 1800     of a minute at 30 a second
//
// Lists of levels go after 128 updates, so that more frames than that wait for them in each round.
//
// Between frames other memory is read, as a program that draws does, so that none of what update()
// looks at is near. Each round flies the path again, and of each frame the quickest counts, since
// others load the machine. `shown` is a checksum of all ranges and levels that are drawn: programs
// of which it is the same show the same.
#include "crease/block_mesh.h"
#include "crease/file.h"
#include "flight.h"
#include "samples.h"

#include <CLI/CLI.hpp>

#include <ctime>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace crease::bench {
namespace {

struct Options {
  std::string file;
  double pixels = 1;
  int frames = 20, path = 0, rounds = 10, threads = 2;
  bool is_city = false;
};

double thread_milliseconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

class Checksum {
 public:
  void add(std::uint64_t value) { sum_ = (sum_ ^ value) * 0x100000001b3u; }
  void add(const Range& range) {
    add(range.first);
    add(range.count);
  }
  // In the order in which they are drawn.
  void add(const BlockMesh& mesh) {
    for (const ShownRange& shown : mesh.shown()) {
      add(index_of(shown.block->id()));
      for (const Range& range : {shown.sn, shown.fn, shown.nsn}) add(range);
    }
    for (const ShownCut& cut : mesh.shown_cuts()) {
      add(index_of(cut.block->id()));
      add(cut.triangle_count());
    }
    for (const BlockId missing : mesh.missing_levels()) add(index_of(missing));
  }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

// A mesh with all blocks of the file and nothing in the background.
class Flown {
 public:
  Flown(const BlockFile& file, const Options& options) : options_(options) {
    mesh_.emplace(*BlockMesh::open(file));
    while (const auto page = mesh_->next_page()) {
      const DirectoryPage read = *file.read_page(*page);
      if (!mesh_->add_page(read).ok()) std::abort();
      for (const BlockEntry& entry : read.blocks) {
        mesh_->insert(*mesh_->decode_job(entry.id)->run(*file.read_block(entry)));
      }
    }
    parameters_.max_bytes = std::size_t(8) << 30;
    box_ = box_of_model();
  }

  const BlockMesh& mesh() const { return *mesh_; }
  void look(int frame) {
    const int path = options_.path > 0 ? options_.path : options_.frames;
    parameters_.view.camera = camera_at(box_, options_.is_city, double(frame) / path);
    parameters_.view.camera.pixels = options_.pixels;
  }
  void update() { mesh_->update(parameters_); }
  // All levels that the present view misses. How many.
  std::size_t make_levels() {
    std::size_t count = 0;
    for (update(); !mesh_->missing_levels().empty(); update()) {
      std::vector<BlockLevelsJob> jobs;
      for (const BlockId id : mesh_->missing_levels()) jobs.push_back(*mesh_->levels_job(id));
      count += jobs.size();
      std::vector<BlockLevelsPtr> made(jobs.size());
      std::atomic<std::size_t> next = 0;
      std::vector<std::jthread> threads;
      for (int t = 0; t < options_.threads; ++t) {
        threads.emplace_back([&] {
          for (std::size_t i = next++; i < jobs.size(); i = next++) made[i] = jobs[i].run();
        });
      }
      threads.clear();
      for (BlockLevelsPtr& levels : made) mesh_->insert(std::move(levels));
    }
    return count;
  }

 private:
  // A base may be two triangles and tells nothing.
  Box box_of_model() {
    BlockViewParameters everything = parameters_;
    everything.in_levels = false;
    everything.view.coarse_outside = false;
    everything.view.camera.pixels = 1e-9;
    mesh_->update(everything);
    std::vector<Vec3d> positions;
    for (const ShownRange& range : mesh_->shown()) {
      const DrawList list = range.block->draw_list();
      for (const Vec3f& p : list.positions) {
        positions.push_back(list.origin + Vec3d{p.x, p.y, p.z});
      }
    }
    return box_of(positions);
  }

  const Options& options_;
  std::optional<BlockMesh> mesh_;
  BlockViewParameters parameters_;
  Box box_{};
};

// What a program does between two frames.
class Elsewhere {
 public:
  void read() {
    for (std::size_t i = 0; i < memory_.size(); i += 16) sum_ += memory_[i]++;
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::vector<std::uint32_t> memory_ = std::vector<std::uint32_t>(std::size_t(4) << 20);
  std::uint64_t sum_ = 0;
};

int fly(const Options& options) {
  const Result<BlockFile> file = open_crease(options.file);
  if (!file.ok()) return std::fprintf(stderr, "%s\n", file.failure().message.c_str()), 2;
  Flown flown(*file, options);
  // Frames that follow each other may want other lists than each by itself.
  for (bool is_new = true; is_new;) {
    is_new = false;
    for (int f = 0; f < options.frames; ++f) {
      flown.look(f);
      is_new |= flown.make_levels() > 0;
    }
  }
  const std::size_t frames = std::size_t(options.frames);
  std::vector<double> least(frames, std::numeric_limits<double>::infinity());
  Samples all, quickest, triangles;
  Checksum shown;
  Elsewhere elsewhere;
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t f = 0; f < frames; ++f) {
      flown.look(int(f));
      elsewhere.read();
      const double start = thread_milliseconds();
      flown.update();
      const double took = thread_milliseconds() - start;
      least[f] = std::min(least[f], took);
      all.add(took);
      triangles.add(double(flown.mesh().triangle_count()));
      shown.add(flown.mesh());
    }
  }
  for (const double l : least) quickest.add(l);
  const BlockMesh& mesh = flown.mesh();
  std::printf(
      "%s: %d frames, %d rounds, %zu blocks resident, %.1f MB\n"
      "  update: %.4f ms median, %.4f least of a frame's rounds, median, %.4f most\n"
      "  shown: %.0f triangles median, checksum %016llx\n",
      options.file.c_str(), options.frames, options.rounds, mesh.resident_count(),
      double(mesh.resident_bytes()) / 1e6, all.of(0.5), quickest.of(0.5), quickest.of(1),
      triangles.of(0.5), static_cast<unsigned long long>(shown.value()));
  return 0;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("What update() by block costs with everything in memory");
  app.add_option("FILE", options.file, "a .crease")->required();
  app.add_option("--pixels", options.pixels, "error allowed on the screen");
  app.add_option("--frames", options.frames, "that are flown")->check(CLI::PositiveNumber);
  app.add_option("--path", options.path, "frames of the whole path; else just those");
  app.add_option("--rounds", options.rounds, "that are timed")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "that make levels, before")
      ->check(CLI::PositiveNumber);
  app.add_flag("--city", options.is_city, "fly over it, low, instead of around");
  CLI11_PARSE(app, argc, argv);
  return fly(options);
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
