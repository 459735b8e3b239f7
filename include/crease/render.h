// Pictures without a display: OpenGL 3.3 core through EGL (Mesa llvmpipe where there is no GPU), the
// three-part drawing of DB03. No GL type here.
//
//   std::vector<Panel> panels{{.list = pm.draw_list(), .title = "20 %"}};
//   Result<Image> image = render_panels(panels, RenderOptions{});
//   write_png(*image, "levels.png");
#pragma once

#include "crease/draw_list.h"
#include "crease/result.h"
#include "crease/vec.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease {

// DESIGN 9: {"position":[x,y,z],"target":[x,y,z],"up":[x,y,z],"vertical_fov":45,
//            "viewport":[1920,1080],"pixels":1}
struct Camera {
  Vec3d position{0, 0, 1}, target, up{0, 0, 1};
  double vertical_fov_deg = 45;
  int width_px = 1920, height_px = 1080;
  double pixels = 1;  // error allowed on screen
};
Result<Camera> parse_camera(std::string_view json);

// A camera that sees the whole box from a three-quarter view. z is up.
Camera fit_camera(const Vec3d& low, const Vec3d& high, int width_px, int height_px);

enum class Coloring : std::uint8_t {
  Shaded,     // materials' base colours and vertex colours under a headlight and a hemisphere light
  Kind,       // SN, FN and NSN triangles in three colours, shaded
  Level,      // by `Panel::level_color`
  Error,      // by `Panel::error` on one scale for all panels (blue small, red large)
};

struct Panel {
  DrawList list;
  std::string title;              // drawn at the panel's top; empty: nothing
  float level_share = 0;          // for Coloring::Level: 0 full resolution .. 1 base
  // For Coloring::Error: one value per position of the list, model units; or empty.
  std::span<const float> error_of_position;
};

struct RenderOptions {
  int width_px = 1920, height_px = 1080;  // of the whole picture; panels share it in a row or grid
  std::optional<Camera> camera;           // else fit_camera of the first panel, the same for all
  Coloring coloring = Coloring::Shaded;
  bool wireframe = false;                 // edges over the shaded surface
  int columns = 0;                        // 0: as many as look best
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height, top row first
};

// Fails with NotSupported when no EGL device can draw, saying what was tried.
Result<Image> render_panels(std::span<const Panel> panels, const RenderOptions& options);
Status write_png(const Image& image, const std::filesystem::path& path);

}  // namespace crease
