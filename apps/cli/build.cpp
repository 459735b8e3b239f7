// crease build: mesh files -> one .crease.
#include "crease/build.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/fields.h"
#include "cli/memory_option.h"
#include "cli/model.h"
#include "cli/output.h"
#include "cli/text.h"

#include <memory>
#include <utility>

namespace crease::cli {

namespace {

struct BuildArguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  ReadOptions read;
  std::string memory = "0";
};

Result<Imported> import_inputs(const BuildArguments& options, const Precision& precision,
                               const Common& common) {
  Result<ImportOptions> import = import_options(options.read, common);
  if (!import.ok()) return import.failure();
  Result<Imported> imported = options.inputs.size() == 1
                                  ? import_mesh(options.inputs.front(), *import)
                                  : import_meshes(options.inputs, *import);
  if (imported.ok()) {
    tell_strays(*imported, precision);
    const std::string more = options.inputs.size() == 1
                                 ? ""
                                 : " and " + std::to_string(options.inputs.size() - 1) + " more";
    log(common, options.inputs.front().string() + more + ":\n" + lines_of(imported->report));
  }
  return imported;
}

std::string snapped_lines(const Built& built) {
  // Where a grid has the model's own numbers, sums of its steps are off by what doubles are.
  constexpr double kRounding = 1e-6;
  std::string lines = "  positions: steps of " + in_length(built.grid_step);
  if (built.position_error_max > kRounding * built.grid_step) {
    lines += ", off by " + in_length(built.position_error_max) + " at most";
  }
  for (const SnappedLayer& layer : built.snapped) {
    lines += "\n  " + layer.layer + ": " + layer.precision;
    if (layer.error_max > 0) {
      const bool is_normal = layer.layer == "normal";
      lines += ", off by " + in_length(layer.error_max) + (is_normal ? " degrees" : "") +
               " at most, " + in_length(layer.error_mean) + " on average";
    }
    if (layer.joined > 0) {
      lines += "; " + grouped(layer.joined) + " values became equal to others of their vertices";
    }
  }
  return lines;
}

Json snapped_json(const std::vector<SnappedLayer>& layers) {
  Json all = Json::array();
  for (const SnappedLayer& layer : layers) {
    all.push_back({{"layer", layer.layer},
                   {"precision", layer.precision},
                   {"error_max", layer.error_max},
                   {"error_mean", layer.error_mean},
                   {"joined", layer.joined}});
  }
  return all;
}

Result<Report> run_build(const BuildArguments& options, const Common& common) {
  const Stopwatch watch;
  const std::string_view ending[] = {".crease"};
  const Status writable = check_output(options.output, ending, "models are", options.inputs);
  if (!writable.ok()) return writable.failure();
  for (const std::filesystem::path& input : options.inputs) {
    if (is_url(input)) {
      return fail(Error::NotSupported,
                  input.string() + ": is a URL; meshes are built of files of this machine");
    }
    if (is_crease_file(input)) {
      return fail(Error::NotSupported,
                  input.string() + ": is built already; extract a mesh from it to build it anew");
    }
  }
  Result<BuildOptions> build = build_options(options.read, common);  // before any work is done
  if (!build.ok()) return build.failure();
  const Result<MemoryOption> memory = limit_memory(options.memory, options.output, common);
  if (!memory.ok()) return memory.failure();
  Result<Imported> imported = import_inputs(options, build->precision, common);
  if (!imported.ok()) return imported.failure();
  const double import_seconds = watch.seconds();
  const std::size_t triangles = imported->mesh.triangle_count();
  const std::size_t vertices = imported->mesh.vertex_count();
  std::size_t image_bytes = 0;
  for (const ImageFile& image : imported->mesh.images) image_bytes += image.bytes->size();
  if (interrupted()) return interrupted_failure();

  const Result<Built> built = build_model(std::move(imported->mesh), *build);
  if (!built.ok()) return built.failure();
  log(common, snapped_lines(*built));
  const double build_seconds = watch.seconds() - import_seconds;
  if (interrupted()) return interrupted_failure();
  const Status written = write_crease(options.output, built->file_bytes);
  if (!written.ok()) return written.failure();

  if (memory->limit > 0) log(common, memory->spilled_line());
  const std::size_t bytes = built->file_bytes.size();
  const double bits =
      8.0 * static_cast<double>(bytes - image_bytes) / static_cast<double>(vertices);
  Report report;
  report.json = {{"output", options.output.string()},
                 {"triangles", triangles},
                 {"vertices", vertices},
                 {"seconds", watch.seconds()},
                 {"import_seconds", import_seconds},
                 {"build_seconds", build_seconds},
                 {"peak_memory", peak_memory()},
                 {"memory_limit", memory->limit},
                 {"spilled_bytes", memory->spilled_bytes()},
                 {"bytes", bytes},
                 {"image_bytes", image_bytes},
                 {"bits_per_vertex", bits},
                 {"bands", built->statistics.bands.size()},
                 {"blocks", built->blocks},
                 {"precision", built->grid_step},
                 {"position_error_max", built->position_error_max},
                 {"snapped", snapped_json(built->snapped)},
                 {"import", to_json(imported->report)}};
  report.text = options.output.string() + ": " + grouped(triangles) + " triangles, " +
                grouped(vertices) + " vertices, " + in_bytes(bytes) +
                (image_bytes > 0 ? " (" + in_bytes(image_bytes) + " of images), " : ", ") +
                in_seconds(watch.seconds()) + ", " + in_bytes(peak_memory()) + " of memory";
  return report;
}

}  // namespace

Command add_build(CLI::App& app, const Common& common) {
  auto options = std::make_shared<BuildArguments>();
  CLI::App* command = app.add_subcommand("build", "import, simplify, write one .crease file");
  command
      ->add_option(
          "IN", options->inputs,
          "OBJ, PLY, STL, OFF, glTF, GLB, b3dm, CityJSON, also .zst and .xz; several become "
          "one model, each a part")
      ->required();
  command->add_option("-o,--output", options->output, "the .crease file")
      ->required()
      ->type_name("OUT");
  add_build_options(*command, options->read);
  add_memory_option(*command, options->memory);
  command->footer(
      "Example:\n  crease build bunny.ply -o bunny.crease --normals crease:30 --precision 14bits");
  return {command, [options, &common] { return run_build(*options, common); }};
}

}  // namespace crease::cli
