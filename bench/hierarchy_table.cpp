// A line per model: what its hierarchy takes that was built with the defaults and loaded whole, and
// how many attributes pile up at its nodes.
//
//   bench_hierarchy MODEL...      (prints CSV; see docs/hierarchy.md)
//
// seconds: of all threads. bytes: per input vertex, whole, and by what they are. attributes a node:
// mean and maximum over all nodes of the layer that has most. mapped: share of splits with a parent
// map. runs: branch codes per split. crossing: share of mapped splits without a non-crossing order
// (G03 3.5.1).
#include "crease/build_hierarchy.h"
#include "crease/import.h"
#include "hierarchy/corner_subgraph.h"
#include "opened.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <utility>

namespace crease::bench {
namespace {

// Of this process, so that neighbours do not count; building and checking run on one thread.
double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

struct Attributes {
  double mean = 0, mapped = 0, runs = 0;
  std::uint32_t most = 0;
  std::size_t crossing = 0, several = 0;
};

Attributes count_attributes(const MeshHierarchy& hierarchy) {
  Attributes result;
  const VertexHierarchy& h = hierarchy.vertices;
  for (std::size_t l = 0; l < hierarchy.layers.size(); ++l) {
    const AttributeHierarchy& layer = hierarchy.layers[l];
    for (std::uint32_t n = 0; n < h.node_count(); ++n) {
      result.most = std::max(result.most, layer.attribute_count(NodeId{n}));
    }
    const double mean = double(layer.attribute_ranges.total()) / double(h.node_count());
    if (mean < result.mean) continue;
    result.mean = mean;
    const double splits = double(std::max<std::size_t>(1, h.split_count()));
    result.mapped = double(layer.parents_of_split.list_count()) / splits;
    result.runs = double(layer.branches_of_split.item_count()) / splits;
    result.crossing = result.several = 0;
    for (std::uint32_t s = 0; s < h.split_count(); ++s) {
      if (layer.parents_of_split.of(s).empty()) continue;
      ++result.several;
      if (has_crossing(corner_subgraph(hierarchy, l, SplitId{s}))) ++result.crossing;
    }
  }
  return result;
}

int measure(const char* path) {
  Result<Imported> in = import_mesh(path, {});
  if (!in.ok()) {
    std::fprintf(stderr, "%s\n", in.failure().message.c_str());
    return 1;
  }
  const double begin = cpu_seconds();
  const Result<Opened> opened = open_built(std::move(in->mesh));
  if (!opened.ok()) {
    std::fprintf(stderr, "%s: %s\n", path, opened.failure().message.c_str());
    return 1;
  }
  const Mesh& mesh = opened->model.mesh;
  const double opened_at = cpu_seconds();
  const Result<MeshHierarchy> hierarchy = build_hierarchy(mesh, opened->model.sequence, {});
  const double built = cpu_seconds();
  if (!hierarchy.ok()) {
    std::fprintf(stderr, "%s: %s\n", path, hierarchy.failure().message.c_str());
    return 1;
  }
  const Status status = check_hierarchy(*hierarchy);
  const double checked = cpu_seconds();
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", path, status.failure().message.c_str());

  const HierarchyBytes bytes = hierarchy_bytes(*hierarchy);
  const double vertices = double(mesh.vertex_count());
  const Attributes attributes = count_attributes(*hierarchy);
  const VertexHierarchy& h = hierarchy->vertices;
  std::printf("%s,%zu,%zu,%zu,%u,%.2f,%.2f,%.2f,", path, mesh.triangle_count(), mesh.vertex_count(),
              mesh.layers.size(), h.root_count, opened_at - begin, built - opened_at,
              checked - built);
  std::printf("%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,", double(bytes.total()) / vertices,
              double(bytes.triangles) / vertices, double(bytes.positions) / vertices,
              double(bytes.splits) / vertices, double(bytes.values) / vertices,
              double(bytes.attributes) / vertices);
  std::printf("%.3f,%u,%.3f,%.3f,%.4f\n", attributes.mean, attributes.most, attributes.mapped,
              attributes.runs,
              double(attributes.crossing) / double(std::max<std::size_t>(1, attributes.several)));
  std::fflush(stdout);
  return status.ok() ? 0 : 1;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  std::puts(
      "model,triangles,vertices,layers,roots,file_cpu_s,build_cpu_s,check_cpu_s,bytes,triangle_"
      "bytes,"
      "position_bytes,split_bytes,value_bytes,attribute_bytes,attributes_mean,attributes_max,"
      "mapped,runs,crossing");
  int failed = 0;
  for (int i = 1; i < argc; ++i) failed |= crease::bench::measure(argv[i]);
  return failed;
}
