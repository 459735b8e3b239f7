// crease info: what is inside a file.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/fields.h"
#include "cli/text.h"
#include "crease/build_progressive_arrays.h"
#include "crease/shading.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace crease::cli {

namespace {

struct InfoArguments {
  std::filesystem::path file;
  bool head_only = false;
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

Json attributes_json(const std::vector<LayerSchema>& layers) {
  Json attributes = Json::array();
  for (const LayerSchema& layer : layers) {
    attributes.push_back({{"name", layer.name},
                          {"role", name_of(layer.role)},
                          {"interpolation", name_of(layer.interpolation)},
                          {"dimension", layer.dimension}});
  }
  return attributes;
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

struct BitsPerVertex {
  double total = 0, connectivity = 0, positions = 0, attributes = 0;
};

BitsPerVertex per_vertex(const StreamBits& bits, std::size_t vertices) {
  const double share = vertices > 0 ? 1 / static_cast<double>(vertices) : 0;
  BitsPerVertex result;
  result.connectivity = share * (bits.roots + bits.flags + bits.shapes + bits.labels);
  result.positions = share * bits.positions;
  result.attributes = share * (bits.categories + bits.values);
  result.total = result.connectivity + result.positions + result.attributes;
  return result;
}

Json bits_json(const BitsPerVertex& bits) {
  return {{"total", bits.total},
          {"connectivity", bits.connectivity},
          {"positions", bits.positions},
          {"attributes", bits.attributes}};
}

Json streams_json(const StreamBits& bits) {
  return {{"roots", bits.roots},         {"flags", bits.flags},           {"shapes", bits.shapes},
          {"positions", bits.positions}, {"categories", bits.categories}, {"values", bits.values},
          {"labels", bits.labels}};
}

StreamBits sum_of(const std::vector<StreamBits>& all) {
  StreamBits sum;
  for (const StreamBits& bits : all) sum += bits;
  return sum;
}

// Finest first; the base, which no band holds, is on its own.
Json bands_json(const ModelFacts& facts, const std::vector<StreamBits>& bits) {
  Json bands = Json::array();
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    const BandFacts& band = facts.bands[b];
    bands.push_back({{"patches", band.patches},
                     {"contractions", band.contractions},
                     {"triangles_after", band.triangles_after},
                     {"surface_error", band.error.surface},
                     {"error", to_json(band.error)},
                     {"bits", streams_json(bits[b])}});
  }
  return bands;
}

std::string bits_text(const char* what, const BitsPerVertex& bits) {
  char line[160];
  std::snprintf(line, sizeof line,
                "%s%.2f bits a vertex: connectivity %.2f, positions %.2f, attributes %.2f", what,
                bits.total, bits.connectivity, bits.positions, bits.attributes);
  return line;
}

Report file_report(const ModelFile& file, const DecodedModel& model) {
  Report report;
  const Mesh& mesh = model.mesh;
  const ModelFacts& facts = file.blocks().facts();
  const std::uint64_t bytes = file.blocks().head().file_bytes;
  report.json = mesh_json(mesh);
  const StreamBits sum = sum_of(model.bits);
  BitsPerVertex bits = per_vertex(sum, mesh.vertex_count());
  // Head, directory and checksums among it.
  bits.total = mesh.vertex_count() > 0
                   ? 8.0 * static_cast<double>(bytes) / static_cast<double>(mesh.vertex_count())
                   : 0;
  const ProgressiveArraysPtr arrays = build_progressive_arrays(model.mesh, model.sequence);
  const LinearBytes linear = linear_bytes(*arrays);
  report.json.update(
      Json{{"version", 2},
           {"bytes", bytes},
           {"bits_per_vertex", bits_json(bits)},
           {"streams", streams_json(sum)},
           {"container_bytes", bytes - model.payload_bytes},
           {"bands", bands_json(facts, model.bits)},
           {"base_bits", streams_json(model.bits.back())},
           {"blocks", file.blocks().block_count()},
           {"depth", hierarchy_depth(*arrays)},
           {"linear_bytes",
            {{"crease", linear.crease},
             {"wedge", linear.wedge},
             {"replicated", linear.replicated},
             {"records", linear.records}}},
           {"placement", arrays->placement == Placement::Optimal ? "optimal" : "endpoint"},
           {"precision", arrays->grid.step}});

  report.text = mesh_text(report.json) + "\n" + in_bytes(bytes) + ", " + bits_text("", bits) +
                "; " + in_bytes(bytes - model.payload_bytes) +
                " of it head and directory\nrun-time arrays: " + in_bytes(linear.crease) +
                "; with wedges " + in_bytes(linear.wedge) + ", with replicated vertices " +
                in_bytes(linear.replicated) + "\nlevel records: " + in_bytes(linear.records) +
                "\nbands:";
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    const BandFacts& band = facts.bands[b];
    report.text += "\n  down to " + grouped(band.triangles_after) + " triangles: error " +
                   in_length(band.error.surface) + ", " + grouped(band.patches) + " blocks, " +
                   bits_text("", per_vertex(model.bits[b], band.contractions)) + " it adds";
  }
  return report;
}

// What the head says, which is the first 64 KiB at most.
Report head_report(const ModelFile& file) {
  const ModelFacts& facts = file.blocks().facts();
  Report report;
  Json bands = Json::array();
  for (const BandFacts& band : facts.bands) {
    bands.push_back({{"patches", band.patches},
                     {"contractions", band.contractions},
                     {"triangles_after", band.triangles_after},
                     {"surface_error", band.error.surface},
                     {"error", to_json(band.error)}});
  }
  report.json = {{"triangles", facts.triangle_count},           {"vertices", facts.vertex_count},
                 {"attributes", attributes_json(facts.layers)}, {"version", 2},
                 {"bytes", file.blocks().head().file_bytes},    {"bands", bands},
                 {"blocks", file.blocks().block_count()},       {"precision", facts.grid.step},
                 {"bytes_read", file.bytes_to_open()}};
  report.text = grouped(facts.triangle_count) + " triangles, " + grouped(facts.vertex_count) +
                " vertices, " + in_bytes(file.blocks().head().file_bytes) + " in " +
                grouped(file.blocks().block_count()) + " blocks\nbands:";
  for (const BandFacts& band : facts.bands) {
    report.text += "\n  down to " + grouped(band.triangles_after) + " triangles: error " +
                   in_length(band.error.surface) + ", " + grouped(band.patches) + " blocks";
  }
  return report;
}

Result<Report> run_info(const InfoArguments& options, const Common& common) {
  Report report;
  if (is_crease_file(options.file)) {
    const Result<ModelFile> file = open_model(options.file, options.read, common);
    if (!file.ok()) return file.failure();
    if (options.head_only) {
      report = head_report(*file);
      report.text_is_answer = true;
      return report;
    }
    DecodeOptions decode = decode_options(common);
    decode.count_bits = true;
    const Result<DecodedModel> model = decode_model(file->blocks(), decode);
    if (!model.ok()) return model.failure();
    report = file_report(*file, *model);
    report.json["bytes_read"] = file->blocks().source().bytes_read();
  } else if (options.head_only) {
    return fail(Error::NotCrease, options.file.string() + ": --head is of .crease files");
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
  command->add_option("FILE", options->file, "the file, or the URL of a .crease")->required();
  command->add_flag("--head", options->head_only,
                    "what the head of a .crease says; reads 64 KiB at most");
  add_import_options(*command, options->read);
  command->footer(
      "Examples:\n  crease info bunny.crease --json\n"
      "  crease info https://host/city.crease --head");
  return {command, [options, &common] { return run_info(*options, common); }};
}

}  // namespace crease::cli
