// Thick lines over a scene that is drawn: solid where they are in front of it, faint behind it.
#pragma once

#include "crease/result.h"
#include "render/frustum.h"
#include "render/transform.h"

#include <span>

namespace crease {

struct LineView {
  View view;
  Vec3d origin;     // what clip_from_list takes points less of
  double near = 1;  // lines begin there
  Matrix4f clip_from_list{};
  float width_px = 1;  // in pixels of the framebuffer
  bool reversed_depth = false;
};

// Into the bound framebuffer and its viewport, with its depths.
Status draw_lines(std::span<const Segment> lines, const LineView& view);

}  // namespace crease
