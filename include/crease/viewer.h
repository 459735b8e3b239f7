// The native viewer: a window on a .crease file, a URL of one, or a mesh file.
//
//   Result<ViewerReport> report = run_viewer({.source = "city.crease"});
//   run_viewer({.source = "https://host/city.crease", .camera = camera, .screenshot = "city.png"});
//
// The window is there at once and shows the model as it comes. Needs crease::view, and a display.
#pragma once

#include "crease/build.h"
#include "crease/camera.h"
#include "crease/import.h"
#include "crease/result.h"
#include "crease/vec.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

enum class ViewMode : std::uint8_t {
  Blocks,    // streamed; the cut runs along blocks
  Vertices,  // the whole model in memory; the cut runs along vertices
  Linear,    // the whole model in memory; one level everywhere
};

enum class ViewColoring : std::uint8_t {
  Shaded,  // materials and vertex colours
  Kind,    // SN, FN and NSN triangles
  Level,   // by block: bands, fine ones green-blue, the base violet; else by the share of triangles
  Block,   // a colour for each block; else shaded
  Error,   // on the screen: what is allowed in the middle of the scale, blue to red
};

enum class ViewSplit : std::uint8_t {
  Off,
  Original,  // right: the model as fine as it is, by block, within the memory allowed
  Settings,  // right: settings of its own
};

// What one half of the picture has for itself.
struct HalfSettings {
  ViewMode mode = ViewMode::Blocks;
  bool vertices_in_blocks = false;  // as in ViewerOptions
  ViewColoring coloring = ViewColoring::Shaded;
  bool wireframe = false, creases = false, ambient_occlusion = false;
  double pixels = 1, degrees = 0;  // as in ViewerOptions
  std::size_t max_triangles = std::numeric_limits<std::size_t>::max();
};

// A camera of a flight, so many seconds after its begin.
struct TimedCamera {
  double seconds = 0;
  Camera camera;
};
using Flight = std::vector<TimedCamera>;  // ascending

// Reads [{"seconds":0,"camera":{...}}, ...], cameras as parse_camera() reads them. Fails where
// there is none, or times do not ascend.
Result<Flight> parse_flight(std::string_view json);
std::string format_flight(const Flight& flight);  // parse_flight() reads the same

struct ViewerOptions {
  std::string source;                    // path or URL; empty: waits for files to be dropped
  int width_px = 1280, height_px = 800;  // of the window
  ViewMode mode = ViewMode::Blocks;
  bool vertices_in_blocks = false;  // by block: and by vertex inside them, with fewer triangles
  ViewColoring coloring = ViewColoring::Shaded;
  bool wireframe = false;
  bool creases = false;  // hard edges of what is shown as lines, and its borders in another tint
  bool ambient_occlusion = false;  // darkens where little light comes, by the picture's depths
  bool outside = false;            // once the view is complete: frozen, and looked at from outside
  double pixels = 1;               // error allowed on the screen
  double degrees = 0;              // of shading allowed; 0: any
  std::size_t max_triangles = std::numeric_limits<std::size_t>::max();
  std::size_t max_bytes = std::size_t(512) << 20;  // of resident blocks
  // Of streamed blocks, asked for a second; infinity: no limit.
  double max_bytes_per_second = std::numeric_limits<double>::infinity();
  // Two pictures side by side from the same camera.
  ViewSplit split = ViewSplit::Off;
  HalfSettings right{};  // ViewSplit::Settings
  double divider = 0.5;  // share of the width that the left half has
  // Else the last one that this file was seen from, else all of the model.
  std::optional<Camera> camera{};
  std::optional<Vec3d> up{};  // where no camera says; else as the model has it
  Flight flight{};            // played once the first picture is there
  // Shows until the view is complete, and the flight over, writes the picture, ends.
  std::filesystem::path screenshot{};
  bool panels_on_screenshot = false;  // what lies over the picture is on it
  ImportOptions import{};             // of mesh files; progress is the viewer's
  BuildOptions build{};
  int decode_threads = 1;
  std::function<bool()> stopped{};  // asked every frame; true ends as closing the window does
};

// `median_frame_ms`: from the begin of a frame's work until it is on the screen, the wait for the
// display's refresh among it.
struct ViewerReport {
  std::size_t frames = 0;
  double median_frame_ms = 0;
  std::uint64_t bytes_read = 0;  // of the last model
  std::size_t triangles = 0;     // shown at the end
  double error_pixels = 0;       // of those, on the screen
};

// Returns when the window is closed. A model that cannot be opened is told in the window, and
// fails here if no other was opened until it closes; with `screenshot` at once. NotSupported
// without a display that has OpenGL 3.3. Threads: the main one; it has some of its own.
Result<ViewerReport> run_viewer(const ViewerOptions& options);

}  // namespace crease
