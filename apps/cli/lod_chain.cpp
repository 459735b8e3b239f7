#include "cli/lod_chain.h"

#include "cli/console.h"
#include "cli/fields.h"
#include "cli/level.h"
#include "cli/number_check.h"
#include "cli/parts_left.h"
#include "cli/text.h"
#include "crease/export.h"
#include "crease/write_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace crease::cli {

void add_chain_options(CLI::App& command, LodChainOptions& options) {
  CLI::Option* levels =
      command
          .add_option(
              "--levels", options.levels,
              "a chain of N levels: OUT_0.glb, OUT_1.glb, ... and OUT.json with their errors")
          ->type_name("N")
          ->check(number_from(1, 32));
  command
      .add_option("--step", options.step, "triangles of a level of the chain beside the one before")
      ->type_name("R")
      ->check(number_from(0.01, 0.99))
      ->needs(levels)
      ->capture_default_str();
  command
      .add_flag("--lod-glb", options.one_glb, "the chain as one GLB whose node carries MSFT_lod")
      ->needs(levels);
}

namespace {

std::filesystem::path level_file(const std::filesystem::path& output, std::size_t level) {
  return output.parent_path() / (output.stem().string() + "_" + std::to_string(level) + ".glb");
}

std::filesystem::path manifest_file(const std::filesystem::path& output) {
  return output.parent_path() / (output.stem().string() + ".json");
}

struct ChainLevel {
  std::vector<std::byte> glb;  // of its own, or
  Mesh mesh;                   // for one of all levels
  PartsLeft parts;
  Json json;
};

Result<ChainLevel> make_level(ProgressiveMesh& mesh, const std::vector<ImageFile>& images,
                              const Mesh& full, const LodChainOptions& options, std::size_t samples,
                              const Common& common) {
  Mesh level = mesh.extract();
  level.images = images;
  ChainLevel made;
  made.json = {{"triangles", level.triangle_count()},
               {"vertices", level.vertex_count()},
               {"error", to_json(mesh.error())}};
  made.parts = parts_left(level);
  made.json.update(made.parts.json());
  if (samples > 0) {
    const Result<Comparison> measured = measure_level(full, level, samples, common);
    if (!measured.ok()) return measured.failure();
    made.json["error_measured"] = measured_json(*measured);
  }
  if (options.one_glb) {
    made.mesh = std::move(level);
    return made;
  }
  Result<std::vector<std::byte>> glb = export_bytes(level, ".glb");
  if (!glb.ok()) return glb.failure();
  made.glb = *std::move(glb);
  return made;
}

// A level is meant for half the screen height of the one before, and the coarsest is never culled.
Status write_one_glb(std::vector<ChainLevel> levels, const std::filesystem::path& output) {
  std::vector<Mesh> meshes;
  std::vector<double> coverage;
  for (ChainLevel& level : levels) {
    meshes.push_back(std::move(level.mesh));
    coverage.push_back(std::pow(0.5, static_cast<double>(meshes.size())));
  }
  coverage.back() = 0;
  if (meshes.size() == 1) coverage.clear();
  const Result<std::vector<std::byte>> glb = export_lod_glb(meshes, coverage);
  if (!glb.ok()) return fail(glb.failure().error, output.string() + ": " + glb.failure().message);
  return write_file(output, *glb);
}

}  // namespace

std::vector<std::filesystem::path> files_of_chain(const std::filesystem::path& output,
                                                  const LodChainOptions& options) {
  if (options.one_glb) return {output};
  std::vector<std::filesystem::path> files = {manifest_file(output)};
  for (int i = 0; i < options.levels; ++i) {
    files.push_back(level_file(output, static_cast<std::size_t>(i)));
  }
  return files;
}

Result<Report> extract_chain(ProgressiveMesh& mesh, const std::vector<ImageFile>& images,
                             const std::filesystem::path& output, const LodChainOptions& options,
                             std::size_t samples, const Common& common) {
  const Mesh full = mesh.extract();
  std::vector<ChainLevel> levels;
  bool target_met = true;
  double asked = static_cast<double>(mesh.full_triangle_count());
  for (int i = 0; i < options.levels; ++i, asked *= options.step) {
    LevelOptions wanted;
    wanted.triangles = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(asked)));
    const Result<Chosen> chosen = choose_level(mesh, full, wanted, common);
    if (!chosen.ok()) return chosen.failure();
    if (i > 0 && levels.back().json["triangles"] == mesh.triangle_count()) {
      log(common, "the chain ends after " + std::to_string(i) + " levels: the coarsest has " +
                      grouped(mesh.triangle_count()) + " triangles");
      target_met = false;
      break;
    }
    target_met = target_met && chosen->target_met;
    Result<ChainLevel> level = make_level(mesh, images, full, options, samples, common);
    if (!level.ok()) return level.failure();
    levels.push_back(*std::move(level));
    if (interrupted()) return interrupted_failure();
  }

  Report report;
  report.json["output"] = nullptr;
  report.json["target_met"] = target_met;
  if (options.strict && !target_met) {
    report.json["levels"] = Json::array();
    report.short_of = Error::TargetNotMet;
    report.shortfall = "target not met: there are no " + std::to_string(options.levels) +
                       " levels, each as coarse as asked; nothing was written (--strict)";
    return report;
  }
  Json manifest = Json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    Json& json = levels[i].json;
    if (!options.one_glb) {
      const std::filesystem::path file = level_file(output, i);
      const Status written = write_file(file, levels[i].glb);
      if (!written.ok()) return written.failure();
      json["file"] = file.filename().string();
    }
    report.text += (i > 0 ? "\n" : "") + std::string("level ") + std::to_string(i) + ": " +
                   grouped(json["triangles"].get<std::size_t>()) + " triangles" +
                   levels[i].parts.words();
    if (json.contains("error_measured")) {
      report.text += ", off by " + in_length(json["error_measured"]["surface_max"].get<double>()) +
                     " at most, " +
                     in_degrees(json["error_measured"]["degrees_mean"].get<double>()) +
                     " on average";
    }
    manifest.push_back(json);
  }

  if (options.one_glb) {
    const Status written = write_one_glb(std::move(levels), output);
    if (!written.ok()) return written.failure();
    report.json["output"] = output.string();
  } else {
    const std::string text = Json{{"levels", manifest}}.dump(2) + "\n";
    const std::filesystem::path file = manifest_file(output);
    const Status written = write_file(file, std::as_bytes(std::span<const char>(text)));
    if (!written.ok()) return written.failure();
    report.json["output"] = file.string();
  }
  report.json["levels"] = std::move(manifest);
  return report;
}

}  // namespace crease::cli
