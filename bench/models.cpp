#include "models.h"

#include "crease/generate.h"
#include "crease/import.h"
#include "mesh/normals.h"
#include "mesh/weld.h"
#include "support/normals_alone.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace crease::bench {

namespace {

constexpr const char* kGenerate = "generate:";

Result<Mesh> load_any(const ModelEntry& entry, const std::filesystem::path& data) {
  if (entry.where.starts_with(kGenerate)) {
    const std::string count = entry.where.substr(std::string(kGenerate).size());
    return generate_city({.triangles = std::strtoull(count.c_str(), nullptr, 10)});
  }
  Result<NormalPolicy> normals = parse_normal_policy(entry.normals);
  if (!normals.ok()) return normals.failure();
  Result<Imported> imported =
      import_mesh(data / entry.where, {.normals = *normals, .progress = {}});
  if (!imported.ok()) return imported.failure();
  return std::move(imported->mesh);
}

}  // namespace

std::filesystem::path data_folder() {
  if (const char* given = std::getenv("CREASE_SHARED_DATA")) return given;
  return std::filesystem::path(CREASE_BENCH_SOURCE) / "../../shared/data";
}

Result<std::vector<ModelEntry>> read_models(const std::filesystem::path& list) {
  std::ifstream file(list);
  if (!file) return fail(Error::NotFound, list.string() + ": cannot be read");
  std::vector<ModelEntry> entries;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    ModelEntry entry;
    if (!(words >> entry.name >> entry.kind >> entry.normals >> entry.where)) {
      return fail(Error::BadFormat, list.string() + ": four words a line: " + line);
    }
    entries.push_back(entry);
  }
  return entries;
}

std::vector<ModelEntry> all_models(const std::vector<std::string>& names) {
  std::vector<ModelEntry> chosen;
  for (const char* list : {"models.txt", "models_more.txt"}) {
    const Result<std::vector<ModelEntry>> entries =
        read_models(std::filesystem::path(CREASE_BENCH_SOURCE) / list);
    if (!entries.ok()) continue;
    for (const ModelEntry& entry : *entries) {
      if (names.empty() || std::ranges::find(names, entry.name) != names.end()) {
        chosen.push_back(entry);
      }
    }
  }
  return chosen;
}

Result<Mesh> load_mesh(const ModelEntry& entry, const std::filesystem::path& data) {
  Result<Mesh> loaded = load_any(entry, data);
  if (!loaded.ok()) return loaded.failure();
  return normals_alone(std::move(*loaded));
}

Result<Model> load_model(const ModelEntry& entry, const std::filesystem::path& data) {
  Result<Mesh> loaded = load_mesh(entry, data);
  if (!loaded.ok()) return loaded.failure();
  Model model{.mesh = std::move(*loaded), .grid = {}};
  model.grid = make_grid(model.mesh, {});
  snap(model.mesh, model.grid);
  return model;
}

exchange::Mesh to_exchange(const Mesh& mesh) {
  exchange::Mesh out;
  for (const Vec3d& p : mesh.positions) out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
  const AttributeLayer& normals = *mesh.normals();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      out.corners.push_back(static_cast<std::uint32_t>(index_of(mesh.triangles[t][c])));
      const std::span<const float> n = normals.value(normals.of_corner[3 * t + c]);
      out.normals.insert(out.normals.end(), n.begin(), n.end());
    }
  }
  return out;
}

Mesh from_exchange(const exchange::Mesh& in, const std::string& kind) {
  Mesh mesh;
  for (std::size_t v = 0; v < in.vertex_count(); ++v) {
    mesh.positions.push_back(
        {in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]});
  }
  AttributeLayer normals{.name = "normal",
                         .role = AttributeRole::Normal,
                         .interpolation = Interpolation::Direction,
                         .dimension = 3,
                         .values = {},
                         .of_corner = {}};
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const std::uint32_t* c = &in.corners[3 * t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    mesh.triangles.push_back({VertexId(c[0]), VertexId(c[1]), VertexId(c[2])});
    for (std::size_t i = 0; i < 3 && !in.normals.empty(); ++i) {
      normals.of_corner.push_back(AttributeId(normals.value_count()));
      const float* n = &in.normals[3 * (3 * t + i)];
      normals.values.insert(normals.values.end(), n, n + 3);
    }
  }
  if (in.normals.empty()) {
    const SoftEdges soft{.max_angle_deg = kind == "scan" ? 180.0 : 30.0,
                         .smoothing_group = {},
                         .face_of_triangle = {}};
    normals = generate_normals(mesh, soft);
  } else {
    const Weld weld = weld_values(normals.values, 3);
    for (AttributeId& id : normals.of_corner) id = AttributeId(weld.new_of_old[index_of(id)]);
    keep_rows(normals.values, weld.first_old, 3);
  }
  mesh.layers.push_back(std::move(normals));
  return mesh;
}

}  // namespace crease::bench
