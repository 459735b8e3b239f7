// How much smaller a file is than what a program keeps of it: the same model as model.crease with
// the defaults, as a MeshHierarchy in memory, and as a tree of meta-nodes.
//
//   bench_resident [--models bunny,berlin] [--csv resident.csv]
//
// Meta-nodes as in view-dependence trees before compression (El-Sana and Chiang 2000, which CAME
// compares itself with), as we count them: 32 bits a number, nothing shared, nothing packed; see
// kNode and the others.
#include "crease/build_hierarchy.h"
#include "models.h"
#include "opened.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>

namespace crease::bench {
namespace {

// Position, parent, two children, radius of the sphere, axis and angle of the normal cone, error,
// least and greatest vertex that a split depends on, first triangle of its list.
constexpr std::size_t kNode = 12 + 4 + 8 + 4 + 16 + 4 + 8 + 4;
// Three leaves, and the next triangle of the node's list.
constexpr std::size_t kTriangle = 12 + 4;
// Of an attribute at a node: a normal, and its parent in the attribute hierarchy.
constexpr std::size_t kAttribute = 12 + 4;
// Of a triangle, in a layer: the attributes of its three corners.
constexpr std::size_t kCorners = 12;

std::size_t meta_node_bytes(const MeshHierarchy& hierarchy, std::size_t triangles) {
  std::size_t bytes = kNode * hierarchy.vertices.node_count() + kTriangle * triangles;
  for (const AttributeHierarchy& layer : hierarchy.layers) {
    bytes += kAttribute * layer.attribute_ranges.total() + kCorners * triangles;
  }
  return bytes;
}

struct Line {
  std::size_t vertices = 0, triangles = 0, file = 0, hierarchy = 0, meta_nodes = 0;
};

Result<Line> measure(Mesh mesh) {
  Line line{.vertices = mesh.vertex_count(), .triangles = mesh.triangle_count()};
  const Result<Opened> opened = open_built(std::move(mesh));
  if (!opened.ok()) return opened.failure();
  line.file = opened->file_bytes;
  const DecodedModel& model = opened->model;
  const Result<MeshHierarchy> hierarchy = build_hierarchy(model.mesh, model.sequence, {});
  if (!hierarchy.ok()) return hierarchy.failure();
  line.hierarchy = hierarchy_bytes(*hierarchy).total();
  line.meta_nodes = meta_node_bytes(*hierarchy, line.triangles);
  return line;
}

int run(int argc, char** argv) {
  std::vector<std::string> names;
  std::size_t max_triangles = 400'000;
  std::filesystem::path csv_path;
  CLI::App app("Bytes of files beside bytes in memory");
  app.add_option("--models", names, "names of models.txt and models_more.txt")->delimiter(',');
  app.add_option("--max-triangles", max_triangles, "larger ones are left out; 0: none");
  app.add_option("--csv", csv_path, "write the table there as well");
  CLI11_PARSE(app, argc, argv);

  std::ofstream csv;
  if (!csv_path.empty()) csv.open(csv_path);
  csv << "model,class,vertices,triangles,file_bytes,hierarchy_bytes,meta_node_bytes\n";
  bool good = true;
  for (const ModelEntry& entry : all_models(names)) {
    Result<Mesh> mesh = load_mesh(entry, data_folder());
    if (!mesh.ok()) {
      std::fprintf(stderr, "%s\n", mesh.failure().message.c_str());
      continue;
    }
    if (max_triangles > 0 && mesh->triangle_count() > max_triangles) continue;
    const Result<Line> line = measure(*std::move(mesh));
    if (!line.ok()) {
      std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), line.failure().message.c_str());
      good = false;
      continue;
    }
    const double file = double(line->file), vertices = double(line->vertices);
    std::printf(
        "%-12s %8zu vertices  file %6.2f  hierarchy %6.1f  meta-nodes %6.1f bytes a vertex  "
        "%5.1f and %5.1f times the file\n",
        entry.name.c_str(), line->vertices, file / vertices, double(line->hierarchy) / vertices,
        double(line->meta_nodes) / vertices, double(line->hierarchy) / file,
        double(line->meta_nodes) / file);
    std::fflush(stdout);
    csv << entry.name << ',' << entry.kind << ',' << line->vertices << ',' << line->triangles << ','
        << line->file << ',' << line->hierarchy << ',' << line->meta_nodes << '\n';
  }
  return good ? 0 : 2;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
