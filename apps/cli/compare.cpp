// crease compare: how far two meshes are apart.
#include "crease/compare.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/facts.h"
#include "cli/fields.h"
#include "cli/model.h"
#include "cli/number_check.h"
#include "cli/text.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

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

// As --normals takes it.
std::string words_of(const NormalPolicy& policy) {
  switch (policy.kind) {
    case NormalPolicy::Kind::Keep:
      return "keep";
    case NormalPolicy::Kind::Flat:
      return "flat";
    case NormalPolicy::Kind::Smooth:
      return "smooth";
    case NormalPolicy::Kind::Crease:
      break;
  }
  char words[40];
  std::snprintf(words, sizeof words, "crease:%g", policy.crease_angle_deg);
  return words;
}

// B's normals are made as A's, where neither has any of its own and they would be made otherwise: a
// level of a scan is no scan any more, and formats have rules of their own.
Result<Mesh> load_b(const CompareArguments& options, const Common& common,
                    const ImportReport& report_a, ImportReport& report_b) {
  Result<Mesh> mesh = load_mesh(options.b, options.read, common, &report_b);
  const std::optional<NormalPolicy>& made = report_a.made_normals;
  if (!mesh.ok() || !made || !report_b.made_normals || *made == *report_b.made_normals) return mesh;
  ReadOptions as_a = options.read;
  as_a.normals = words_of(*made);
  log(common, options.b.string() + ": read again with --normals " + as_a.normals + ", as " +
                  options.a.string() + "; --normals says which");
  return load_mesh(options.b, as_a, common, &report_b);
}

// Meshes in other units are seldom so far apart that comparing them is refused.
void note_sizes(const Mesh& a, const Mesh& b, const Common& common) {
  constexpr double kOtherUnits = 100;
  const auto size_of = [](const Mesh& mesh) {
    const auto [low, high] = bounds_of(mesh);
    return length(high - low);
  };
  const double size_a = size_of(a), size_b = size_of(b);
  if (std::max(size_a, size_b) <= kOtherUnits * std::min(size_a, size_b)) return;
  log(common, "one is " + in_length(size_a) + " long, the other " + in_length(size_b) +
                  ": is one of them in other units?");
}

Result<Report> run_compare(const CompareArguments& options, const Common& common) {
  const Stopwatch watch;
  Mesh meshes[2];
  ImportReport reports[2];
  const std::filesystem::path* paths[2] = {&options.a, &options.b};
  for (int i = 0; i < 2; ++i) {
    Result<Mesh> mesh = i == 0 ? load_mesh(options.a, options.read, common, &reports[0])
                               : load_b(options, common, reports[0], reports[1]);
    if (!mesh.ok()) return mesh.failure();
    if (mesh->triangle_count() == 0) {
      return fail(Error::NoTriangles, paths[i]->string() + ": no triangles to compare");
    }
    if (interrupted()) return interrupted_failure();
    meshes[i] = *std::move(mesh);
  }
  note_sizes(meshes[0], meshes[1], common);
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
  // Of a .crease they are the file's.
  const auto normals_of = [](const ImportReport& read) {
    return read.normals.empty() ? "the file's" : read.normals;
  };
  report.json["normals"] = {{"a", normals_of(reports[0])}, {"b", normals_of(reports[1])}};
  report.json["seconds"] = watch.seconds();
  const double diagonal = c.diagonal > 0 ? c.diagonal : 1;
  report.text = row("A to B", c.distance.a_to_b, diagonal) + "\n" +
                row("B to A", c.distance.b_to_a, diagonal) + "\nnormals    mean " +
                in_degrees(c.normal_deviation.mean) + ", 95 % below " +
                in_degrees(c.normal_deviation.p95) + ", max " + in_degrees(c.normal_deviation.max);
  for (const AttributeDeviation& attribute : c.attributes) {
    report.text += "\n" + line_of(attribute);
  }
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
