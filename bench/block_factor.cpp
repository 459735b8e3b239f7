// Why by block needs more triangles than by vertex: along the same flight, what would be shown if
// one thing after the other were ideal. Everything is in memory.
//
//   bench_block_factor city.crease --city --frames 60
//
// Triangles are those of the base and what is brought by all that is refined; so counts of sets of
// blocks, of clusters or of single vertices can be compared, whether or not they are a cut.
#include "crease/block_streamer.h"
#include "crease/decode_model.h"
#include "crease/file.h"
#include "flight.h"
#include "runtime/block_mesh_impl.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace crease::bench {
namespace {

// The rows of the table.
enum Row : std::size_t {
  kByBlock,     // what is shown
  kInView,      // of that, what no plane of the view has outside
  kWrongOnly,   // blocks that are wrong by the directory, without what they need
  kWrongRoots,  // blocks that have a wrong root
  kClusters2000,
  kClusters500,
  kClusters125,
  kClusters32,  // of wrong roots, so many triangles each
  kRoots,       // all below each wrong root
  kVertices,    // wrong vertices
  kRowCount
};
constexpr const char* kNames[] = {"by block",
                                  "  of which in view",
                                  "blocks that are wrong, not those they need",
                                  "  that have a wrong vertex",
                                  "clusters of 2,000 triangles that have one",
                                  "clusters of 500",
                                  "clusters of 125",
                                  "clusters of 32",
                                  "all below a wrong vertex of a coarse end",
                                  "wrong vertices"};

// A split of a root, with all below it.
struct RootFacts {
  SplitId split{};
  Vec3f position;
  std::size_t triangles = 0;
};

class BlockRoots {
 public:
  BlockRoots(const BlockCut& cut, const ViewError& error) {
    const VertexHierarchy& h = cut.data().hierarchy.vertices;
    position_.resize(h.split_count());
    triangles_.resize(h.split_count());
    for (std::size_t i = h.split_count(); i-- > 0;) {
      const SplitId s{std::uint32_t(i)};
      triangles_[i] += h.triangles_of(s).size();
      position_[i] = error.position(h.position_of(h.node_of_split[i]));
      const NodeId node = h.node_of_split[i];
      if (h.is_root(node)) {
        roots.push_back({s, position_[i], triangles_[i]});
      } else {
        triangles_[index_of(h.split_above(node))] += triangles_[i];
      }
    }
    // Near ones beside each other.
    std::sort(roots.begin(), roots.end(), [this](const RootFacts& a, const RootFacts& b) {
      return code(a.position) < code(b.position);
    });
  }
  const Vec3f& position(std::size_t split) const { return position_[split]; }

  std::vector<RootFacts> roots;

 private:
  static std::uint64_t code(const Vec3f& p) {
    std::uint64_t all = 0;
    const std::array<std::uint32_t, 3> at{std::uint32_t(std::max(0.0f, p.x * 16)),
                                          std::uint32_t(std::max(0.0f, p.y * 16)),
                                          std::uint32_t(std::max(0.0f, p.z * 16))};
    for (unsigned bit = 20; bit-- > 0;) {
      for (const std::uint32_t x : at) all = all << 1 | (x >> bit & 1);
    }
    return all;
  }
  std::vector<Vec3f> position_;
  std::vector<std::size_t> triangles_;
};

class Counter {
 public:
  Counter(const BlockMesh& mesh, const ViewParameters& view)
      : mesh_(mesh), error_(view, mesh.facts().grid) {}

  std::array<double, kRowCount> count(std::map<std::uint32_t, BlockRoots>& known) {
    const BlockMesh::Impl& impl = mesh_.impl();
    std::map<std::uint32_t, bool> is_wrong;
    for (const SeenBlock& c : impl.chooser.wrong()) is_wrong[c.block] = true;
    for (const std::uint32_t block : impl.cut) {
      const auto& facts = impl.graph.entry(block).facts;
      const double more = double(facts.triangles_fine) - double(facts.triangles_coarse);
      rows_[kByBlock] += more;
      count_in_view(block);
      if (is_wrong[block]) rows_[kWrongOnly] += more;
      const BlockCut* const cut = impl.cuts.cut(block);
      if (impl.graph.is_base(block) || cut == nullptr) {
        for (const Row r : {kWrongRoots, kClusters2000, kClusters500, kClusters125, kClusters32,
                            kRoots, kVertices}) {
          rows_[r] += more;
        }
        continue;
      }
      count_below(*cut, known.try_emplace(block, *cut, error_).first->second, more);
    }
    return rows_;
  }

 private:
  bool is_wrong(const BlockCut& cut, SplitId s, const Vec3f& position) const {
    return error_.is_wrong(error_.watch(cut.bounds()[index_of(s)], position, 1));
  }

