// crease info: what is inside a file.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/facts.h"
#include "cli/fields.h"
#include "cli/model.h"
#include "cli/text.h"
#include "crease/build_progressive_arrays.h"

#include <cstdio>
#include <memory>

namespace crease::cli {

namespace {

struct InfoArguments {
  std::filesystem::path file;
  bool head_only = false;
  ReadOptions read;
};

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

std::string images_text(const Json& images) {
  std::string text;
  for (const Json& image : images) {
    text += "\nimage " + image["name"].get<std::string>() + ": " +
            in_bytes(image["bytes"].get<std::uint64_t>());
  }
  return text;
}

std::string bits_text(const BitsPerVertex& bits, const char* vertex) {
  char line[160];
  std::snprintf(line, sizeof line,
                "%.2f bits %s: connectivity %.2f, positions %.2f, attributes %.2f", bits.total,
                vertex, bits.connectivity, bits.positions, bits.attributes);
  return line;
}

Report file_report(const ModelFile& file, const DecodedModel& model) {
  Report report;
  const ModelFacts& facts = file.blocks().facts();
  const ProgressiveArraysPtr arrays = build_progressive_arrays(model.mesh, model.sequence);
  const Json& json = report.json = file_facts(file, model, *arrays);
  const Json& linear = json["linear_bytes"];
  const auto bytes = [](const Json& count) { return in_bytes(count.get<std::uint64_t>()); };
  report.text = mesh_text(json) + "\n" + bytes(json["bytes"]) + ", " +
                bits_text(whole_file_per_vertex(file, model), "a vertex") + "; " +
                bytes(json["container_bytes"]) +
                " of it head and directory\nrun-time arrays: " + bytes(linear["crease"]) +
                "; with wedges " + bytes(linear["wedge"]) + ", with replicated vertices " +
                bytes(linear["replicated"]) + "\nlevel records: " + bytes(linear["records"]) +
                "\nbands:";
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    const BandFacts& band = facts.bands[b];
    report.text += "\n  down to " + grouped(band.triangles_after) + " triangles: error " +
                   in_length(band.error.surface) + ", " + grouped(band.patches) + " blocks, " +
                   bits_text(per_vertex(model.bits[b], band.contractions), "a vertex that it adds");
  }
  return report;
}

// What the head says, which is the first 64 KiB at most.
Report head_report(const ModelFile& file) {
  const ModelFacts& facts = file.blocks().facts();
  Report report;
  report.json = head_facts(file);
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
    if (const Status shaded = file->check_normals(); !shaded.ok()) return shaded.failure();
    const Result<DecodedModel> model = decode_model(file->blocks(), decode);
    if (!model.ok()) return model.failure();
    if (!file->blocks().has_parts()) return file->blocks().read_parts().failure();
    report = file_report(*file, *model);
    const Result<std::vector<ImageEntry>> images = file->blocks().read_image_list();
    if (!images.ok()) return images.failure();
    if (!file->blocks().has_images()) return file->blocks().read_images().failure();
    report.json["images"] = images_json(*images);
    report.text += images_text(report.json["images"]);
    report.json["bytes_read"] = file->bytes_read();
  } else if (options.head_only) {
    return fail(Error::NotCrease, options.file.string() + ": --head is of .crease files");
  } else {
    Result<ImportOptions> import = import_options(options.read, common);
    if (!import.ok()) return import.failure();
    const Result<Imported> imported = import_mesh(options.file, *import);
    if (!imported.ok()) return imported.failure();
    report.json = mesh_facts(imported->mesh);
    report.json["import"] = to_json(imported->report);
    report.json["images"] = images_json(imported->mesh.images);
    report.text = mesh_text(report.json) + images_text(report.json["images"]) + "\n" +
                  lines_of(imported->report);
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
                    "what the head of a .crease says, 64 KiB at most; else all of it is decoded");
  add_import_options(*command, options->read);
  command->footer(
      "Examples:\n  crease info bunny.crease --json\n"
      "  crease info https://host/city.crease --head");
  return {command, [options, &common] { return run_info(*options, common); }};
}

}  // namespace crease::cli
