// crease view: the native viewer.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/number_check.h"
#include "cli/output.h"
#include "cli/text.h"
#include "cli/up_option.h"
#include "cli/view.h"
#include "crease/viewer.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace crease::cli {

namespace {

struct ViewArguments {
  std::string source;
  std::string size, view, flight, split, mode = "block", coloring = "shaded", up;
  bool wireframe = false, creases = false, occlusion = false, outside = false, panels = false;
  std::filesystem::path screenshot;
  std::optional<double> pixels, degrees, budget_mb, bandwidth_kb;
  std::optional<std::size_t> triangles;
  ReadOptions read;
};

ViewMode mode_of(const std::string& name) {
  if (name == "vertex") return ViewMode::Vertices;
  if (name == "linear") return ViewMode::Linear;
  return ViewMode::Blocks;
}

ViewColoring coloring_named(const std::string& name) {
  if (name == "kind") return ViewColoring::Kind;
  if (name == "level") return ViewColoring::Level;
  if (name == "block") return ViewColoring::Block;
  if (name == "error") return ViewColoring::Error;
  return ViewColoring::Shaded;
}

Result<Flight> read_flight(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(Error::NotFound, path.string() + ": no such flight");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  Result<Flight> flight = parse_flight(text);
  if (flight.ok()) return flight;
  return fail(flight.failure().error, path.string() + ": " + flight.failure().message);
}

// A comma between, a name before each: "pixels=8,mode=linear,wireframe".
class SplitWords {
 public:
  explicit SplitWords(const std::string& text) : text_(text) {}

  Result<HalfSettings> read(HalfSettings half) {
    std::istringstream words(text_);
    for (std::string word; std::getline(words, word, ',');) {
      const std::string::size_type equals = word.find('=');
      const std::string name = word.substr(0, equals);
      const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
      if (!take(name, value, half)) return wrong(word);
    }
    return half;
  }

 private:
  static bool take(const std::string& name, const std::string& value, HalfSettings& half) {
    const auto number = [&](double low, double& to) {
      char* end = nullptr;
      to = std::strtod(value.c_str(), &end);
      return !value.empty() && *end == 0 && to >= low && to <= 1e12;
    };
    double count = 0;
    if (name == "pixels") return number(0.01, half.pixels);
    if (name == "degrees") return number(0, half.degrees);
    if (name == "triangles") {
      if (!number(0, count)) return false;
      half.max_triangles = std::size_t(count);
      return true;
    }
    if (name == "mode") {
      half.mode = mode_of(value);
      half.vertices_in_blocks = value == "hybrid";
      return value == "block" || value == "hybrid" || value == "vertex" || value == "linear";
    }
    if (name == "color") {
      half.coloring = coloring_named(value);
      return half.coloring != ViewColoring::Shaded || value == "shaded";
    }
    if (!value.empty()) return false;
    if (name == "wireframe") return half.wireframe = true;
    if (name == "creases") return half.creases = true;
    if (name == "ambient-occlusion") return half.ambient_occlusion = true;
    return false;
  }

  Failure wrong(const std::string& word) const {
    if (word == "original") {
      return fail(Error::CommandLine,
                  "--split " + text_ + ": original has no settings of its own: it stands alone");
    }
    return fail(
        Error::CommandLine,
        "--split " + text_ + ": \"" + word +
            "\" is none of original, pixels=N, degrees=N, triangles=N, "
            "mode=block|hybrid|vertex|linear, color=BY, wireframe, creases, ambient-occlusion");
  }