  void count_below(const BlockCut& cut, const BlockRoots& facts, double more) {
    bool any = false;
    for (const RootFacts& root : facts.roots) {
      if (!is_wrong(cut, root.split, root.position)) continue;
      any = true;
      rows_[kRoots] += double(root.triangles);
    }
    if (any) rows_[kWrongRoots] += more;
    const std::pair<Row, std::size_t> sizes[] = {
        {kClusters2000, 2000}, {kClusters500, 500}, {kClusters125, 125}, {kClusters32, 32}};
    for (const auto& [row, size] : sizes) count_clusters(cut, facts, row, size);
    const VertexHierarchy& h = cut.data().hierarchy.vertices;
    for (std::size_t i = 0; i < h.split_count(); ++i) {
      const SplitId s{std::uint32_t(i)};
      if (is_wrong(cut, s, facts.position(i))) rows_[kVertices] += double(h.triangles_of(s).size());
    }
  }

  // A cluster of `size` triangles at the fine end brings what is a third of them or so.
  void count_clusters(const BlockCut& cut, const BlockRoots& facts, Row row, std::size_t size) {
    const double all = double(cut.data().roots_of_triangle.size());
    const double coarse = double(cut.data().coarse_triangles);
    const double brought = double(size) * (all - coarse) / all;
    double sum = 0;
    bool any = false;
    for (const RootFacts& root : facts.roots) {
      sum += double(root.triangles);
      any |= is_wrong(cut, root.split, root.position);
      if (sum < brought) continue;
      if (any) rows_[row] += sum;
      sum = 0;
      any = false;
    }
    if (any) rows_[row] += sum;
  }

  void count_in_view(std::uint32_t block) {
    const ResidentBlock& resident = *mesh_.impl().resident[block];
    const DrawList list = resident.draw_list();
    for (const BlockGroup& group : resident.groups()) {
      if (!mesh_.impl().is_shown(block, group.patch)) continue;
      count_part(list, list.sn, group.sn);
      count_part(list, list.fn, group.fn);
      count_part(list, list.nsn, group.nsn);
    }
  }
  void count_part(const DrawList& list, const DrawPart& part, Range range) {
    for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
      const Vec3f* p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = &list.positions[part.indices[3 * t + k]];
      const Vec3f c = (*p[0] + *p[1] + *p[2]) * (1.0f / 3);
      float radius = 0;
      for (const Vec3f* corner : p) radius = std::max(radius, length(*corner - c));
      rows_[kInView] += error_.inside(c.x, c.y, c.z) + radius >= 0;
    }
  }

  const BlockMesh& mesh_;
  const ViewError error_;
  std::array<double, kRowCount> rows_{};
};

double median(std::vector<double> all) {
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

void wait_for(BlockStreamer& streamer, const BlockViewParameters& parameters) {
  while (!streamer.update(parameters).is_complete) streamer.wait(std::chrono::milliseconds(100));
}

int run(int argc, char** argv) {
  std::string file;
  int frames = 60;
  bool is_city = false;
  CLI::App app("Why by block needs more triangles than by vertex");
  app.add_option("FILE", file, "a .crease")->required();
  app.add_option("--frames", frames)->check(CLI::PositiveNumber);
  app.add_flag("--city", is_city, "fly over it, low, instead of around");
  CLI11_PARSE(app, argc, argv);
  const Result<AsyncSourcePtr> source = open_async_file(file);
  if (!source.ok()) return 2;
  Result<BlockStreamer> opened = BlockStreamer::open(*source, {.decode_threads = 2});
  if (!opened.ok()) return 2;
  BlockStreamer& streamer = *opened;
  BlockViewParameters parameters;
  parameters.max_bytes = std::size_t(8) << 30;
  parameters.by_vertex = true;
  parameters.view.max_triangles = 0;
  while (streamer.mesh().shown().empty() && streamer.mesh().shown_cuts().empty()) {
    streamer.update(parameters);
    streamer.wait(std::chrono::milliseconds(100));
  }
  parameters.view.max_triangles = ViewParameters{}.max_triangles;
  const Result<BlockFile> blocks = open_crease(file);
  if (!blocks.ok()) return 2;
  const Result<DecodedModel> model = decode_model(*blocks, {.contracted_bands = 0});
  if (!model.ok()) return 2;
  const Box box = box_of(model->mesh.positions);  // of the model: files of it are flown over alike
  std::map<std::uint32_t, BlockRoots> known;
  std::vector<std::vector<double>> rows(kRowCount), times(kRowCount);
  std::vector<double> shown;
  for (const bool counts : {false, true}) {
    for (int f = 0; f < frames; ++f) {
      parameters.view.camera = camera_at(box, is_city, double(f) / frames);
      wait_for(streamer, parameters);
      if (!counts) continue;
      const auto row = Counter(streamer.mesh(), parameters.view).count(known);
      shown.push_back(double(streamer.mesh().triangle_count()));
      for (std::size_t r = 0; r < kRowCount; ++r) {
        rows[r].push_back(row[r]);
        times[r].push_back(row[r] / shown.back());
      }
    }
  }
  std::printf("%s, %d frames, medians; by vertex in blocks %.0f triangles\n", file.c_str(), frames,
              median(shown));
  for (std::size_t r = 0; r < kRowCount; ++r) {
    std::printf("  %-46s %10.0f  %6.2f times\n", kNames[r], median(rows[r]), median(times[r]));
  }
  return 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
