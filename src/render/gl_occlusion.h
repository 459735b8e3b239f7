// Ambient occlusion: corners and the feet of walls get darker, by the depths of the picture alone.
//
//   scene.draw(programs, pass, style);
//   draw_occlusion(programs, target.resolve_depth(width, height), pass, style);
//
// For each pixel, points around it on the screen are asked how far they rise above its plane
// (McGuire et al., The Alchemy screen-space ambient obscurance algorithm, 2011, eq. 10, with a
// weight that ends at the radius, so that what lies far before or behind leaves no halo). One pass,
// no blur: directions turn from pixel to pixel, steps are fixed.
#pragma once

#include "crease/result.h"
#include "render/gl_objects.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"

namespace crease {

// Over what is drawn in the bound framebuffer's viewport. `depth`: of the framebuffer. The radius
// is a share of the viewport's whole picture.
Status draw_occlusion(ProgramCache& programs, const GlTexture& depth, const DrawPass& pass,
                      const DrawStyle& style);

}  // namespace crease
