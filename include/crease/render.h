// Pictures without a display: OpenGL 3.3 core through EGL (Mesa llvmpipe where there is no GPU),
// the three-part drawing of DB03. No GL type here.
//
//   std::vector<Panel> panels{{.list = pm.draw_list(), .title = "20 %"}};
//   Result<Image> image = render_panels(panels, RenderOptions{});
//   write_png(*image, "levels.png");
//   render_panels(panels, {.frustum = camera});   // from outside, with the camera's frustum
#pragma once

#include "crease/camera.h"
#include "crease/draw_list.h"
#include "crease/result.h"
#include "crease/vec.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// Reads the JSON of camera.h. position and target are required, the rest has the defaults there.
// A message names the field and what is wrong with it, or where the text stops being JSON.
Result<Camera> parse_camera(std::string_view json);
// What parse_camera reads back to the same camera.
std::string format_camera(const Camera& camera);

// A camera that sees the whole box, as large as it fits, from a three-quarter view: the low objects
// (cities, terrain) from higher above than the tall ones. The side that faces the viewer is the
// one that looks against the third axis of a right-handed frame with x to the right: -y for z up.
Camera fit_camera(const Vec3d& low, const Vec3d& high, int width_px, int height_px,
                  const Vec3d& up = {0, 0, 1});

enum class Coloring : std::uint8_t {
  // Materials' base colours, their textures and vertex colours under a headlight and a hemisphere
  // light.
  Shaded,
  Kind,   // SN, FN and NSN triangles in three colours, shaded
  Level,  // by `Panel::level_of_position`, or `level_share`
  Error,  // by `Panel::error_of_position` on one scale for all panels (blue small, red large)
};

struct Panel {
  DrawList list{};
  std::string title;        // drawn at the panel's top; empty: nothing
  std::uint32_t model = 0;  // panels of one are seen by one camera
  // For a fitted camera, instead of RenderOptions::up. Where panels share one, the first's holds.
  std::optional<Vec3d> up{};
  float level_share = 0;  // for Coloring::Level: 0 full resolution .. 1 base
  // The same for each position of the list, where levels differ; or empty.
  std::span<const float> level_of_position{};
  // For Coloring::Error: one value per position of the list, in RenderOptions::error_unit; or
  // empty.
  std::span<const float> error_of_position{};
};

struct RenderOptions {
  int width_px = 1920, height_px = 1080;  // of the whole picture; panels share it in a row or grid
  // Else fitted: one for all panels of a model, and of models that lie at one place and differ in
  // size by no more than twice; others have one of their own.
  std::optional<Camera> camera{};
  // Shows as lines what this camera sees. Without `camera` the picture is then taken from outside:
  // from beside and behind it, with everything in view.
  std::optional<Camera> frustum{};
  Vec3d up{0, 0, 1};  // for the fitted camera: many scans have y up
  Coloring coloring = Coloring::Shaded;
  bool wireframe = false;          // edges over the shaded surface
  bool ambient_occlusion = false;  // darkens where little light comes, by the picture's depths
  int columns = 0;                 // 0: as many as look best
  // Coloring::Error: the error at the red end, or 0: nearly the largest one there is.
  double error_full = 0;
  std::string error_unit = "model units";
  // Told what is left out: a texture that cannot be decoded. Its material has its base colour.
  std::function<void(const std::string&)> on_note{};
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height, top row first
};

// Panels are drawn each under its title; a legend stands below them where the colours mean
// something. Surfaces are two-sided: a normal that points away from the viewer's side
// of its triangle is turned round. A camera for another shape than the panel's shows at least
// what it would show in its own. Pictures larger than the device can draw are put together from
// tiles. The same input gives the same picture on one device and driver.
//
// Textures are PNG or JPEG of up to 64 Mi pixels; of more than 1 GiB together they are drawn
// smaller. What is blended covers as many of a pixel's samples as its alpha says; colours' alpha is
// not drawn.
//
// Each list is uploaded once. llvmpipe on two cores, 1920 x 1080: 2 M triangles in 4 s. Fails with
// NotSupported when no EGL device can draw, saying what was tried, and with BadValue for a size, a
// list or a camera that cannot be meant. Threads: call from any; an OpenGL context that is current
// stays so.
Result<Image> render_panels(std::span<const Panel> panels, const RenderOptions& options);

// What each of `panel_count` panels shows of `options.camera`, which must be there: a camera of the
// panel's own shape, in its own pixels. A cut made for it is right everywhere in the picture.
// Fails with BadValue for a size that cannot be meant.
Result<Camera> camera_of_panel(std::size_t panel_count, bool has_titles,
                               const RenderOptions& options);
Status write_png(const Image& image, const std::filesystem::path& path);
// The bytes that write_png() writes. Fails with BadValue for an image without all its pixels.
Result<std::vector<std::byte>> encode_png(const Image& image);

}  // namespace crease
