// crease extract: levels of detail as meshes, with what they are off by.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/level.h"
#include "cli/lod_chain.h"
#include "cli/model.h"
#include "cli/report.h"
#include "cli/text.h"
#include "cli/view.h"
#include "crease/export.h"
#include "crease/progressive_mesh.h"

#include <memory>
#include <optional>
#include <string>

namespace crease::cli {

namespace {

struct ExtractArguments {
  std::filesystem::path file, output;
  LevelOptions level;
  std::filesystem::path view;  // or empty
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
  if (options.chain.levels > 0) asked["levels"] = options.chain.levels;
  return asked;
}

// Why the level is not what was asked for.
std::string shortfall_of(const Chosen& chosen, const ProgressiveMesh& mesh) {
  const std::string count = grouped(mesh.triangle_count());
  if (chosen.stopped_by == StoppedBy::Topology) {
    return "target not met: the coarsest level has " + count + " triangles";
  }
  return "target not met: the level with " + count + " triangles is off by " +
         in_length(hausdorff(*chosen.measured));
}

std::string in_words(const std::optional<Comparison>& measured) {
  if (!measured) return "";
  return "; measured: surface mean " +
         in_length((measured->distance.a_to_b.mean + measured->distance.b_to_a.mean) / 2) +
         ", max " + in_length(hausdorff(*measured)) + ", normals mean " +
         in_degrees(measured->normal_deviation.mean);
}

Result<Report> extract_one(const ExtractArguments& options, ProgressiveMesh& mesh,
                           const Common& common) {
  const bool measures = options.level.samples > 0;
  const Mesh full = measures ? mesh.extract() : Mesh{};
  Result<Chosen> chosen = choose_level(mesh, full, options.level, common);
  if (!chosen.ok()) return chosen.failure();

  const Mesh level = mesh.extract();
  if (interrupted()) return interrupted_failure();
  if (measures && !chosen->measured) {
    CompareOptions compare;
    compare.samples = options.level.samples;
    compare.threads = common.threads;
    chosen->measured = compare_meshes(full, level, compare);
  }
  if (interrupted()) return interrupted_failure();
  const bool refused = options.strict && !chosen->target_met;
  if (!refused) {
    const Status written = export_mesh(level, options.output);
    if (!written.ok()) return written.failure();
  }

  Report report;
  report.json = {
      {"asked", asked_json(options)},
      {"output", refused ? Json(nullptr) : Json(options.output.string())},
      {"triangles", level.triangle_count()},
      {"vertices", level.vertex_count()},
      {"full_triangles", mesh.full_triangle_count()},
      {"stopped_by", name_of(chosen->stopped_by)},
      {"target_met", chosen->target_met},
      {"error", to_json(mesh.error())},
      {"error_measured", chosen->measured ? measured_json(*chosen->measured) : Json(nullptr)}};
  report.text = options.output.string() + ": " + grouped(level.triangle_count()) + " of " +
                grouped(mesh.full_triangle_count()) + " triangles, stopped by " +
                name_of(chosen->stopped_by) + in_words(chosen->measured);
  if (!chosen->target_met) {
    if (refused) {
      report.text.clear();
      report.short_of = Error::TargetNotMet;
      report.shortfall = shortfall_of(*chosen, mesh) + "; nothing was written (--strict)";
    } else {
      log(common, shortfall_of(*chosen, mesh));
    }
  }
  return report;
}

// Fine where the camera looks: what it sees is off by at most camera.pixels.
Result<Report> extract_view(const ExtractArguments& options, const Common& common) {
  const Result<Camera> camera = read_camera(options.view);
  if (!camera.ok()) return camera.failure();
  Result<ViewedModel> model = load_viewed(options.file, options.read, common);
  if (!model.ok()) return model.failure();
  model->mesh.update({.camera = *camera});

  const Mesh seen = model->mesh.extract();
  const std::size_t full_triangles = model->full.triangle_count();
  std::optional<Comparison> measured;
  if (options.level.samples > 0 && seen.triangle_count() > 0) {
    CompareOptions compare;
    compare.samples = options.level.samples;
    compare.threads = common.threads;
    measured = compare_meshes(model->full, seen, compare);
  }
  if (interrupted()) return interrupted_failure();
  const Status written = export_mesh(seen, options.output);
  if (!written.ok()) return written.failure();

  Report report;
  report.json = {{"asked", asked_json(options)},
                 {"output", options.output.string()},
                 {"triangles", seen.triangle_count()},
                 {"vertices", seen.vertex_count()},
                 {"full_triangles", full_triangles},
                 {"stopped_by", "view"},
                 {"target_met", true},
                 {"error", to_json(model->mesh.error())},
                 {"error_measured", measured ? measured_json(*measured) : Json(nullptr)},
                 {"bytes_read", model->info.bytes},
                 {"blocks_read", block_count(model->info)}};
  report.text = options.output.string() + ": " + grouped(seen.triangle_count()) + " of " +
                grouped(full_triangles) + " triangles for the view" + in_words(measured);
  return report;
}

Result<Report> run_extract(const ExtractArguments& options, const Common& common) {
  const Stopwatch watch;
  const bool is_chain = options.chain.levels > 0;
  if (is_chain && (options.level.triangles || options.level.ratio || options.level.error)) {
    return fail(Error::CommandLine,
                "--levels chooses its own counts: leave out --triangles, --ratio and --error");
  }
  if (!options.view.empty() &&
      (is_chain || options.level.triangles || options.level.ratio || options.level.error)) {
    return fail(Error::CommandLine,
                "--view asks for what a camera sees: leave out --triangles, --ratio, --error and "
                "--levels");
  }
  const Status writable = check_output(options.output, is_chain);
  if (!writable.ok()) return writable.failure();
  if (!options.view.empty()) {
    Result<Report> report = extract_view(options, common);
    if (!report.ok()) return report;
    report->json["seconds"] = watch.seconds();
    report->json["peak_memory"] = peak_memory();
    return report;
  }

  Result<Model> model = load_model(options.file, options.read, common);
  if (!model.ok()) return model.failure();
  ProgressiveMesh mesh(model->file.arrays);
  if (mesh.full_triangle_count() == 0) {
    return fail(Error::NoTriangles, options.file.string() + ": no triangles");
  }
  Result<Report> report =
      is_chain ? extract_chain(mesh, options.output, options.chain, options.level.samples, common)
               : extract_one(options, mesh, common);
  if (!report.ok()) return report;
  if (is_chain) report->json["asked"] = asked_json(options);
  // This first format is read whole.
  report->json["bytes_read"] = model->file.info.bytes;
  report->json["blocks_read"] = block_count(model->file.info);
  report->json["seconds"] = watch.seconds();
  report->json["peak_memory"] = peak_memory();
  return report;
}

}  // namespace

Command add_extract(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ExtractArguments>();
  CLI::App* command = app.add_subcommand("extract", "one level of detail, or a chain, as a mesh");
  command->add_option("FILE", options->file, ".crease, or a mesh file, which is built on the fly")
      ->required();
  command->add_option("-o,--output", options->output, ".obj, .ply, .stl or .glb")
      ->required()
      ->type_name("OUT");
  add_level_options(*command, options->level);
  command
      ->add_option("--view", options->view,
                   "fine where this camera looks, within its \"pixels\" on the screen, coarse "
                   "elsewhere: {\"position\":[x,y,z],\"target\":[x,y,z],\"pixels\":1}")
      ->type_name("CAM.json");
  command->add_flag("--strict", options->strict,
                    "exit with 5 and write nothing when the target is not met");
  add_chain_options(*command, options->chain);
  add_build_options(*command, options->read);
  command->footer(
      "Examples:\n  crease extract bunny.crease -o bunny_10.glb --ratio 0.1\n"
      "  crease extract bunny.crease -o bunny_lod.glb --levels 4\n"
      "  crease extract city.crease -o seen.glb --view camera.json");
  return {command, [options, &common] { return run_extract(*options, common); }};
}

}  // namespace crease::cli
