// crease info: what is inside a file.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/report.h"
#include "cli/text.h"
#include "crease/progressive_mesh.h"
#include "crease/shading.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace crease::cli {

namespace {

struct InfoArguments {
  std::filesystem::path file;
  ReadOptions read;
};

const char* name_of(AttributeRole role) {
  switch (role) {
    case AttributeRole::Normal:
      return "normal";
    case AttributeRole::TexCoord:
      return "texcoord";
    case AttributeRole::Color:
      return "color";
    case AttributeRole::Other:
      return "other";
  }
  return "";
}

const char* name_of(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::Direction:
      return "direction";
    case Interpolation::Linear:
      return "linear";
    case Interpolation::Categorical:
      return "categorical";
  }
  return "";
}

Json attributes_json(const Mesh& mesh) {
  Json attributes = Json::array();
  for (const AttributeLayer& layer : mesh.layers) {
    attributes.push_back({{"name", layer.name},
                          {"role", name_of(layer.role)},
                          {"interpolation", name_of(layer.interpolation)},
                          {"dimension", layer.dimension},
                          {"values", layer.value_count()}});
  }
  return attributes;
}

Json bounds_json(const Mesh& mesh) {
  if (mesh.positions.empty()) return nullptr;
  Vec3d low = mesh.positions.front(), high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return {{"low", {low.x, low.y, low.z}}, {"high", {high.x, high.y, high.z}}};
}

// The fields that a mesh file has too.
Json mesh_json(const Mesh& mesh) {
  const ShadingKinds kinds = classify_shading(mesh);
  const auto vertices = [&](VertexKind kind) { return std::ranges::count(kinds.of_vertex, kind); };
  const auto triangles = [&](TriangleKind kind) {
    return std::ranges::count(kinds.of_triangle, kind);
  };
  Json materials = Json::array();
  for (const Material& material : mesh.materials) materials.push_back(material.name);
  return {{"triangles", mesh.triangle_count()},
          {"vertices", mesh.vertex_count()},
          {"sn_vertices", vertices(VertexKind::SN)},
          {"nsn_vertices", vertices(VertexKind::NSN)},
          {"sn_triangles", triangles(TriangleKind::SN)},
          {"fn_triangles", triangles(TriangleKind::FN)},
          {"nsn_triangles", triangles(TriangleKind::NSN)},
          {"attributes", attributes_json(mesh)},
          {"materials", materials},
          {"parts", mesh.parts.size()},
          {"bounds", bounds_json(mesh)}};
}

std::string count_of(const Json& json, const char* key) {
  return grouped(json[key].get<std::uint64_t>());
}

std::string mesh_text(const Json& json) {
  std::string text = count_of(json, "triangles") + " triangles: " + count_of(json, "sn_triangles") +
                     " SN, " + count_of(json, "fn_triangles") + " FN, " +
                     count_of(json, "nsn_triangles") + " NSN\n" + count_of(json, "vertices") +
                     " vertices: " + count_of(json, "sn_vertices") + " SN, " +
                     count_of(json, "nsn_vertices") + " NSN\n" + count_of(json, "parts") +
                     " parts, " + std::to_string(json["materials"].size()) + " materials";
  for (const Json& a : json["attributes"]) {
    text += "\nattribute " + a["name"].get<std::string>() + ": " +
            a["interpolation"].get<std::string>() + ", " +
            std::to_string(a["dimension"].get<int>()) + " numbers, " + count_of(a, "values") +
            " values";
  }
  return text;
}

Report file_report(const CreaseFile& file) {
  Report report;
  const Mesh mesh = ProgressiveMesh(file.arrays).extract();
  report.json = mesh_json(mesh);
  const BitsPerVertex bits = bits_per_vertex(file.info, mesh.vertex_count());
  const LinearBytes linear = linear_bytes(*file.arrays);
  Json bands = Json::array(), sections = Json::array();
  for (const FileInfo::Band& band : file.info.bands) bands.push_back(to_json(band));
  for (const FileInfo::Section& section : file.info.sections) {
    sections.push_back(
        {{"name", section.name}, {"offset", section.offset}, {"bytes", section.bytes}});
  }
  report.json.update(
      Json{{"version", file.info.version},
           {"bytes", file.info.bytes},
           {"bits_per_vertex",
            {{"total", bits.total},
             {"connectivity", bits.connectivity},
             {"positions", bits.positions},
             {"attributes", bits.attributes}}},
           {"bands", bands},
           {"blocks", block_count(file.info)},
           {"depth", hierarchy_depth(*file.arrays)},
           {"linear_bytes",
            {{"crease", linear.crease},
             {"wedge", linear.wedge},
             {"replicated", linear.replicated},
             {"records", linear.records}}},
           {"placement", file.arrays->placement == Placement::Optimal ? "optimal" : "endpoint"},
           {"precision", file.arrays->grid.step},
           {"sections", sections}});

  char line[160];
  std::snprintf(line, sizeof line,
                "%.1f bits a vertex: connectivity %.1f, positions %.1f, attributes %.1f",
                bits.total, bits.connectivity, bits.positions, bits.attributes);
  report.text = mesh_text(report.json) + "\n" + in_bytes(file.info.bytes) + ", " + line +
                "\nrun-time arrays: " + in_bytes(linear.crease) + "; with wedges " +
                in_bytes(linear.wedge) + ", with replicated vertices " +
                in_bytes(linear.replicated) + "\nlevel records: " + in_bytes(linear.records) +
                "\nbands:";
  for (const FileInfo::Band& band : file.info.bands) {
    report.text += "\n  down to " + grouped(band.triangles_after) + " triangles: error " +
                   in_length(band.surface_error) + ", " + grouped(band.patches) + " patches, " +
                   grouped(band.contractions) + " contractions";
  }
  return report;
}

Result<Report> run_info(const InfoArguments& options, const Common& common) {
  Report report;
  if (is_crease_file(options.file)) {
    const Result<CreaseFile> file = read_crease(options.file, {});
    if (!file.ok()) return file.failure();
    report = file_report(*file);
  } else {
    Result<ImportOptions> import = import_options(options.read, common);
    if (!import.ok()) return import.failure();
    const Result<Imported> imported = import_mesh(options.file, *import);
    if (!imported.ok()) return imported.failure();
    report.json = mesh_json(imported->mesh);
    report.json["import"] = to_json(imported->report);
    report.text = mesh_text(report.json) + "\n" + lines_of(imported->report);
  }
  if (interrupted()) return interrupted_failure();
  report.text_is_answer = true;
  return report;
}

}  // namespace

Command add_info(CLI::App& app, const Common& common) {
  auto options = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "what is inside a .crease or a mesh file");
  command->add_option("FILE", options->file, "the file")->required();
  add_import_options(*command, options->read);
  command->footer("Example:\n  crease info bunny.crease --json");
  return {command, [options, &common] { return run_info(*options, common); }};
}

}  // namespace crease::cli