  const std::string& text_;
};

// The right half begins as the left one.
Status set_split(const std::string& text, ViewerOptions& viewer) {
  viewer.right = {.mode = viewer.mode,
                  .vertices_in_blocks = viewer.vertices_in_blocks,
                  .coloring = viewer.coloring,
                  .wireframe = viewer.wireframe,
                  .creases = viewer.creases,
                  .ambient_occlusion = viewer.ambient_occlusion,
                  .pixels = viewer.pixels,
                  .degrees = viewer.degrees,
                  .max_triangles = viewer.max_triangles};
  if (text.empty()) return Done{};
  viewer.split = text == "original" ? ViewSplit::Original : ViewSplit::Settings;
  if (viewer.split == ViewSplit::Original) return Done{};
  const Result<HalfSettings> right = SplitWords(text).read(viewer.right);
  if (!right.ok()) return right.failure();
  viewer.right = *right;
  return Done{};
}

Status set_size(const std::string& text, ViewerOptions& viewer) {
  const Result<std::pair<int, int>> size = parse_size(text);
  if (!size.ok()) return size.failure();
  viewer.width_px = size->first;
  viewer.height_px = size->second;
  return Done{};
}

Result<ViewerOptions> viewer_options(const ViewArguments& options, const Common& common) {
  ViewerOptions viewer;
  viewer.source = options.source;
  viewer.mode = mode_of(options.mode);
  viewer.vertices_in_blocks = options.mode == "hybrid";
  viewer.coloring = coloring_named(options.coloring);
  viewer.wireframe = options.wireframe;
  viewer.creases = options.creases;
  viewer.ambient_occlusion = options.occlusion;
  viewer.outside = options.outside;
  viewer.panels_on_screenshot = options.panels;
  if (options.up != "auto") viewer.up = up_direction(options.up, UpAxis::Unknown);
  if (!options.view.empty()) {
    const Result<Camera> camera = read_camera(options.view);
    if (!camera.ok()) return camera.failure();
    viewer.camera = *camera;
    viewer.pixels = camera->pixels;
    viewer.width_px = camera->width_px;
    viewer.height_px = camera->height_px;
  }
  if (!options.size.empty()) {
    if (const Status set = set_size(options.size, viewer); !set.ok()) return set.failure();
  }
  if (!options.flight.empty()) {
    Result<Flight> flight = read_flight(options.flight);
    if (!flight.ok()) return flight.failure();
    viewer.flight = *std::move(flight);
  }
  if (options.pixels) viewer.pixels = *options.pixels;
  if (options.triangles) viewer.max_triangles = *options.triangles;
  if (options.degrees) viewer.degrees = *options.degrees;
  if (options.bandwidth_kb) viewer.max_bytes_per_second = *options.bandwidth_kb * 1e3;
  if (const Status set = set_split(options.split, viewer); !set.ok()) return set.failure();
  if (options.budget_mb) viewer.max_bytes = std::size_t(*options.budget_mb * 1e6);
  Result<ImportOptions> import = import_options(options.read, common);
  if (!import.ok()) return import.failure();
  viewer.import = *std::move(import);
  Result<BuildOptions> build = build_options(options.read, common);
  if (!build.ok()) return build.failure();
  viewer.build = *std::move(build);
  viewer.decode_threads = common.threads == 0 ? 2 : common.threads;
  viewer.screenshot = options.screenshot;
  viewer.stopped = interrupted;
  return viewer;
}

Result<Report> run_view(const ViewArguments& options, const Common& common) {
  const Stopwatch watch;
  const std::string_view ending[] = {".png"};
  if (!options.screenshot.empty()) {
    const Status writable = check_output(options.screenshot, ending, "pictures are", {});
    if (!writable.ok()) return writable.failure();
  }
  if (!options.screenshot.empty() && options.source.empty()) {
    return fail(Error::CommandLine, "--screenshot needs a FILE");
  }
  const Result<ViewerOptions> viewer = viewer_options(options, common);
  if (!viewer.ok()) return viewer.failure();
  const Result<ViewerReport> done = run_viewer(*viewer);
  if (!done.ok()) return done.failure();
  if (interrupted()) return interrupted_failure();
  Report report;
  report.json = {{"source", options.source},
                 {"frames", done->frames},
                 {"median_frame_ms", done->median_frame_ms},
                 {"bytes_read", done->bytes_read},
                 {"triangles", done->triangles},
                 {"error_pixels", done->error_pixels},
                 {"seconds", watch.seconds()}};
  if (!options.screenshot.empty()) {
    report.json["output"] = options.screenshot.string();
    report.text = options.screenshot.string() + ": " + std::to_string(viewer->width_px) + " x " +
                  std::to_string(viewer->height_px) + ", " + grouped(done->triangles) +
                  " triangles, " + in_seconds(watch.seconds());
  }
  return report;
}

}  // namespace

