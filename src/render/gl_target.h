// A framebuffer with several samples a pixel, drawn in linear colours and read back as bytes.
#pragma once

#include "crease/result.h"
#include "render/gl_context.h"
#include "render/gl_objects.h"

#include <cstdint>
#include <span>

namespace crease {

class GlTarget {
 public:
  static Result<GlTarget> make(const GlLimits& gl, int width, int height);

  // Binds and clears to transparent black, so that alpha becomes the share of a pixel that is
  // covered.
  void begin(int width, int height);
  // Averages the samples. The texture's colours are times coverage.
  const GlTexture& resolve(int width, int height);
  // One sample of each pixel's depth. What is drawn next goes on where it was.
  Result<const GlTexture*> resolve_depth(int width, int height);
  // All samples of what was drawn, and back to them: what is drawn again and again over the same is
  // drawn once. Both read and write the whole picture; keep() takes as much memory as the target.
  Status keep(int width, int height);
  void go_back(int width, int height);
  // As resolve(), and copies width x height pixels, bottom row first, sRGB-encoded colours
  // times coverage and coverage.
  void read(int width, int height, std::span<std::uint8_t> rgba);

 private:
  bool reversed_depth_ = false;
  GlFramebuffer multisampled_, resolved_;
  GlRenderbuffer color_, depth_;
  GlTexture resolved_color_;
  int width_ = 0, height_ = 0;
  GlFramebuffer resolved_depth_;  // once it is asked for
  GlTexture depths_;
  GlFramebuffer kept_;  // likewise
  GlRenderbuffer kept_color_, kept_depth_;
  int samples_ = 0;
};

}  // namespace crease
