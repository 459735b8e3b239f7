// crease extract: levels of detail as meshes, with what they are off by.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/level.h"
#include "cli/lod_chain.h"
#include "cli/model.h"
#include "cli/report.h"
#include "cli/text.h"
#include "crease/export.h"
#include "crease/progressive_mesh.h"

#include <algorithm>
#include <memory>

namespace crease::cli {

namespace {

struct ExtractArguments {
  std::filesystem::path file, output;
  LevelOptions level;
  LodChainOptions chain;
  bool strict = false;
  ReadOptions read;
};

Json asked_json(const ExtractArguments& options) {
  Json asked = Json::object();
  if (options.level.triangles) asked["triangles"] = *options.level.triangles;
  if (options.level.ratio) asked["ratio"] = *options.level.ratio;
  if (options.level.error) asked["error"] = *options.level.error;
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
                name_of(chosen->stopped_by);
  if (chosen->measured) {
    report.text +=
        "; measured: surface mean " +
        in_length(
            (chosen->measured->distance.a_to_b.mean + chosen->measured->distance.b_to_a.mean) / 2) +
        ", max " + in_length(hausdorff(*chosen->measured)) + ", normals mean " +
        in_degrees(chosen->measured->normal_deviation.mean);
  }
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

Result<Report> run_extract(const ExtractArguments& options, const Common& common) {
  const Stopwatch watch;
  const bool is_chain = options.chain.levels > 0;
  if (is_chain && (options.level.triangles || options.level.ratio || options.level.error)) {
    return fail(Error::CommandLine,
                "--levels chooses its own counts: leave out --triangles, --ratio and --error");
  }
  const Status writable = check_output(options.output, is_chain);
  if (!writable.ok()) return writable.failure();

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
  command->add_flag("--strict", options->strict,
                    "exit with 5 and write nothing when the target is not met");
  add_chain_options(*command, options->chain);
  add_build_options(*command, options->read);
  command->footer(
      "Examples:\n  crease extract bunny.crease -o bunny_10.glb --ratio 0.1\n"
      "  crease extract bunny.crease -o bunny_lod.glb --levels 4");
  return {command, [options, &common] { return run_extract(*options, common); }};
}

}  // namespace crease::cli
