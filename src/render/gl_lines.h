// Thick lines over a scene that is drawn: solid where they are in front of it, faint behind it.
#pragma once

#include "crease/result.h"
#include "render/frustum.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"

#include <span>

namespace crease {

// In model units. Into the bound framebuffer and its viewport, with its depths.
Status draw_lines(ProgramCache& programs, std::span<const Segment> lines, const DrawPass& pass,
                  const DrawStyle& style);

}  // namespace crease
