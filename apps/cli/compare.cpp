// crease compare: how far two meshes are apart.
#include "crease/compare.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/fields.h"
#include "cli/model.h"
#include "cli/number_check.h"
#include "cli/text.h"

#include <cstdio>
#include <memory>

namespace crease::cli {

namespace {

struct CompareArguments {
  std::filesystem::path a, b;
  CompareOptions compare;
  ReadOptions read;
};

std::string row(const char* name, const Spread& spread, double diagonal) {
  char line[160];
  std::snprintf(line, sizeof line,
                "%-10s mean %-10.4g rms %-10.4g max %-10.4g (%.3g of the diagonal)", name,
                spread.mean, spread.rms, spread.max, spread.mean / diagonal);
  return line;
}

Result<Report> run_compare(const CompareArguments& options, const Common& common) {
  const Stopwatch watch;
  Mesh meshes[2];
  const std::filesystem::path* paths[2] = {&options.a, &options.b};
  for (int i = 0; i < 2; ++i) {
    Result<Mesh> mesh = load_mesh(*paths[i], options.read, common);
    if (!mesh.ok()) return mesh.failure();
    if (mesh->triangle_count() == 0) {
      return fail(Error::NoTriangles, paths[i]->string() + ": no triangles to compare");
    }
    if (interrupted()) return interrupted_failure();
    meshes[i] = *std::move(mesh);
  }
  CompareOptions compare = options.compare;
  compare.threads = common.threads;
  compare.progress = progress_bar(common);
  const Result<Comparison> compared = compare_meshes(meshes[0], meshes[1], compare);
  wipe_progress_bar();
  if (interrupted()) return interrupted_failure();
  if (!compared.ok()) return compared.failure();
  const Comparison& c = *compared;

  Report report;
  report.json = to_json(c);
  report.json["triangles"] = {{"a", meshes[0].triangle_count()}, {"b", meshes[1].triangle_count()}};
  report.json["seconds"] = watch.seconds();
  const double diagonal = c.diagonal > 0 ? c.diagonal : 1;
  report.text = row("A to B", c.distance.a_to_b, diagonal) + "\n" +
                row("B to A", c.distance.b_to_a, diagonal) + "\nnormals    mean " +
                in_degrees(c.normal_deviation.mean) + ", 95 % below " +
                in_degrees(c.normal_deviation.p95) + ", max " + in_degrees(c.normal_deviation.max);
  report.text_is_answer = true;
  return report;
}

}  // namespace

Command add_compare(CLI::App& app, const Common& common) {
  auto options = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "surface distance and normal deviation of two meshes, both ways");
  command->add_option("A", options->a, "mesh file, .crease or its URL, at full resolution")
      ->required();
  command->add_option("B", options->b, "the other one")->required();
  command
      ->add_option("--samples", options->compare.samples,
                   "points on each surface for means and normals")
      ->type_name("N")
      ->check(sample_count(1))
      ->capture_default_str();
  command->add_option("--seed", options->compare.seed, "of the samples")
      ->type_name("N")
      ->capture_default_str();
  add_import_options(*command, options->read);
  command->footer("Example:\n  crease compare city.glb city_20.glb --samples 1000000 --json");
  return {command, [options, &common] { return run_compare(*options, common); }};
}

}  // namespace crease::cli
