// A window's picture: drawn with several samples a pixel, laid over the background of all our
// pictures, and shown in the window or read back.
//
//   Result<GlCanvas> canvas = GlCanvas::make();   // of the OpenGL that is current
//   every frame:
//     canvas->begin(width_px, height_px);
//     scene.draw(canvas->programs(), pass, style);
//     canvas->show();
#pragma once

#include "crease/render.h"
#include "render/gl_context.h"
#include "render/gl_objects.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"
#include "render/gl_target.h"
#include "render/palette.h"

#include <optional>

namespace crease {

class GlCanvas {
 public:
  static Result<GlCanvas> make();

  Status begin(int width_px, int height_px);
  // What is drawn next goes into these columns.
  void set_columns(int left, int width);
  // Darkens what is drawn in those columns where little light comes.
  Status occlude(const DrawPass& pass, const DrawStyle& style);
  // Over what is drawn there.
  void fill_columns(int left, int width, const ColorSrgb& color);
  // Into the window's framebuffer. Leaves OpenGL as a program expects that draws over it.
  Status show();
  // The same picture as an image. Fails before the first begin().
  Result<Image> read();
  // What the window's framebuffer has, with all that was drawn over the picture since show(). Where
  // another window covers ours it may be anything.
  Image read_window() const;

  const GlLimits& limits() const { return limits_; }
  ProgramCache& programs() { return programs_; }

 private:
  Status compose(GLuint framebuffer);
  Image read_bound() const;

  GlLimits limits_;
  ProgramCache programs_;
  std::optional<GlTarget> target_;
  GlVertexArray no_attributes_;
  int width_ = 0, height_ = 0;
};

}  // namespace crease
