// crease report: a page about a model, to send to somebody.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/facts.h"
#include "cli/fields.h"
#include "cli/model.h"
#include "cli/number_check.h"
#include "cli/output.h"
#include "cli/report_levels.h"
#include "cli/report_page.h"
#include "cli/text.h"
#include "cli/up_option.h"
#include "cli/view.h"
#include "crease/build_progressive_arrays.h"
#include "crease/write_file.h"

#include <algorithm>
#include <functional>
#include <memory>

namespace crease::cli {

namespace {

struct ReportArguments {
  std::filesystem::path file, output;
  std::string levels = "0.5,0.2,0.1,0.05,0.02,0.01";
  std::string title, view, size, up;
  std::size_t samples = 50'000;
  ReadOptions read;
};

Result<ReportLevelOptions> report_level_options(const ReportArguments& options) {
  ReportLevelOptions level;
  Result<std::vector<double>> ratios = parse_ratios(options.levels);
  if (!ratios.ok()) return ratios.failure();
  level.ratios = *std::move(ratios);
  std::ranges::sort(level.ratios, std::greater());
  level.samples = options.samples;
  if (!options.view.empty()) {
    const Result<Camera> camera = read_camera(options.view);
    if (!camera.ok()) return camera.failure();
    level.view = *camera;
  }
  if (!options.size.empty()) {
    const Result<std::pair<int, int>> size = parse_size(options.size);
    if (!size.ok()) return size.failure();
    level.width_px = size->first;
    level.height_px = size->second;
  }
  return level;
}

Json level_json(const ReportLevel& level) {
  Json json = {{"name", level.name},
               {"triangles", level.triangles},
               {"vertices", level.vertices},
               {"sn_triangles", level.sn_triangles},
               {"fn_triangles", level.fn_triangles},
               {"nsn_triangles", level.nsn_triangles},
               {"stopped_by", name_of(level.stopped_by)},
               {"bytes_needed", level.bytes_needed},
               {"error", to_json(level.recorded)}};
  if (level.measured) json["error_measured"] = measured_json(*level.measured);
  json["picture"] = !level.png.empty();
  return json;
}

Result<Report> run_report(const ReportArguments& options, const Common& common) {
  const Stopwatch watch;
  const std::string_view endings[] = {".html", ".htm"};
  const Status writable = check_output(options.output, endings, "pages are", {&options.file, 1});
  if (!writable.ok()) return writable.failure();
  Result<ReportLevelOptions> asked = report_level_options(options);
  if (!asked.ok()) return asked.failure();
  const Result<ModelFile> file = open_model(options.file, options.read, common);
  if (!file.ok()) return file.failure();
  asked->up = up_direction(options.up, file->blocks().facts().up);
  DecodeOptions decode = decode_options(common);
  decode.count_bits = true;
  if (const Status shaded = file->check_normals(); !shaded.ok()) return shaded.failure();
  const Result<DecodedModel> model = decode_model(file->blocks(), decode);
  if (!model.ok()) return model.failure();
  if (interrupted()) return interrupted_failure();
  const ProgressiveArraysPtr arrays = build_progressive_arrays(model->mesh, model->sequence);

  PageContent page;
  page.title = options.title.empty() ? file->name() : options.title;
  page.facts = file_facts(*file, *model, *arrays);
  if (file->imported()) page.import_lines = lines_of(*file->imported());
  log(common, "levels of " + file->name() + ", measured and drawn:");
  Result<ReportLevels> levels = make_report_levels(*file, model->mesh, arrays, *asked, common);
  if (!levels.ok()) return levels.failure();
  page.levels = *std::move(levels);
  if (!page.levels.no_pictures.empty()) {
    log(common, "  no pictures: " + page.levels.no_pictures);
  }
  const std::string html = report_page(page);
  const Status written = write_file(options.output, std::as_bytes(std::span<const char>(html)));
  if (!written.ok()) return written.failure();

  Report report;
  Json all = Json::array();
  for (const ReportLevel& level : page.levels.levels) all.push_back(level_json(level));
  report.json = {{"output", options.output.string()},
                 {"bytes", html.size()},
                 {"levels", std::move(all)},
                 {"bytes_read", file->bytes_read()},
                 {"seconds", watch.seconds()}};
  report.text = options.output.string() + ": " + in_bytes(html.size()) + ", " +
                std::to_string(page.levels.levels.size()) + " levels, " +
                in_seconds(watch.seconds());
  return report;
}

}  // namespace

Command add_report(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand(
      "report", "one page about a model, with pictures and curves, to send to somebody");
  command->add_option("FILE", options->file, "a .crease, the URL of one, or a mesh file")
      ->required();
  command->add_option("-o,--output", options->output, "the page; it needs no other file")
      ->required()
      ->type_name("OUT.html");
  command
      ->add_option("--levels", options->levels,
                   "shares of the triangles that are measured and shown beside the original")
      ->type_name("R,...")
      ->capture_default_str();
  command
      ->add_option("--samples", options->samples,
                   "points on each surface for means and normals; 0 measures nothing")
      ->type_name("N")
      ->check(sample_count(0))
      ->capture_default_str();
  command->add_option("--title", options->title, "of the page; default: the file's name");
  command
      ->add_option("--view", options->view,
                   "camera of the pictures, as in render; default: all of the model")
      ->type_name("CAM.json");
  add_up_option(*command, options->up);
  command->add_option("--size", options->size, "of a picture; default 640x480")->type_name("WxH");
  add_build_options(*command, options->read);
  command->footer("Example:\n  crease report house.crease -o house.html");
  return {command, [options, &common] { return run_report(*options, common); }};
}

}  // namespace crease::cli
