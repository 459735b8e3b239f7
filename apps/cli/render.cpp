// crease render: pictures without a display, several levels side by side.
#include "crease/render.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/number_check.h"
#include "cli/output.h"
#include "cli/panels.h"
#include "cli/text.h"
#include "cli/up_option.h"
#include "cli/view.h"

#include <memory>

namespace crease::cli {

namespace {

struct RenderArguments {
  std::vector<std::filesystem::path> files;
  std::filesystem::path output;
  PanelOptions panels;
  std::string levels, view, size, up;
  ViewOptions of_view;
  std::string coloring;                          // empty: shaded, by error from outside
  bool wireframe = false, no_wireframe = false;  // neither: from outside
  bool outside = false, occlusion = false;
  int columns = 0;

  // Of the same detail everywhere; triangles are what a view may have.
  bool has_level() const {
    const LevelOptions& one = panels.level;
    return !levels.empty() || (one.triangles && view.empty()) || one.ratio || one.error;
  }
};

Coloring coloring_of(const std::string& name) {
  if (name == "kind") return Coloring::Kind;
  if (name == "level") return Coloring::Level;
  if (name == "error") return Coloring::Error;
  return Coloring::Shaded;
}

// Errors of a view are in pixels: what is allowed is the middle of the scale.
void scale_to_pixels(const Camera& camera, RenderOptions& render) {
  render.error_full = 2 * camera.pixels;
  render.error_unit = render.error_full == 1 ? "pixel" : "pixels";
}

Result<RenderOptions> render_options(const RenderArguments& options) {
  RenderOptions render;
  const bool by_error = options.outside && options.coloring.empty();
  render.coloring = by_error ? Coloring::Error : coloring_of(options.coloring);
  render.wireframe = options.wireframe || (options.outside && !options.no_wireframe);
  render.columns = options.columns;
  render.ambient_occlusion = options.occlusion;
  if (!options.view.empty()) {
    const Result<Camera> camera = read_camera(options.view);
    if (!camera.ok()) return camera.failure();
    (options.outside ? render.frustum : render.camera) = *camera;
    if (!options.has_level()) scale_to_pixels(*camera, render);
    render.width_px = camera->width_px;
    render.height_px = camera->height_px;
  }
  if (!options.size.empty()) {
    const Result<std::pair<int, int>> size = parse_size(options.size);
    if (!size.ok()) return size.failure();
    render.width_px = size->first;
    render.height_px = size->second;
  }
  return render;
}

Result<Report> run_render(RenderArguments options, const Common& common) {
  const Stopwatch watch;
  if (!options.levels.empty()) {
    const LevelOptions& one = options.panels.level;
    if (one.triangles || one.ratio || one.error) {
      return fail(Error::CommandLine,
                  "--levels stands instead of --triangles, --ratio and --error");
    }
    Result<std::vector<double>> ratios = parse_ratios(options.levels);
    if (!ratios.ok()) return ratios.failure();
    options.panels.ratios = *std::move(ratios);
  }
  if (options.has_level() && (options.of_view.degrees > 0 || options.of_view.consistent)) {
    return fail(Error::CommandLine,
                "--degrees and --consistent are of what --view refines: leave out --levels, "
                "--ratio and --error");
  }
  if (options.outside && options.has_level()) {
    return fail(Error::CommandLine,
                "--outside shows what --view refines, with --triangles at most so many: leave out "
                "--levels, --ratio and --error");
  }
  const std::string_view ending[] = {".png"};
  const Status writable = check_output(options.output, ending, "pictures are", options.files);
  if (!writable.ok()) return writable.failure();
  Result<RenderOptions> render = render_options(options);
  if (!render.ok()) return render.failure();
  options.panels.errors_of_positions = render->coloring == Coloring::Error;
  options.panels.levels_of_positions = render->coloring == Coloring::Level;
  if (render->columns == 0 && options.panels.control) {
    render->columns = static_cast<int>(options.panels.control_columns());
  }
  if (options.outside) {
    options.panels.view =
        view_of(*render->frustum, options.of_view, options.panels.level.triangles);
  } else if (render->camera && !options.has_level()) {
    const std::size_t panel_count = options.files.size() * options.panels.panel_count();
    Result<Camera> seen = camera_of_panel(panel_count, options.panels.titles, *render);
    if (!seen.ok()) return seen.failure();
    options.panels.view = view_of(*seen, options.of_view, options.panels.level.triangles);
  }

  options.panels.file_names = options.files.size() > 1;
  options.panels.up = options.up;
  Panels panels;
  for (const std::filesystem::path& file : options.files) {
    const Status added = panels.add_file(file, options.panels, common);
    if (!added.ok()) return added.failure();
    if (interrupted()) return interrupted_failure();
  }
  render->up = up_direction(options.up, panels.up());
  render->on_note = [&common](const std::string& note) { log(common, note); };
  const Result<Image> image = render_panels(panels.list(), *render);
  if (!image.ok()) return image.failure();
  if (interrupted()) return interrupted_failure();
  const Status written = write_png(*image, options.output);
  if (!written.ok()) return written.failure();

  Report report;
  report.json = {{"output", options.output.string()}, {"width", image->width},
                 {"height", image->height},           {"panels", panels.json()},
                 {"bytes_read", panels.bytes_read()}, {"seconds", watch.seconds()}};
  report.text = options.output.string() + ": " + std::to_string(image->width) + " x " +
                std::to_string(image->height) + ", " + std::to_string(panels.list().size()) +
                (panels.list().size() == 1 ? " panel, " : " panels, ") +
                in_seconds(watch.seconds());
  return report;
}

}  // namespace

Command add_render(CLI::App& app, const Common& common) {
  auto options = std::make_shared<RenderArguments>();
  CLI::App* command =
      app.add_subcommand("render", "a picture without a display, levels side by side");
  command
      ->add_option("FILE", options->files,
                   ".crease files, URLs of them, or mesh files, each with its own panels")
      ->required();
  command->add_option("-o,--output", options->output, "the picture")
      ->required()
      ->type_name("OUT.png");
  command
      ->add_option("--levels", options->levels, "shares of the triangles, a panel each: 1,0.2,0.02")
      ->type_name("R,...");
  add_level_options(*command, options->panels.level);
  CLI::Option* view =
      command
          ->add_option(
              "--view", options->view,
              "camera: {\"position\":[x,y,z],\"target\":[x,y,z],\"up\":[x,y,z],"
              "\"vertical_fov\":45,\"viewport\":[1920,1080],\"pixels\":1}. Without a level "
              "the model is as fine as it needs, within its \"pixels\" of error, and coarse "
              "elsewhere; with --triangles as fine as so many allow. Default: all of the model")
          ->type_name("CAM.json");
  add_view_options(*command, view, options->of_view);
  command
      ->add_flag("--outside", options->outside,
                 "the model as fine as --view needs it, seen from outside with its frustum, "
                 "coloured by error: up to \"pixels\" blue, beyond yellow to red")
      ->needs(view);
  add_up_option(*command, options->up);
  command->add_flag("--ambient-occlusion", options->occlusion,
                    "darker in corners and at the feet of walls");
  command
      ->add_option("--color", options->coloring,
                   "shaded | kind | level | error; default: shaded, error with --outside")
      ->check(CLI::IsMember({"shaded", "kind", "level", "error"}))
      ->type_name("BY");
  CLI::Option* wireframe = command->add_flag("--wireframe", options->wireframe,
                                             "edges over the surface; --outside has them");
  command->add_flag("--no-wireframe", options->no_wireframe, "none with --outside either")
      ->excludes(wireframe);
  command->add_flag("--control", options->panels.control,
                    "beside each panel the same triangles with one averaged normal a vertex: what "
                    "ignoring shading discontinuities does");
  command->add_option("--size", options->size, "of the whole picture; default 1920x1080")
      ->type_name("WxH");
  command->add_option("--columns", options->columns, "panels in a row; 0: as many as look best")
      ->type_name("N")
      ->check(number_from(0, 64));
  command->add_flag("--no-titles{false}", options->panels.titles, "no titles in the panels");
  add_build_options(*command, options->panels.read);
  command->footer(
      "Examples:\n  crease render bunny.crease -o bunny.png --levels 1,0.2,0.02 --wireframe\n"
      "  crease render city.crease -o seen.png --view camera.json\n"
      "  crease render city.crease -o outside.png --view camera.json --outside");
  return {command, [options, &common] { return run_render(*options, common); }};
}

}  // namespace crease::cli
