#include "pipeline/sized_file.h"

#include "codec/byte_sink.h"
#include "crease/generate.h"
#include "crease/simplify.h"
#include "pipeline/encode_model.h"
#include "pipeline/join_equal_values.h"
#include "pipeline/snap_attributes.h"
#include "support/mesh_zoo.h"
#include "support/normals_alone.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

namespace crease {

namespace {

constexpr int kPositionBits = 14, kNormalBits = 10;
constexpr const char* kHead = "model,source,import,triangles,placement,normal_bits,bytes";

struct OwnModel {
  const char* name;
  Mesh (*make)();
};
constexpr OwnModel kOwnModels[] = {
    {"smooth_sphere", [] { return smooth_sphere(60, 90); }},
    {"faceted_sphere", [] { return faceted_sphere(40, 60); }},
    {"torus", [] { return torus(60, 90); }},
    {"height_field", [] { return height_field(70); }},
    {"hard_box", [] { return hard_box(24); }},
    {"hard_cylinder", [] { return hard_cylinder(120, 30); }},
    {"noisy_box", [] { return noisy_box(20, 0.5); }},
    {"gear", [] { return gear(200); }},
    {"crossing_walls", [] { return crossing_walls(8, 6); }},
    {"city", [] { return generate_city({.triangles = 20'000}); }},
};

}  // namespace

SizedModel simplify_sized(Mesh mesh, Placement placement, bool with_normals) {
  const Grid grid = make_grid(mesh, {.length = 0, .bits = kPositionBits});
  snap(mesh, grid);
  SizedModel model{std::move(mesh), {}, {}};
  model.codings = codings_of(model.mesh, {.normal_bits = kNormalBits});
  snap_to_codings(model.mesh, model.codings);
  SimplifyOptions options;
  options.placement = placement;
  options.record_bands = true;
  model.sequence = *simplify(model.mesh, grid, options);  // nobody interrupts it
  if (with_normals) return model;
  model.mesh.layers.clear();
  model.codings.clear();
  model.sequence.new_values.clear();
  model.sequence.changes.clear();
  model.sequence.derived.clear();
  for (Contraction& c : model.sequence.contractions) c.change_count = c.derived_count = 0;
  return model;
}

std::vector<std::byte> encode_sized(SizedModel model) {
  snap_new_values(model.sequence, model.mesh, model.codings);
  join_equal_values(model.sequence, model.mesh, model.codings);
  MemorySink sink;
  if (!encode_model(model.mesh, model.sequence, model.codings, sink).ok()) return {};
  return sink.take();
}

std::vector<std::string> own_models() {
  std::vector<std::string> names;
  for (const OwnModel& model : kOwnModels) names.push_back(model.name);
  return names;
}

Mesh own_model(const std::string& name) {
  for (const OwnModel& model : kOwnModels) {
    if (name == model.name) return normals_alone(model.make());
  }
  return {};
}

std::vector<SizeRow> read_sizes(const std::filesystem::path& path) {
  std::vector<SizeRow> rows;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    SizeRow row;
    std::string placement;
    int normal_bits = 0;
    if (!(words >> row.model >> row.source >> row.import >> row.triangles >> placement >>
          normal_bits >> row.bytes)) {
      continue;
    }
    row.placement = placement == "endpoint" ? Placement::Endpoint : Placement::Optimal;
    row.with_normals = normal_bits > 0;
    rows.push_back(row);
  }
  return rows;
}

bool write_sizes(const std::filesystem::path& path, const std::vector<SizeRow>& rows) {
  std::ofstream file(path);
  file << kHead << '\n';
  for (const SizeRow& row : rows) {
    file << row.model << ',' << row.source << ',' << row.import << ',' << row.triangles << ','
         << (row.placement == Placement::Endpoint ? "endpoint" : "optimal") << ','
         << (row.with_normals ? kNormalBits : 0) << ',' << row.bytes << '\n';
  }
  return file.good();
}

}  // namespace crease