Command add_view(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "a window: look at a model while it streams");
  command->add_option("FILE", options->source,
                      ".crease file or http(s) URL, which stream; or a mesh file, which is built "
                      "first. Without one, drop a file on the window");
  command->add_option("--size", options->size, "of the window; default 1280x800")->type_name("WxH");
  command->add_option("--pixels", options->pixels, "error allowed on the screen; default 1")
      ->check(number_from(0.01, 1000.0))
      ->type_name("N");
  command->add_option("--degrees", options->degrees, "error of shading allowed; default: any")
      ->check(number_from(0.0, 180.0))
      ->type_name("N");
  command->add_option("--triangles", options->triangles, "at most so many; default: no limit")
      ->type_name("N");
  command->add_option("--budget", options->budget_mb, "memory of blocks, MB; default 537")
      ->check(number_from(1.0, 1e6))
      ->type_name("MB");
  command
      ->add_option("--bandwidth", options->bandwidth_kb,
                   "what blocks are asked for, kB a second; default: no limit")
      ->check(number_from(0.1, 1e9))
      ->type_name("KB");
  command
      ->add_option(
          "--mode", options->mode,
          "block: streams, and cuts along blocks | hybrid: and along vertices inside them | "
          "vertex, linear: load all of the model")
      ->check(CLI::IsMember({"block", "hybrid", "vertex", "linear"}))
      ->capture_default_str();
  command->add_option("--color", options->coloring, "shaded | kind | level | block | error")
      ->check(CLI::IsMember({"shaded", "kind", "level", "block", "error"}))
      ->type_name("BY")
      ->capture_default_str();
  command->add_flag("--wireframe", options->wireframe, "edges over the surface");
  command->add_flag("--creases", options->creases,
                    "lines at hard edges, and at borders in another tint");
  command->add_flag("--ambient-occlusion", options->occlusion,
                    "darker in corners and at the feet of walls");
  command
      ->add_option(
          "--split", options->split,
          "two pictures from one camera. original: right, the model as fine as it is | what "
          "the right one has otherwise: pixels=N,degrees=N,triangles=N,mode=M,color=BY,"
          "wireframe,creases,ambient-occlusion")
      ->type_name("RIGHT");
  command
      ->add_option("--view", options->view,
                   "camera to begin with, as crease render has it; its viewport is the size. "
                   "Default: where this file was last seen from, else all of the model")
      ->type_name("CAM.json");
  command->add_flag("--outside", options->outside,
                    "once the view is complete it is frozen, and looked at from outside with its "
                    "frustum: keys O and Z");
  add_up_option(*command, options->up);
  command
      ->add_option("--path", options->flight,
                   "plays a flight, as key R records it: [{\"seconds\":0,\"camera\":{...}}, ...]")
      ->type_name("FLIGHT.json");
  command
      ->add_option("--screenshot", options->screenshot,
                   "shows the model until the view is complete and the flight over, writes the "
                   "picture, and ends")
      ->type_name("OUT.png");
  command->add_flag("--panels", options->panels, "the panels are on that picture");
  add_build_options(*command, options->read);
  command->footer(
      "Examples:\n  crease view city.crease\n  crease view https://host/city.crease --budget 256\n"
      "  crease view bunny.ply --screenshot bunny.png\n"
      "Keys: F1 shows them.");
  return {command, [options, &common] { return run_view(*options, common); }};
}

}  // namespace crease::cli
