// crease generate: procedural models for demos, tests and benchmarks.
#include "crease/generate.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/fields.h"
#include "cli/number_check.h"
#include "cli/output.h"
#include "cli/text.h"

#include <filesystem>
#include <memory>

namespace crease::cli {

namespace {

struct GenerateArguments {
  std::string shape;
  std::filesystem::path output;
  CityOptions city;
};

Result<Report> run_generate(const GenerateArguments& options, const Common& common) {
  const Stopwatch watch;
  const Status writable = check_output(options.output, kMeshEndings, "shapes are", {});
  if (!writable.ok()) return writable.failure();
  const Mesh mesh = generate_city(options.city);
  if (interrupted()) return interrupted_failure();
  const Result<ExportReport> written = write_mesh(mesh, options.output, common);
  if (!written.ok()) return written.failure();

  Report report;
  report.json = {{"output", options.output.string()}, {"shape", options.shape},
                 {"seed", options.city.seed},         {"triangles", mesh.triangle_count()},
                 {"vertices", mesh.vertex_count()},   {"parts", mesh.parts.size()},
                 {"seconds", watch.seconds()}};
  report.json.update(to_json(*written));
  report.text = options.output.string() + ": " + grouped(mesh.triangle_count()) + " triangles, " +
                grouped(mesh.vertex_count()) + " vertices, " + grouped(mesh.parts.size()) +
                " parts, " + in_seconds(watch.seconds());
  return report;
}

}  // namespace

Command add_generate(CLI::App& app, const Common& common) {
  auto options = std::make_shared<GenerateArguments>();
  CLI::App* command =
      app.add_subcommand("generate", "procedural models: the same bytes everywhere");
  command->add_option("SHAPE", options->shape, "city")->required()->check(CLI::IsMember({"city"}));
  command->add_option("-o,--output", options->output, ".obj, .ply, .stl or .glb")
      ->required()
      ->type_name("OUT");
  command->add_option("--triangles", options->city.triangles, "about how many")
      ->type_name("N")
      ->check(number_from(1, double(CityOptions::kMost)))
      ->capture_default_str();
  command->add_option("--seed", options->city.seed, "another seed, another city")
      ->type_name("S")
      ->capture_default_str();
  command->footer("Example:\n  crease generate city -o city.glb --triangles 1000000 --seed 1");
  return {command, [options, &common] { return run_generate(*options, common); }};
}

}  // namespace crease::cli
