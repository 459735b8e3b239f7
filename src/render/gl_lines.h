// Thick lines over a scene that is drawn: solid where they are in front of it, faint behind it.
#pragma once

#include "crease/result.h"
#include "render/frustum.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"

#include <span>

namespace crease {

// From the camera, with depths that hold the box and the lines. `aspect`: width by height.
DrawPass pass_over(const Camera& camera, double aspect, Box box, std::span<const Segment> lines);

// In model units. Into the bound framebuffer and its viewport, with its depths.
Status draw_lines(ProgramCache& programs, std::span<const Segment> lines, const DrawPass& pass,
                  const DrawStyle& style);

}  // namespace crease
