// crease extract: levels of detail as meshes, with what they are off by.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/fields.h"
#include "cli/level.h"
#include "cli/lod_chain.h"
#include "cli/model.h"
#include "cli/output.h"
#include "cli/parts_left.h"
#include "cli/text.h"
#include "cli/view.h"
#include "crease/progressive_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

namespace crease::cli {

namespace {

struct ExtractArguments {
  std::filesystem::path file, output;
  LevelOptions level;
  std::filesystem::path view;  // or empty
  ViewOptions of_view;
  LodChainOptions chain;
  bool strict = false;
  ReadOptions read;
};

Json asked_json(const ExtractArguments& options) {
  Json asked = Json::object();
  if (options.level.triangles) asked["triangles"] = *options.level.triangles;
  if (options.level.ratio) asked["ratio"] = *options.level.ratio;
  if (options.level.error) asked["error"] = *options.level.error;
  if (!options.view.empty()) asked["view"] = options.view.string();
  if (options.of_view.degrees > 0) asked["degrees"] = options.of_view.degrees;
  if (options.of_view.consistent) asked["consistent"] = true;
  if (options.chain.levels > 0) asked["levels"] = options.chain.levels;
  return asked;
}

std::string in_words(const std::optional<Comparison>& measured) {
  if (!measured) return "";
  return "; measured: surface mean " +
         in_length((measured->distance.a_to_b.mean + measured->distance.b_to_a.mean) / 2) +
         ", max " + in_length(hausdorff(*measured)) + ", normals mean " +
         in_degrees(measured->normal_deviation.mean);
}

// How many triangles are asked for, where it is a number of them.
std::optional<std::size_t> triangles_wanted(const ExtractArguments& options, std::size_t full) {
  const LevelOptions& level = options.level;
  if (level.triangles) return level.triangles;
  if (!level.ratio || options.chain.levels > 0) return std::nullopt;
  return std::max<std::size_t>(
      1, static_cast<std::size_t>(std::llround(*level.ratio * static_cast<double>(full))));
}

Json read_json(const ModelFile& file, const Model& model) {
  return {{"full_triangles", file.triangle_count()},
          {"bytes_read", model.bytes_read},
          {"blocks_read", model.decoded.blocks.size()},
          {"file_bytes", file.blocks().head().file_bytes}};
}

Result<Comparison> measure(const ModelFile& file, const Mesh& level, const LevelOptions& options,
                           const Common& common) {
  const Result<Model> all = file.load({.is_mesh_only = true, .part_names = false});
  if (!all.ok()) return all.failure();
  return measure_level(all->decoded.mesh, level, options.samples, common);
}

// An STL has none, so that nobody need read their names.
bool has_parts(const std::filesystem::path& output) {
  return ending_of(output) != ".stl";
}

struct ExtractedLevel {
  Model model;  // what was read; its mesh has moved into the level where that is all of it
  Mesh mesh;
  Chosen chosen;
  LevelError error;
};

// Reads the blocks of the level.
Result<ExtractedLevel> extract_level(const ExtractArguments& options, const ModelFile& file,
                                     const Common& common) {
  LevelOptions asked = options.level;
  asked.triangles = triangles_wanted(options, file.triangle_count());
  asked.ratio = std::nullopt;
  const bool is_full =
      !asked.error && asked.triangles.value_or(file.triangle_count()) >= file.triangle_count();
  Result<Model> model = file.load({.triangles = asked.triangles,
                                   .is_one_level = true,
                                   .is_mesh_only = is_full,
                                   .part_names = has_parts(options.output)});
  if (!model.ok()) return model.failure();
  ExtractedLevel level;
  if (is_full) {
    level.mesh = std::move(model->decoded.mesh);
    level.chosen.stopped_by = StoppedBy::Triangles;
  } else {
    ProgressiveMesh mesh = model->levels();
    const Mesh full = asked.error ? mesh.extract() : Mesh{};
    Result<Chosen> chosen = choose_level(mesh, full, asked, common);
    if (!chosen.ok()) return chosen.failure();
    level.chosen = *chosen;
    level.mesh = mesh.extract();
    level.error = mesh.error();
  }
  level.error = larger(level.error, model->decoded.error);
  level.model = *std::move(model);
  return level;
}

// What of the file its meshes lack: parts go by their names, which lie at its end.
std::vector<std::string> lost_parts(const ModelFile& file, const Mesh& mesh,
                                    const std::filesystem::path& output, const Common& common) {
  const std::size_t part_count = file.blocks().head().part_count;
  if (part_count == 0 || !mesh.parts.empty()) return {};
  if (has_parts(output) && !file.blocks().has_parts()) {
    log(common, file.name() + ": the names of its parts are missing: the file was cut");
  }
  return {"parts (" + std::to_string(part_count) + ")"};
}

// Where the output has a place for them.
Status add_images(const ExtractArguments& options, const ModelFile& file, Mesh& mesh) {
  const std::string ending = ending_of(options.output);
  if (ending == ".stl") return Done{};
  Result<std::vector<ImageFile>> images = file.images(mesh.materials);
  if (!images.ok()) return images.failure();
  mesh.images = *std::move(images);
  return Done{};
}

// The model's own, and what it names.
std::vector<std::filesystem::path> files_read(const std::filesystem::path& path,
                                              const ModelFile& file,
                                              std::span<const ImageFile> images) {
  std::vector<std::filesystem::path> files = {path};
  for (const ImageFile& image : images) files.push_back(path.parent_path() / image.name);
  if (!file.imported()) return files;
  const std::vector<std::filesystem::path>& libraries = file.imported()->libraries;
  files.insert(files.end(), libraries.begin(), libraries.end());
  return files;
}

Result<ExportReport> write_level(const ExtractArguments& options, const ModelFile& file,
                                 Mesh& level, const Common& common) {
  const Status painted = add_images(options, file, level);
  if (!painted.ok()) return painted.failure();
  return write_mesh(level, options.output, common,
                    {.inputs = files_read(options.file, file, level.images),
                     .lost = lost_parts(file, level, options.output, common)});
}

// That the level is not what was asked for.
void tell_shortfall(const ExtractArguments& options, std::size_t triangles, const Common& common,
                    Report& report) {
  if (!options.strict) return log(common, shortfall_of(triangles));
  report.text.clear();
  report.short_of = Error::TargetNotMet;
  report.shortfall = shortfall_of(triangles) + "; nothing was written (--strict)";
}

// To measure what the level is off by takes all blocks.
Result<Report> extract_one(const ExtractArguments& options, const ModelFile& file,
                           const Common& common) {
  Result<ExtractedLevel> extracted = extract_level(options, file, common);
  if (!extracted.ok()) return extracted.failure();
  const Mesh& level = extracted->mesh;
  const PartsLeft parts = parts_left(level);
  Chosen& chosen = extracted->chosen;
  if (interrupted()) return interrupted_failure();
  if (options.level.samples > 0 && !chosen.measured) {
    const Result<Comparison> measured = measure(file, level, options.level, common);
    if (!measured.ok()) return measured.failure();
    chosen.measured = *measured;
  }
  const bool refused = options.strict && !chosen.target_met;
  ExportReport exported;
  if (!refused) {
    const Result<ExportReport> written = write_level(options, file, extracted->mesh, common);
    if (!written.ok()) return written.failure();
    exported = *written;
  }

  Report report;
  report.json = {
      {"asked", asked_json(options)},
      {"output", refused ? Json(nullptr) : Json(options.output.string())},
      {"triangles", level.triangle_count()},
      {"vertices", level.vertex_count()},
      {"stopped_by", name_of(chosen.stopped_by)},
      {"target_met", chosen.target_met},
      {"error", to_json(extracted->error)},
      {"error_measured", chosen.measured ? measured_json(*chosen.measured) : Json(nullptr)}};
  report.json.update(to_json(exported));
  report.json.update(read_json(file, extracted->model));
  report.json.update(parts.json());
  report.text = options.output.string() + ": " + grouped(level.triangle_count()) + " of " +
                grouped(file.triangle_count()) + " triangles" + parts.words() + ", stopped by " +
                name_of(chosen.stopped_by) + in_words(chosen.measured);
  if (!chosen.target_met) tell_shortfall(options, level.triangle_count(), common, report);
  return report;
}

// Fine where the camera looks: what it sees is off by at most camera.pixels, or by as little as its
// triangles allow.
Result<Report> extract_view(const ExtractArguments& options, const ModelFile& file,
                            const Common& common) {
  const Result<Camera> camera = read_camera(options.view);
  if (!camera.ok()) return camera.failure();
  const ViewParameters view = view_of(*camera, options.of_view, options.level.triangles);
  Result<ViewedModel> model = load_viewed(file, view, {.part_names = has_parts(options.output)});
  if (!model.ok()) return model.failure();

  Mesh seen = model->mesh.extract();
  const PartsLeft parts = parts_left(seen);
  std::optional<Comparison> measured;
  if (options.level.samples > 0 && seen.triangle_count() > 0) {
    const Result<Comparison> comparison = measure(file, seen, options.level, common);
    if (!comparison.ok()) return comparison.failure();
    measured = *comparison;
  }
  if (interrupted()) return interrupted_failure();
  const bool is_met = model->stopped_by != StoppedBy::Topology;
  const bool refused = options.strict && !is_met;
  ExportReport exported;
  if (!refused) {
    const Result<ExportReport> written = write_level(options, file, seen, common);
    if (!written.ok()) return written.failure();
    exported = *written;
  }

  Report report;
  report.json = {{"asked", asked_json(options)},
                 {"output", refused ? Json(nullptr) : Json(options.output.string())},
                 {"triangles", seen.triangle_count()},
                 {"vertices", seen.vertex_count()},
                 {"full_triangles", file.triangle_count()},
                 {"stopped_by", name_of(model->stopped_by)},
                 {"target_met", is_met},
                 {"error", to_json(larger(model->mesh.error(), model->error))},
                 {"error_measured", measured ? measured_json(*measured) : Json(nullptr)},
                 {"bytes_read", model->bytes_read},
                 {"blocks_read", model->blocks_read},
                 {"file_bytes", file.blocks().head().file_bytes}};
  report.json.update(to_json(exported));
  report.json.update(parts.json());
  report.text = options.output.string() + ": " + grouped(seen.triangle_count()) + " of " +
                grouped(file.triangle_count()) + " triangles for the view" + parts.words() +
                ", stopped by " + name_of(model->stopped_by) + in_words(measured);
  if (!is_met) tell_shortfall(options, seen.triangle_count(), common, report);
  return report;
}

Result<Report> extract_levels(const ExtractArguments& options, const ModelFile& file,
                              const Common& common) {
  const Result<Model> model = file.load();
  if (!model.ok()) return model.failure();
  ProgressiveMesh mesh = model->levels();
  const Result<std::vector<ImageFile>> images = file.images(mesh.arrays().materials);
  if (!images.ok()) return images.failure();
  LodChainOptions chain = options.chain;
  chain.strict = options.strict;
  Result<Report> report =
      extract_chain(mesh, *images, options.output, chain, options.level.samples, common);
  if (!report.ok()) return report;
  report->json["asked"] = asked_json(options);
  report->json["left_out"] = lost_parts(file, model->decoded.mesh, options.output, common);
  report->json.update(read_json(file, *model));
  return report;
}

Result<Report> run_extract(const ExtractArguments& options, const Common& common) {
  const Stopwatch watch;
  const bool is_chain = options.chain.levels > 0;
  if (is_chain && (options.level.triangles || options.level.ratio || options.level.error)) {
    return fail(Error::CommandLine,
                "--levels chooses its own counts: leave out --triangles, --ratio and --error");
  }
  if (!options.view.empty() && (is_chain || options.level.ratio || options.level.error)) {
    return fail(Error::CommandLine,
                "--view asks for what a camera sees, with --triangles at most so many: leave out "
                "--ratio, --error and --levels");
  }
  const std::string_view glb[] = {".glb"};
  const Status writable =
      is_chain ? check_ending(options.output, glb, "chains of levels are")
               : check_output(options.output, kMeshEndings, "levels are", {&options.file, 1});
  if (!writable.ok()) return writable.failure();
  if (is_chain) {
    for (const std::filesystem::path& output : files_of_chain(options.output, options.chain)) {
      const Status fine = check_place(output, {&options.file, 1});
      if (!fine.ok()) return fine.failure();
    }
  }
  const Result<ModelFile> file = open_model(options.file, options.read, common);
  if (!file.ok()) return file.failure();
  if (file->triangle_count() == 0) {
    return fail(Error::NoTriangles, options.file.string() + ": no triangles");
  }
  Result<Report> report = !options.view.empty() ? extract_view(options, *file, common)
                          : is_chain            ? extract_levels(options, *file, common)
                                                : extract_one(options, *file, common);
  if (!report.ok()) return report;
  report->json["seconds"] = watch.seconds();
  report->json["peak_memory"] = peak_memory();
  return report;
}

}  // namespace

Command add_extract(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ExtractArguments>();
  CLI::App* command = app.add_subcommand("extract", "one level of detail, or a chain, as a mesh");
  command
      ->add_option("FILE", options->file,
                   ".crease or its URL, or a mesh file, which is built on the fly")
      ->required();
  command->add_option("-o,--output", options->output, ".obj, .ply, .stl or .glb")
      ->required()
      ->type_name("OUT");
  add_level_options(*command, options->level);
  CLI::Option* view =
      command
          ->add_option("--view", options->view,
                       "fine where this camera looks, within its \"pixels\" on the screen, coarse "
                       "elsewhere: {\"position\":[x,y,z],\"target\":[x,y,z],\"pixels\":1}; with "
                       "--triangles as fine as so many allow")
          ->type_name("CAM.json");
  add_view_options(*command, view, options->of_view);
  command->add_flag("--strict", options->strict,
                    "exit with 5 and write nothing when the target is not met");
  add_chain_options(*command, options->chain);
  add_build_options(*command, options->read);
  command->footer(
      "Examples:\n  crease extract bunny.crease -o bunny_10.glb --ratio 0.1\n"
      "  crease extract bunny.crease -o bunny_lod.glb --levels 4\n"
      "  crease extract city.crease -o seen.glb --view camera.json --triangles 20000\n"
      "  crease extract https://host/city.crease -o coarse.glb --triangles 5000");
  const CLI::Option* samples = command->get_option("--samples");
  return {command, [options, samples, &common] {
            ExtractArguments asked = *options;
            const bool must_measure = asked.level.error || asked.chain.levels > 0;
            // To measure takes all of the file, which is not what a URL is asked for.
            if (is_url(asked.file) && samples->count() == 0 && !must_measure) {
              asked.level.samples = 0;
            }
            return run_extract(asked, common);
          }};
}

}  // namespace crease::cli
