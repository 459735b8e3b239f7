// What is the same for everything in one picture.
#pragma once

#include "crease/render.h"
#include "render/palette.h"
#include "render/transform.h"

#include <cstdint>
#include <optional>

namespace crease {

// From where everything is drawn, with which depths.
struct DrawPass {
  View view;
  Vec3d up{0, 0, 1};
  DepthRange depth{};
  Window window{};  // the part of the picture that the viewport shows
};

// What is seen through apart from the rest: where a texture is, by its alpha there.
enum class Shown : std::uint8_t { All, Opaque, SeenThrough };

struct DrawStyle {
  Coloring coloring = Coloring::Shaded;
  bool wireframe = false;
  bool ambient_occlusion = false;      // for who draws: scenes know nothing of it
  float line_px = 1;                   // width of wireframe lines, in pixels of the framebuffer
  float level_share = 0;               // Coloring::Level
  float error_full = 1;                // Coloring::Error: the error at the scale's red end
  bool reversed_depth = false;         // as the target has it
  std::optional<ColorSrgb> surface{};  // all of it in this one
  // Where some is seen through, which of a pixel's samples a surface covers is chosen for each
  // surface and pixel, anew each turn: what lies behind shows by as much as it should, with a
  // grain. Else they are the same ones at each depth, and what covers no more and lies behind is
  // not seen.
  std::optional<unsigned> turn{};
  Shown shown = Shown::All;
  bool shows_backs = true;  // triangles that face away, by their winding
};

}  // namespace crease
